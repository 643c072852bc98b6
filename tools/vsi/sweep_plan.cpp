#include "sweep_plan.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_lines.hpp"
#include "run_folder.hpp"

namespace railtab::vsi {
namespace {

constexpr double most_runs = 100000;

double number(const std::string& option, const std::string& text, std::string_view part, std::string_view forms) {
  double value = 0.0;
  if (!parse(part, value)) throw input_error(option, text, forms);
  return value;
}

std::string cell(const report::Extreme& extreme) { return extreme.found() ? fmt::format("{:.8g}", extreme.value) : ""; }

}  // namespace

std::vector<double> values_of_range(const std::string& option, const std::string& text, std::string_view forms) {
  const std::size_t first = text.find(':');
  if (first == std::string::npos) return {number(option, text, text, forms)};
  const std::size_t second = text.find(':', first + 1);
  if (second == std::string::npos) throw input_error(option, text, forms);
  const std::string_view view = text;
  const double low = number(option, text, view.substr(0, first), forms);
  const double high = number(option, text, view.substr(first + 1, second - first - 1), forms);
  const double step = number(option, text, view.substr(second + 1), forms);
  if (!(step > 0.0 && high >= low && (high - low) / step < most_runs)) {
    throw input_error(option, text, fmt::format("LO <= HI and STEP > 0, at most {} values", most_runs));
  }
  constexpr double rounding = 1e-9;
  std::vector<double> values;
  const auto count = static_cast<long>(std::floor((high - low) / step * (1.0 + rounding) + rounding));
  for (long k = 0; k <= count; ++k) values.push_back(low + static_cast<double>(k) * step);
  return values;
}

std::vector<double> speeds_of_options(const CommandLine& line) {
  const bool si = line.given("speed"), kmh = line.given("speed-kmh");
  if (si && kmh) throw input_error("--speed-kmh", "--speed too", "one of them");
  if (!si && !kmh) return {};
  const std::string option = si ? "speed" : "speed-kmh";
  const double unit = si ? 1.0 : 1.0 / 3.6;
  constexpr double lowest = 1e-3, highest = 200.0;  // [m/s]
  std::vector<double> speeds = values_of_range("--" + option, line.text(option));
  for (double& speed : speeds) {
    const double amount = speed;
    speed *= unit;
    if (speed >= lowest && speed <= highest) continue;
    throw input_error("--" + option, fmt::format("{:g}", amount),
                      fmt::format("{:g} to {:g} {}", lowest / unit, highest / unit, si ? "m/s" : "km/h"));
  }
  return speeds;
}

std::vector<SweepRun> sweep_runs(const SceneParameters& scene, const std::vector<double>& speeds, int seeds) {
  if (seeds > 1 && !scene.spectrum) {
    throw input_error("--seeds", fmt::format("{} and no random track", seeds), "irregularity.spectrum in the scene");
  }
  if (static_cast<double>(seeds) * static_cast<double>(speeds.size()) > most_runs) {
    throw input_error("--seeds", fmt::format("{} at {} speeds", seeds, speeds.size()),
                      fmt::format("at most {} runs", most_runs));
  }
  std::vector<SweepRun> runs;
  std::set<std::string> names;
  for (double speed : speeds) {
    for (int k = 0; k < seeds; ++k) {
      const int seed = scene.spectrum ? scene.spectrum->seed + k : 0;
      std::string name = fmt::format("v{:07.3f}", speed);
      if (scene.spectrum) name += fmt::format("-s{:03}", seed);
      if (!names.insert(name).second) {
        throw input_error("speeds", fmt::format("two runs of the name {}", name),
                          "steps of at least 0.001 m/s (0.0036 km/h)");
      }
      runs.push_back({speed, seed, std::move(name)});
    }
  }
  return runs;
}

SceneParameters scene_of(const SceneParameters& scene, const SweepRun& run) {
  SceneParameters result = scene;
  result.train.speed = run.speed;
  result.name = fmt::format("{}, {:.6g} km/h", scene.name, 3.6 * run.speed);
  result.text += fmt::format("\n# vsi sweep: train.speed = {}", run.speed);
  if (result.spectrum) {
    result.spectrum->seed = run.seed;
    result.name += fmt::format(", seed {}", run.seed);
    result.text += fmt::format(", irregularity.seed = {}", run.seed);
  }
  result.text += "\n";
  result.validate();
  return result;
}

PooledRun pooled(const SceneParameters& scene, const SweepRun& run) {
  return {run.name, [&scene, run] { return scene_of(scene, run); },
          [run](const report::Headline& headline, const RunSummary& summary, const std::filesystem::path&) {
            return summary_row(run, headline, summary);
          }};
}

std::string row_begin(const SweepRun& run) {
  return fmt::format("{},{:.6g},{:.6g},{},", run.name, run.speed, 3.6 * run.speed, run.seed);
}

std::string summary_columns() {
  return "run,speed[m/s],speed[km/h],seed,complete,max_deck_acceleration[m/s2],max_deck_displacement[m],"
         "max_car_body_vertical_acceleration[m/s2],max_car_body_lateral_acceleration[m/s2],"
         "max_derailment_coefficient[-],max_derailment_coefficient_2m[-],max_track_shift_force_2m[N],"
         "max_wheel_unloading[-],max_Q[N],min_Q[N],simulated_time[s],steps,"
         "halved_steps,run_time[s],message\n";
}

std::string summary_row(const SweepRun& run, const report::Headline& headline, const RunSummary& summary) {
  return fmt::format("{}{},{},{},{},{},{},{},{},{},{},{},{:.6g},{},{},{:.3f},{}\n", row_begin(run),
                     summary.complete ? 1 : 0, cell(headline.deck_acceleration), cell(headline.deck_displacement),
                     cell(headline.car_body_vertical), cell(headline.car_body_lateral), cell(headline.derailment),
                     cell(headline.derailment_2m), cell(headline.track_shift_2m), cell(headline.unloading),
                     cell(headline.largest_Q), cell(headline.smallest_Q), headline.simulated_time, summary.steps,
                     summary.halved_steps, summary.seconds_total, message_cell(summary.message));
}

}  // namespace railtab::vsi
