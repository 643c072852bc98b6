// What the rule of the contact force (integration.contact_force) is worth in scenes: errors of wheel forces against
// fine steps, energy that the time integration of the contacts makes, Newton iterations, processor time. Not a test:
//
//     contact_force_study FOLDER     writes FOLDER/contact_force.csv, the numbers of docs/validation/contact_force.md

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>

#include "kinked_track.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace {

using namespace railtab;

// A coach on the flexible track of the demo, roughness included.
SceneParameters rough_track(double speed) {
  SceneParameters scene;
  scene.train.speed = speed;
  scene.train.force_elements = ForceElementChoice::linear;  // of the committed tables
  scene.contact.mode = ContactMode::online;
  scene.contact.creep_law = "polach";  // of the committed figures
  scene.track.length_before = 36.0;
  scene.track.length_after = 60.0;
  scene.irregularity = std::filesystem::path(RAILTAB_SOURCE_DIR) / "docs/examples/demo_irregularity.csv";
  scene.integration.duration = 0.4;
  return scene;
}

// Every wheelset is set off towards the rail: flanges hit at some 0.3 m/s.
SceneParameters flange_impact() {
  SceneParameters scene = rough_track(400.0 / 3.6);
  scene.irregularity.reset();
  scene.train.initial_yaw = 3e-3;
  scene.integration.duration = 0.2;
  return scene;
}

// Every wheelset is set off across its rails, flange upon the rail on one side: wheels land hard.
SceneParameters landing() {
  SceneParameters scene = rough_track(200.0 / 3.6);
  scene.irregularity.reset();
  scene.train.initial_lateral_shift = 8.5e-3;
  scene.train.initial_yaw = 10e-3;
  scene.integration.duration = 0.1;
  return scene;
}

// Treads fall back on flexible track.
SceneParameters behind_a_hump() {
  SceneParameters scene = rough_track(300.0 / 3.6);
  scene.irregularity.reset();
  scene.integration.duration = 0.1;
  return scene;
}

// A wheelset that a gust has lifted for a tenth of a second comes down.
SceneParameters gust() {
  SceneParameters scene = rough_track(120.0 / 3.6);
  scene.irregularity.reset();
  LoadParameters load;
  load.body = "wheelset-2";
  load.load[2] = -140e3;
  load.gust_duration = 0.2;
  scene.loads = {load};
  scene.integration.duration = 0.25;
  return scene;
}

struct Outcome {
  std::vector<StepRecord> steps;
  std::size_t per_millisecond = 1;
  RunSummary summary;
  EnergyBalance energy;
  double seconds = 0.0;
};

using Rule = std::optional<ContactForceRule>;  // none: automatic

Outcome run(SceneParameters scene, const Irregularity* irregularity, Rule rule, double alpha, double time_step,
            bool account) {
  scene.integration.contact_force = rule;
  scene.integration.alpha = alpha;
  scene.integration.time_step = time_step;
  Outcome result;
  result.per_millisecond = static_cast<std::size_t>(std::lround(1e-3 / time_step));
  RunObserver observer;
  observer.record = [&](const StepRecord& record) { result.steps.push_back(record); };
  if (account) observer.energy = [&](const EnergyBalance& balance) { result.energy = balance; };
  const std::clock_t begin = std::clock();
  VsiModel model = build_model(scene);
  if (irregularity) model.irregularity = *irregularity;
  result.summary = run_scene(scene, model, observer);
  result.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return result;
}

struct Difference {
  double Q = 0, Y = 0;  ///< rms over wheels and milliseconds [N]
};

