// Limit cycles of the Manchester coach on S1002 and 60E1 1:40 against time simulation: writes limit_cycles.csv,
// limit_cycle_folds.csv, limit_cycle_simulations.csv and limit_cycles.svg into the folder given.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "railtab/runtime/report/svg_figure.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/stability/hunting_branch.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace {

using namespace railtab;

constexpr std::size_t simulated = 6;  // cycles of a branch
constexpr double disturbance = 1.02;  // of all displacements and velocities with which a simulation begins
constexpr double counted = 5.0;       // s at the end of a simulation

/// How long the largest multiplier takes to bring the disturbance down to a thousandth of the cycle [s].
double settling_time(const LimitCycle& cycle) {
  constexpr double least = 25.0, most = 600.0, remains = 1e-3 / (disturbance - 1.0);
  const double periods = std::log(remains) / std::log(std::abs(cycle.multiplier));
  return std::clamp(periods / cycle.frequency, least, most);
}

SceneParameters coach_scene(const std::string& table) {
  SceneParameters scene;
  scene.train.vehicle = "manchester-coach";
  scene.contact.table = table;
  scene.track_kind = TrackKind::rigid;
  scene.integration.duration = counted;  // a scene without bridge states one
  return scene;
}

struct Simulated {
  double amplitude = 0.0, frequency = 0.0;  // m, Hz
};

// What the coach does from a disturbed cycle on. The branch has forces at the steps' ends throughout; runs keep the
// energy of impacts in divided steps by default.
std::optional<Simulated> simulation(const VehicleFlow& flow, const LimitCycle& cycle, int wheelset, double time_step,
                                    std::optional<ContactForceRule> rule) {
  const VsiModel model = flow.model_at(cycle.speed);
  VsiState state = flow.state_at(model, disturbance * cycle.motion.start);
  const int y =
      model.vehicle.dof[static_cast<std::size_t>(model.vehicle.wheelsets[static_cast<std::size_t>(wheelset)])][1];
  const double counted_from = settling_time(cycle);
  double low = 0.0, high = 0.0, before = 0.0, first = 0.0, last = 0.0;
  int crossings = 0;
  RunObserver observer;
  observer.state = [&](const VsiState& now) {
    const double at = now.vehicle[0].displacement[y];
    if (now.time >= counted_from) {
      low = std::min(low, at);
      high = std::max(high, at);
      if (before < 0.0 && at >= 0.0) {
        last = now.time - time_step * at / (at - before);
        if (crossings++ == 0) first = last;
      }
    }
    before = at;
  };
  IntegrationParameters integration;
  integration.time_step = time_step;
  integration.alpha = 0.0;
  integration.contact_force = rule;
  const RunSummary summary = simulate(model, integration, counted_from + counted, 1000000, state, observer);
  if (!summary.complete || crossings < 2) return {};
  return Simulated{0.5 * (high - low), (crossings - 1) / (last - first)};
}

struct Files {
  std::ofstream cycles, folds, simulations;
  explicit Files(const std::string& folder)
      : cycles(folder + "/limit_cycles.csv"),
        folds(folder + "/limit_cycle_folds.csv"),
        simulations(folder + "/limit_cycle_simulations.csv") {
    const std::string made = ", Manchester coach on S1002 and 60E1 1:40, made by tests/validation/limit_cycle_figure\n";
    cycles << "# Limit cycles" << made
           << "branch,cycle,speed_kmh,amplitude_mm,frequency_Hz,stable,multiplier,residual,error_along_motion\n";
    folds << "# Folds of the branches" << made
          << "branch,fold,speed_kmh,amplitude_mm,frequency_Hz,converged,bracket_low_mm,bracket_high_mm,"
             "bracket_departure_kmh\n";
    simulations << "# Stable limit cycles and time simulations that begin near them" << made
                << "branch,speed_kmh,amplitude_mm,endpoint_mm,automatic_mm,frequency_Hz,endpoint_Hz,automatic_Hz\n";
  }
};

void write_branch(const HuntingBranch& branch, int number, Files& files) {
  for (std::size_t i = 0; i < branch.cycles.size(); ++i) {
    const LimitCycle& c = branch.cycles[i];
    files.cycles << fmt::format("{},{},{:.4f},{:.5f},{:.5f},{},{:.5f},{:.1e},{:.1e}\n", number, i, 3.6 * c.speed,
                                1e3 * c.amplitude(), c.frequency, c.is_stable() ? 1 : 0, std::abs(c.multiplier),
                                c.residual, c.error_along_motion);
  }
  for (std::size_t i = 0; i < branch.folds.size(); ++i) {
    const LimitCycleFold& fold = branch.folds[i];
    const auto& [a, b] = fold.bracket;
    const LimitCycle& c = fold.cycle;
    const double departure = std::max(std::abs(a.speed - c.speed), std::abs(b.speed - c.speed));
    files.folds << fmt::format("{},{},{:.4f},{:.5f},{:.5f},{},{:.5f},{:.5f},{:.5f}\n", number, i, 3.6 * c.speed,
                               1e3 * c.amplitude(), c.frequency, fold.converged ? 1 : 0,
                               1e3 * std::min(a.amplitude(), b.amplitude()),
                               1e3 * std::max(a.amplitude(), b.amplitude()), 3.6 * departure);
  }
}

