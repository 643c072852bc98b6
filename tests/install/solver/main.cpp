// Another program that runs a scene: a coach whose wheels follow the rails rigidly, over a simple beam.

#include <cmath>
#include <cstdio>
#include <fstream>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene.hpp"

namespace {

bool coach_crosses_a_bridge() {
  std::ofstream("scene.toml")
      << "[train]\nvehicle = \"manchester-coach\"\nspeed_kmh = 200\n[contact]\nnormal = \"rigid\"\n"
         "[[bridge]]\nlength = 20.0\n[integration]\nduration = 0.2\ntime_step = 1e-3\n";
  int records = 0;
  double first_load = 0.0;
  const railtab::RunSummary summary = railtab::Scene("scene.toml").run([&](const railtab::StepRecord& step) {
    if (records++ > 0) return;
    for (const railtab::WheelRecord& wheel : step.wheels) first_load += wheel.Q;
  });
  std::printf("%ld steps, %d records, weight on the rails %.1f kN, largest wheel load %.1f kN\n", summary.steps,
              records, 1e-3 * first_load, 1e-3 * summary.wheel_extremes.largest_Q.value);
  return summary.complete && summary.steps == 200 && records > 1 && first_load > 300e3 && first_load < 600e3;
}

bool unknown_key_is_an_input_error() {
  std::ofstream("wrong.toml") << "[train]\nspeeed = 3\n";
  try {
    static_cast<void>(railtab::Scene("wrong.toml"));
  } catch (const railtab::InputError& wrong) {
    std::printf("%s\n", wrong.what());
    return true;
  }
  return false;
}

}  // namespace

int main() { return coach_crosses_a_bridge() && unknown_key_is_an_input_error() ? 0 : 1; }
