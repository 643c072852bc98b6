// Error against run time of the structure's active window: a train on a viaduct of ten spans, beside the same run
// without a reduction.

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "low_pass.hpp"
#include "machine.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/version.hpp"
#include "railtab/runtime/scene/reduction_check.hpp"

namespace railtab::work_precision {
namespace {

constexpr const char* usage =
    "reduction_study TABLE.h5 -o FOLDER [--quick | --long | --steps]\n"
    "Two coaches enter a viaduct of ten spans of 32 m at 200 km/h: runs in windows of several lengths and "
    "without a reduction.\nWrites FOLDER/reduction.csv.\n"
    "--long: eight coaches on a viaduct of 1 km, the window against the whole line; writes FOLDER/long_line.csv.\n"
    "--steps: they enter it at 72 km/h, time steps against one of 0.125 ms, by patches and with the loaded contact, "
    "which TABLE.h5 must have; writes FOLDER/crossing_steps.csv.\n";

SceneParameters viaduct(const std::string& table) {
  SceneParameters scene;
  scene.name = "viaduct of ten spans";
  scene.train.count = 2;
  scene.train.start = -5.0;
  scene.contact.table = table;
  scene.contact.creep_law = "polach";  // of the committed figures
  scene.track.length_before = 90.0;
  scene.track.length_after = 60.0;
  scene.spans.resize(10);
  scene.spectrum = SpectrumParameters{.fade_in = 0.0};
  return scene;
}

// Eight coaches in the middle of 32 spans of 32 m.
SceneParameters long_viaduct(const std::string& table, double speed, double time_step) {
  SceneParameters scene = viaduct(table);
  scene.name = "viaduct of 1 km";
  scene.train.count = 8;
  scene.train.speed = speed;
  scene.train.start = 320.0;
  scene.spans.resize(32);
  scene.integration.time_step = time_step;
  return scene;
}

struct Setting {
  std::string method, setting;
  ReductionParameters reduction;
};

std::vector<Setting> settings(bool quick) {
  std::vector<Setting> all;
  for (double length : quick ? std::vector<double>{20.0} : std::vector<double>{5.0, 10.0, 20.0, 40.0})
    all.push_back(
        {"window", fmt::format("{} m", length), {.kind = Reduction::window, .ahead = length, .behind = length}});
  return all;
}

// What made the numbers, the first line of a CSV.
std::string origin() {
  return fmt::format("# railtab {}, commit {}; {}\n", version(), source_commit(), machine_kind());
}

// Processor time of a step [ms].
double per_step(const ComparedHistory& h) { return 1e3 * h.seconds_steps / static_cast<double>(h.summary.steps); }

// Every n-th step: to compare with a run in steps n times as long.
ComparedHistory thinned(const ComparedHistory& history, std::size_t n) {
  ComparedHistory result = history;
  result.force.clear();
  result.lateral.clear();
  result.deck.clear();
  for (std::size_t i = 0; i < history.force.size(); i += n) {
    result.force.push_back(history.force[i]);
    result.lateral.push_back(history.lateral[i]);
    result.deck.push_back(history.deck[i]);
  }
  return result;
}

// What standards judge of a history: contact forces below 20 Hz (EN 14363), deck accelerations below 30 Hz (EN 1990).
ComparedHistory judged(const ComparedHistory& history, double time_step) {
  return low_passed(history, time_step, 20.0, 30.0);
}

void study_long_line(const std::string& table, const std::filesystem::path& folder) {
  constexpr double duration = 1.0, reference_step = 5e-4;
  std::string text =
      origin() +
      "# eight coaches, 64 wheels, 32 spans of 32 m; against the whole line in the same steps, and in steps of 0.5 ms\n"
      "# *_20hz, *_30hz: below 20 Hz (forces, EN 14363) and 30 Hz (deck, EN 1990), over the largest below that\n"
      "# times: processor time of one core; real_time: time step over the time of a step\n"
      "speed_kmh,reduction,time_step_ms,tolerance,step_ms,real_time,structure_ms,contact_ms,force_max,force_rms,"
      "deck_max,deck_rms,force_max_05ms,deck_max_05ms,force_20hz_05ms,deck_30hz_05ms,default\n";
  for (double kmh : {72.0, 200.0}) {
    const ComparedHistory finest = compared_history(long_viaduct(table, kmh / 3.6, reference_step), duration);
    for (double time_step : {5e-4, 1e-3, 2e-3}) {
      SceneParameters scene = long_viaduct(table, kmh / 3.6, time_step);
      const ComparedHistory whole = time_step > reference_step ? compared_history(scene, duration) : finest;
      const auto every = static_cast<std::size_t>(std::lround(time_step / reference_step));
      const ComparedHistory reference = thinned(finest, every);
      const ComparedHistory slow_reference = thinned(judged(finest, reference_step), every);
      const auto row = [&](const ComparedHistory& h, const char* reduction, double tolerance) {
        const ReductionError e = compare(h, whole), fine = compare(h, reference);
        const ReductionError slow = compare(judged(h, time_step), slow_reference);
        const double steps = 1e-3 * static_cast<double>(h.summary.steps);
        text += fmt::format(
            "{},{},{},{:g},{:.3f},{:.3f},{:.3f},{:.3f},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{}\n",
            kmh, reduction, 1e3 * time_step, tolerance, per_step(h), 1e3 * time_step / per_step(h),
            h.summary.seconds_structure / steps, (h.summary.seconds_contact + h.summary.seconds_lookup) / steps,
            e.force_max, e.force_rms, e.deck_max, e.deck_rms, fine.force_max, fine.deck_max, slow.force_max,
            slow.deck_max, tolerance == IntegrationParameters{}.tolerance ? 1 : 0);
        fmt::print("{}", text.substr(text.rfind('\n', text.size() - 2) + 1));
        std::fflush(stdout);
      };
      row(whole, "none", scene.integration.tolerance);
      scene.reduction.kind = Reduction::window;
      for (double tolerance : {1e-7, 1e-5, 1e-4, 1e-3}) {
        scene.integration.tolerance = tolerance;
        row(compared_history(scene, duration), "window", tolerance);
      }
    }
  }
  write_text_file(folder / "long_line.csv", text, "# railtab ");
}

// The first seconds of docs/examples/viaduct.toml.
void study_steps(const std::string& table, const std::filesystem::path& folder) {
  constexpr double duration = 9.0, reference_step = 1.25e-4;
  SceneParameters scene = long_viaduct(table, 20.0, reference_step);
  scene.train.start = 0.0;
  scene.track.length_before = 240.0;
  scene.track.length_after = 250.0;
  scene.contact.creep_law = ContactParameters{}.creep_law;
  scene.reduction.kind = Reduction::window;
  std::string text =
      origin() +
      "# eight coaches enter a viaduct of 1 km at 72 km/h, 9 s in a window; against steps of 0.125 ms\n"
      "# force_20hz, deck_30hz: largest difference below 20 Hz (forces, EN 14363) and 30 Hz (deck, EN 1990), over the "
      "largest below that; peak_*: of the largest values themselves; force_max, deck_max: nothing filtered\n"
      "# rms_*: root mean square difference over that of what differs from the mean over time, nothing filtered\n"
      "# times: processor time of one core\n"
      "contact,time_step_ms,step_ms,real_time,force_max,deck_max,force_20hz,deck_30hz,peak_force_20hz,peak_deck_30hz,"
      "rms_Q,rms_Y,rms_deck\n";
  for (const auto& [name, elastic] :
       {std::pair{"patches", ElasticContact::patches}, {"loaded", ElasticContact::half_space}}) {
    scene.contact.elastic = elastic;
    scene.integration.time_step = reference_step;
    const ComparedHistory finest = compared_history(scene, duration);
    const ComparedHistory slow_finest = judged(finest, reference_step);
    for (const std::size_t every : {4, 8, 12, 16}) {
      scene.integration.time_step = static_cast<double>(every) * reference_step;
      const ComparedHistory h = compared_history(scene, duration);
      const ReductionError raw = compare(h, thinned(finest, every));
      const ReductionError slow = compare(judged(h, scene.integration.time_step), thinned(slow_finest, every));
      text += fmt::format("{},{:g},{:.3f},{:.3f},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g}\n",
                          name, 1e3 * scene.integration.time_step, per_step(h),
                          1e3 * scene.integration.time_step / per_step(h), raw.force_max, raw.deck_max, slow.force_max,
                          slow.deck_max, slow.peak_force, slow.peak_deck, raw.rms_Q, raw.rms_Y, raw.rms_deck);
      fmt::print("{}", text.substr(text.rfind('\n', text.size() - 2) + 1));
      std::fflush(stdout);
    }
  }
  write_text_file(folder / "crossing_steps.csv", text, "# railtab ");
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 3 || arguments[1] != "-o") throw InputError(usage);
  const std::filesystem::path folder = arguments[2];
  std::filesystem::create_directories(folder);
  if (arguments.size() > 3 && arguments[3] == "--long") {
    study_long_line(arguments[0], folder);
    return 0;
  }
  if (arguments.size() > 3 && arguments[3] == "--steps") {
    study_steps(arguments[0], folder);
    return 0;
  }
  const bool quick = arguments.size() > 3 && arguments[3] == "--quick";
  const double duration = quick ? 0.4 : 1.0;
  SceneParameters scene = viaduct(arguments[0]);
  const ComparedHistory whole = compared_history(scene, duration);
  std::string table =
      origin() +
      "# error against the run without reduction; times: processor time of one core, set-up: wall time\n"
      "method,setting,unknowns,setup_s,step_ms,force_max,force_rms,force_of_static,deck_max,deck_rms,peak_force,"
      "peak_deck\n";
  table += fmt::format("none,,{},{:.2f},{:.4f},0,0,0,0,0,0,0\n", whole.summary.structure_dofs,
                       whole.summary.seconds_setup, per_step(whole));
  for (const Setting& s : settings(quick)) {
    scene.reduction = s.reduction;
    ComparedHistory reduced;
    try {
      reduced = compared_history(scene, duration);
    } catch (const ComputationError& failure) {
      table += fmt::format("# {} {}: {}\n", s.method, s.setting, failure.what());
      fmt::print(stderr, "{}\n", failure.what());
      continue;
    }
    const ReductionError e = compare(reduced, whole);
    table += fmt::format("{},{},{},{:.2f},{:.4f},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g}\n", s.method,
                         s.setting, reduced.summary.structure_dofs, reduced.summary.seconds_setup, per_step(reduced),
                         e.force_max, e.force_rms, e.force_static, e.deck_max, e.deck_rms, e.peak_force, e.peak_deck);
    fmt::print("{}", table.substr(table.rfind('\n', table.size() - 2) + 1));
    std::fflush(stdout);
    write_text_file(folder / "reduction.csv", table, "# railtab ");
  }
  return 0;
}

}  // namespace
}  // namespace railtab::work_precision

int main(int argc, char** argv) {
  try {
    return railtab::work_precision::run({argv + 1, argv + argc});
  } catch (const railtab::InputError& error) {
    fmt::print(stderr, "reduction_study: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "reduction_study: {}\n", error.what());
    return 1;
  }
}