Difference difference(const Outcome& a, const Outcome& b) {
  Difference sum;
  double n = 0;
  for (std::size_t i = 1; i * a.per_millisecond < a.steps.size() && i * b.per_millisecond < b.steps.size(); ++i) {
    const std::vector<WheelRecord>& of_a = a.steps[i * a.per_millisecond].wheels;
    const std::vector<WheelRecord>& of_b = b.steps[i * b.per_millisecond].wheels;
    for (std::size_t w = 0; w < of_a.size(); ++w, ++n) {
      const double dQ = of_a[w].Q - of_b[w].Q;
      const double dY = of_a[w].Y - of_b[w].Y;
      sum.Q += dQ * dQ;
      sum.Y += dY * dY;
    }
  }
  return {std::sqrt(sum.Q / n), std::sqrt(sum.Y / n)};
}

// Of all wheels and recorded steps [N].
double largest_Y(const Outcome& outcome) {
  double largest = 0.0;
  for (const StepRecord& step : outcome.steps)
    for (const WheelRecord& wheel : step.wheels) largest = std::max(largest, std::abs(wheel.Y));
  return largest;
}

const char* name_of(Rule rule) {
  if (!rule) return "automatic";
  return rule == ContactForceRule::energy ? "energy" : "endpoint";
}

std::string row(const char* name, Rule rule, double alpha, double step, const Outcome& o, const Difference& d,
                const EnergyBalance& energy) {
  const std::string text = fmt::format(
      "{},{:g},{:g},{},{:.1f},{:.1f},{:.2f},{:.2f},{:.3f},{:.3f},{:.3f},{},{},{},{:.3f}\n", name, alpha, 1e3 * step,
      name_of(rule), d.Q, d.Y, 1e-3 * largest_Y(o), 1e-3 * o.summary.wheel_extremes.largest_Q.value,
      energy.contact_gain - energy.stiffness_work, energy.gain(),
      static_cast<double>(o.summary.newton_iterations) / static_cast<double>(o.summary.steps), o.summary.halved_steps,
      o.summary.impact_steps, o.summary.complete ? 1 : 0, o.seconds);
  fmt::print("{}", text);
  std::fflush(stdout);
  return text;
}

std::string study(const char* name, const SceneParameters& scene, const Irregularity* irregularity = nullptr) {
  constexpr double fine_step = 3.125e-5;
  const Outcome reference = run(scene, irregularity, ContactForceRule::energy, 0.0, fine_step, false);
  std::string rows = row(name, ContactForceRule::energy, 0.0, fine_step, reference, {}, {});
  const Outcome fine = run(scene, irregularity, ContactForceRule::endpoint, 0.0, fine_step, false);
  rows += row(name, ContactForceRule::endpoint, 0.0, fine_step, fine, difference(fine, reference), {});
  for (const double alpha : {0.0, -0.05}) {
    for (const double step : {1e-3, 5e-4, 2.5e-4}) {
      for (const Rule rule : {Rule(ContactForceRule::endpoint), Rule(ContactForceRule::energy), Rule()}) {
        const EnergyBalance energy = run(scene, irregularity, rule, alpha, step, true).energy;
        const Outcome o = run(scene, irregularity, rule, alpha, step, false);
        rows += row(name, rule, alpha, step, o, difference(o, reference), energy);
      }
    }
  }
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("contact_force_study FOLDER\n", stderr);
    return 2;
  }
  try {
    std::string text =
        "# error_Q, error_Y: rms difference from the first row of the scene [N]; contact_gain: made by the integration "
        "of\n"
        "# the contacts, gain: of the whole step [J], not accounted for in the two rows of the finest step\n"
        "scene,alpha,step_ms,rule,error_Q,error_Y,largest_Y_kN,largest_Q_kN,contact_gain,gain,iterations,halved,"
        "impact_steps,complete,cpu_s\n";
    text += study("rough", rough_track(300.0 / 3.6));
    text += study("flange", flange_impact());
    text += study("landing", landing());
    const Irregularity jump = hump();
    text += study("hump", behind_a_hump(), &jump);
    text += study("gust", gust());
    write_text_file(std::filesystem::path(argv[1]) / "contact_force.csv", text);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