void compare(const HuntingBranch& branch, int number, const VehicleFlow& flow, double time_step, Files& files,
             report::Series& dots) {
  std::vector<const LimitCycle*> stable;
  for (const LimitCycle& cycle : branch.cycles) {
    if (cycle.is_stable()) stable.push_back(&cycle);
  }
  if (stable.empty()) return;
  std::sort(stable.begin(), stable.end(), [](const auto* a, const auto* b) { return a->speed < b->speed; });
  const double low = stable.front()->speed, step = (stable.back()->speed - low) / (simulated - 1);
  const auto wheelset = static_cast<std::size_t>(branch.section_wheelset);
  double next = low;
  for (const LimitCycle* const cycle : stable) {
    if (cycle->speed < next) continue;
    next += step;
    const auto with = [&](std::optional<ContactForceRule> rule) {
      return simulation(flow, *cycle, branch.section_wheelset, time_step, rule);
    };
    const std::optional<Simulated> same = with(ContactForceRule::endpoint), by_default = with({});
    if (!same || !by_default) continue;
    files.simulations << fmt::format("{},{:.4f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f}\n", number,
                                     3.6 * cycle->speed, 1e3 * cycle->amplitudes[wheelset], 1e3 * same->amplitude,
                                     1e3 * by_default->amplitude, cycle->frequency, same->frequency,
                                     by_default->frequency);
    dots.x.push_back(3.6 * cycle->speed);
    dots.y.push_back(1e3 * by_default->amplitude);
  }
}

report::Series part(const HuntingBranch& branch, bool stable, const std::string& label) {
  report::Series series{label, {}, {}};
  for (const LimitCycle& c : branch.cycles) {
    series.x.push_back(3.6 * c.speed);
    series.y.push_back(c.is_stable() == stable ? 1e3 * c.amplitude() : std::nan(""));
  }
  return series;
}

void compute(const std::string& folder, const std::string& table) {
  const SceneParameters scene = coach_scene(table);
  const VsiModel linear = stability_model(scene), model = limit_cycle_model(scene);
  const VehicleFlow flow(model, 0.0);
  Files files(folder);
  report::SvgPanel panel;
  panel.title = "Limit cycles";
  panel.x_label = "speed [km/h]";
  panel.y_label = "lateral amplitude of a wheelset [mm]";
  report::Series dots{"time simulation", {}, {}};
  // From the linear critical speed on, and through what the coach settles on after a large shift.
  const std::optional<SettledStart> starts[] = {std::nullopt, SettledStart{.speed = 270.0 / 3.6}};
  int number = 0;
  for (const std::optional<SettledStart>& start : starts) {
    ++number;
    HuntingSearch search;
    search.start = start;
    search.speed.high = 400.0 / 3.6;
    search.time_step = scene.integration.time_step;
    const HuntingBranch branch = hunting_branch(linear, model, search, [&](const LimitCycle& c) {
      std::fprintf(stderr, "branch %d: %8.3f km/h %8.4f mm, multiplier %.4f\n", number, 3.6 * c.speed,
                   1e3 * c.amplitude(), std::abs(c.multiplier));
      return true;
    });
    write_branch(branch, number, files);
    compare(branch, number, flow, search.time_step, files, dots);
    for (const bool stable : {true, false}) {
      report::Series line = part(branch, stable, fmt::format("{}, {}", number, stable ? "stable" : "unstable"));
      if (std::all_of(line.y.begin(), line.y.end(), [](double y) { return std::isnan(y); })) continue;
      panel.lines.push_back(std::move(line));
      panel.styles.push_back(stable ? report::LineStyle::solid : report::LineStyle::dashed);
    }
  }
  panel.dots = {dots};
  std::ofstream(folder + "/limit_cycles.svg")
      << report::svg_figure("Manchester coach on S1002 and 60E1 1:40", {panel}, 1);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: limit_cycle_figure FOLDER TABLE.h5\n", stderr);
    return 2;
  }
  try {
    compute(argv[1], argv[2]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
