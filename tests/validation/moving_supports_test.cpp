// Moving supports of imported and of reduced structures: against a closed-form oscillator, against the structure that
// is not reduced, and with a train that is taken along.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <span>

#include "../measured.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/reduction_check.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/structure/carried_motion.hpp"
#include "railtab/runtime/structure/structure_import.hpp"
#include "railtab/runtime/vsi/external_load.hpp"
#include "railtab/runtime/vsi/support_motion.hpp"

namespace railtab {
namespace {

constexpr double pi = std::numbers::pi;

const std::filesystem::path folder =
    std::filesystem::temp_directory_path() / ("railtab_moving_supports_" + std::to_string(getpid()));
const struct Folder {
  Folder() { std::filesystem::create_directories(folder); }
  ~Folder() { std::filesystem::remove_all(folder); }
} temporary;

std::filesystem::path write(const std::string& name, const std::string& text) {
  std::ofstream(folder / name) << text;
  return folder / name;
}

// Shaking of 1.2 s, of some m/s², along y and z; what two stations have differs.
std::filesystem::path shaking(const std::string& name, double phase) {
  std::string text = "t[s],y[m/s2],z[m/s2]\n";
  for (int i = 0; i <= 120; ++i) {
    const double t = 0.01 * i;
    const double a = 2.0 * std::sin(pi * t / 1.2) * std::sin(2.0 * pi * 3.0 * t + phase);
    text += std::to_string(t) + "," + std::to_string(a) + "," + std::to_string(0.5 * a) + "\n";
  }
  return write(name, text);
}

// Two equal masses on springs and dampers from one support, as a program would export them: the support's row is there,
// and damping in proportion to the mass, which must not brake what moves with the ground.
constexpr double mass = 2e4, omega = 2.0 * pi * 2.1, mass_damping = 0.4, stiffness_damping = 2e-3, at_support = 5e3;

StructureModel imported_masses() {
  const auto matrix = [](const std::string& name, double own, double coupling, double support) {
    char text[400];
    std::snprintf(text, sizeof text,
                  "%%%%MatrixMarket matrix coordinate real symmetric\n3 3 5\n1 1 %.17g\n2 2 %.17g\n3 1 %.17g\n"
                  "3 2 %.17g\n3 3 %.17g\n",
                  own, own, coupling, coupling, support);
    return write(name, text);
  };
  const double k = mass * omega * omega, b = stiffness_damping, a = mass_damping;
  const auto K = matrix("k", k, -k, 2.0 * k);
  const auto M = matrix("m", mass, at_support, mass);
  const auto C = matrix("c", a * mass + b * k, a * at_support - b * k, a * mass + 2.0 * b * k);
  const auto dofs =
      write("dofs", "row,node,x[m],motion,rail\n1,r0,0.0,z,both\n2,r1,4.0,z,both\n3,pier,2.0,z,support\n");
  return import_structure({M, C, K, dofs});
}

double particle(double t) { return 0.02 * (1.0 - std::cos(5.0 * t)) * (1.0 - std::cos(5.0 * t)); }

// Displacement of the masses relative to the support under displacement(t), by HHT.
std::vector<double> relative_history(StructureModel structure, double time_step, double end) {
  std::vector<double> time;
  std::vector<GroundVector> displacement;
  for (int i = 0; i <= 400; ++i) {
    time.push_back(0.005 * i);
    displacement.emplace_back(0.0, particle(time.back()));
  }
  VsiModel model;
  model.ground_motion.emplace(GroundRecord::from_displacement(time, displacement));
  model.structure = share(std::move(structure));
  const StructureModel& s = *model.structure;
  const HhtScheme hht{.alpha = -0.05, .time_step = time_step};
  StructureResponse response(s, hht);
  LinearMotion motion(s.dofs());
  Eigen::VectorXd load;
  std::vector<double> relative{0.0};
  const RailContact at = rail_contact(s, RailSide::left, 1.0);
  for (int step = 0; step * time_step < end - 1e-9; ++step) {
    past_contact_load(hht, motion, {0, s.dofs()}, load);
    add_ground_load(model, hht, step * time_step, {0, s.dofs()}, load);
    update(hht, response.increment(motion, load), motion);
    const SupportMotion now = support_motion(*model.ground_motion, s.supports.x, (step + 1) * time_step);
    const double head = rail_head(at, motion.displacement)[1] + carried_head(at, s.supports, now.displacement)[1];
    relative.push_back(head - now.displacement[1]);
  }
  return relative;
}

// u'' + 2ζω u' + ω² u = −p g'' of the smooth motion by a classical Runge-Kutta scheme of fourth order, far finer.
std::vector<double> oscillator(double time_step, double end) {
  const double p = 1.0 + at_support / mass;
  const double damping = mass_damping + stiffness_damping * omega * omega;  // of the relative motion, both parts
  const auto acceleration = [&](double t, double u, double v) {
    // g = A (1 − cos wt)², g'' = 2 A w² (cos wt − cos 2wt)
    const double g = 2.0 * 0.02 * 25.0 * (std::cos(5.0 * t) - std::cos(10.0 * t));
    return -p * g - damping * v - omega * omega * u;
  };
  std::vector<double> result{0.0};
  constexpr int fine = 20;
  const double h = time_step / fine;
  double u = 0.0, v = 0.0;
  for (int step = 0; step * time_step < end - 1e-9; ++step) {
    for (int i = 0; i < fine; ++i) {
      const double t = step * time_step + i * h;
      const double k1 = acceleration(t, u, v), k2 = acceleration(t + h / 2, u + h / 2 * v, v + h / 2 * k1);
      const double k3 = acceleration(t + h / 2, u + h / 2 * v + h * h / 4 * k1, v + h / 2 * k2);
      const double k4 = acceleration(t + h, u + h * v + h * h / 2 * k2, v + h * k3);
      u += h * v + h * h / 6 * (k1 + k2 + k3);
      v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    result.push_back(u);
  }
  return result;
}

double oscillator_error(const StructureModel& structure, double time_step) {
  const std::vector<double> expected = oscillator(time_step, 1.8);
  const std::vector<double> found = relative_history(structure, time_step, 1.8);
  double worst = 0.0, size = 0.0;
  EXPECT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    worst = std::max(worst, std::abs(found[i] - expected[i]));
    size = std::max(size, std::abs(expected[i]));
  }
  return worst / size;
}

TEST(MovingSupports, ImportedAndReducedMassesAreTheClosedFormOscillator) {
  const StructureModel imported = imported_masses();
  ASSERT_EQ(imported.dofs(), 2);
  ASSERT_EQ(imported.supports.columns(), 2);
  EXPECT_FALSE(imported.supports.alike_only());
  const StructureModel relative = relative_to_supports(imported);
  for (const auto& [name, structure] : {std::pair{"imported", imported}, {"relative", relative}}) {
    const double coarse = oscillator_error(structure, 4e-3), fine = oscillator_error(structure, 2e-3);
    testing::measured(std::string("ground.") + name, 1e4 * fine);
    std::printf("%s masses on a moving support: %.2e of the largest deflection at 2 ms, order %.2f\n", name, fine,
                std::log2(coarse / fine));
    EXPECT_LT(fine, 3e-3) << name;
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.3) << name;
  }
}

// A support forgotten in the table: the rail does not follow those that are there.
TEST(MovingSupports, SupportsThatDoNotCarryTheRailsAreRejected) {
  static_cast<void>(imported_masses());
  const auto K = write("k",
                       "%%MatrixMarket matrix coordinate real symmetric\n3 3 5\n1 1 3e6\n2 2 2e6\n3 1 -2e6\n"
                       "3 2 -2e6\n3 3 4e6\n");
  try {
    static_cast<void>(import_structure({folder / "m", folder / "c", K, folder / "dofs"}));
    FAIL() << "accepted";
  } catch (const InputError& wrong) {
    EXPECT_NE(std::string(wrong.what()).find("carry the rail at x = 0 m by 0.66"), std::string::npos) << wrong.what();
  }
  const auto free = write("k", "%%MatrixMarket matrix coordinate real symmetric\n3 3 2\n1 1 3e6\n3 3 4e6\n");
  EXPECT_THROW(static_cast<void>(import_structure({folder / "m", folder / "c", free, folder / "dofs"})), InputError);
}

// Four spans with a coach, shaken from the start on.
SceneParameters shaken(Reduction reduction, NormalContact normal) {
  SceneParameters scene;
  scene.contact.mode = ContactMode::online;
  scene.contact.creep_law = "polach";
  scene.contact.normal = normal;
  scene.train.start = -2.0;
  scene.track.length_before = 50.0;
  scene.track.length_after = 30.0;
  BridgeParameters span;
  span.length = 16.0;
  span.elements = 16;
  span.Iy = 2.0;
  span.Iz = 4.0;
  scene.spans.assign(4, span);
  scene.integration.time_step = 1e-3;
  scene.reduction.kind = reduction;
  scene.ground_motion.resize(1);
  scene.ground_motion[0].file = shaking("record.csv", 0.0);
  return scene;
}

SceneParameters with_two_stations(SceneParameters scene) {
  scene.ground_motion.resize(2);
  scene.ground_motion[1].file = shaking("other.csv", 0.4);
  scene.ground_motion[1].x = 40.0;
  return scene;
}

void print(const char* name, const ReductionError& e) {
  std::printf("%s: force %.2e, rms %.2e; deck %.2e, rms %.2e\n", name, e.force_max, e.force_rms, e.deck_max,
              e.deck_rms);
  testing::measured(std::string("ground.") + name + "_force", 100.0 * e.force_max);
  testing::measured(std::string("ground.") + name + "_deck", 100.0 * e.deck_max);
}

// Spans that the train comes to have been shaken for a second by then, those that it leaves shake on.
TEST(MovingSupports, WindowIsTheWholeLine) {
  SceneParameters scene = shaken(Reduction::window, NormalContact::rigid);
  scene.train.speed = 30.0;
  scene.reduction.ahead = scene.reduction.behind = 10.0;
  SceneParameters wave = scene;
  wave.ground_motion[0].wave_speed = 400.0;
  for (const auto& [name, shaking_scene] :
       {std::pair{"window", scene}, {"window_stations", with_two_stations(scene)}, {"window_wave", wave}}) {
    const ReductionError e = check_reduction(shaking_scene, 1.2);
    print(name, e);
    EXPECT_LT(e.force_max, 2e-3) << name;
    EXPECT_LT(e.deck_max, 0.01) << name;
    EXPECT_GT(e.deck_max, 0.0) << name;
  }
}

TEST(MovingSupports, AResumedWindowIsTheUninterruptedOne) {
  SceneParameters scene = shaken(Reduction::window, NormalContact::rigid);
  scene.train.speed = 60.0;
  scene.reduction.ahead = scene.reduction.behind = 6.0;
  scene.integration.duration = 1.0;
  scene.integration.reinitialise_every = 130;
  std::vector<RunCheckpoint> checkpoints;
  const auto last_of = [&](const std::optional<RunCheckpoint>& from) {
    StepRecord last;
    RunObserver observer;
    observer.record = [&](const StepRecord& record) { last = record; };
    observer.checkpoint = [&](long step, std::span<const double> state) {
      if (!from) checkpoints.push_back({step, {state.begin(), state.end()}});
    };
    EXPECT_TRUE(run_scene(scene, observer, from).complete);
    return last;
  };
  const StepRecord whole = last_of(std::nullopt);
  ASSERT_GE(checkpoints.size(), 5U);
  for (const std::size_t c : {0U, 3U}) {
    const StepRecord resumed = last_of(checkpoints[c]);
    for (std::size_t w = 0; w < whole.wheels.size(); ++w) EXPECT_EQ(resumed.wheels[w].Q, whole.wheels[w].Q);
    for (std::size_t n = 0; n < whole.nodes.size(); ++n) {
      for (const std::size_t k : {0U, 2U, 4U}) {
        EXPECT_EQ(resumed.nodes[n].displacement[k], whole.nodes[n].displacement[k]);
        EXPECT_EQ(resumed.nodes[n].acceleration[k], whole.nodes[n].acceleration[k]);
      }
    }
  }
}

// Slow ground takes a train along, farther than a wheelset may stand beside rails that are at rest.
TEST(MovingSupports, ATrainIsTakenAlong) {
  std::string text = "t[s],y[m],z[m]\n";
  for (int i = 0; i <= 60; ++i) {
    const double part = 0.5 * (1.0 - std::cos(pi * i / 60.0));
    text += std::to_string(0.05 * i) + "," + std::to_string(0.3 * part) + "," + std::to_string(-0.04 * part) + "\n";
  }
  double lowest = 1e9, highest = 0.0;
  for (const Reduction reduction : {Reduction::none, Reduction::window}) {
    SceneParameters scene = shaken(reduction, NormalContact::hertz);
    scene.spans.clear();
    scene.track.length_before = 36.0;
    scene.track.length_after = 16.0;
    scene.train.start = 0.0;
    scene.train.speed = 4.0;
    scene.reduction.behind = scene.reduction.ahead = 8.0;
    scene.integration.time_step = 2e-3;
    scene.integration.duration = 3.4;
    scene.ground_motion[0].file = write("slow.csv", text);
    StepRecord first, last;
    double least = 1e9, most = 0.0;
    RunObserver observer;
    observer.record = [&](const StepRecord& r) {
      if (r.time == 0.0) first = r;
      last = r;
      for (const WheelRecord& wheel : r.wheels) {
        least = std::min(least, wheel.Q);
        most = std::max(most, wheel.Q);
      }
    };
    const RunSummary summary = run_scene(scene, observer);
    ASSERT_TRUE(summary.complete) << summary.message;
    EXPECT_NEAR(last.bodies[0].displacement[1], 0.3, 0.01);
    EXPECT_NEAR(last.bodies[0].displacement[2] - first.bodies[0].displacement[2], -0.04, 1e-3);
    for (int w = 3; w < 7; ++w) EXPECT_NEAR(last.bodies[static_cast<std::size_t>(w)].displacement[1], 0.3, 3e-3);
    for (const MotionRecord& node : last.nodes) {
      EXPECT_NEAR(node.displacement[1], 0.3, 1e-3);
      EXPECT_NEAR(node.displacement[2], -0.04, 1e-3);
    }
    std::printf("%s: wheel loads %.3f to %.3f of the static one\n", std::string(reduction_name(reduction)).c_str(),
                least / first.wheels[0].Q, most / first.wheels[0].Q);
    EXPECT_GT(least, 0.93 * first.wheels[0].Q);
    EXPECT_LT(most, 1.07 * first.wheels[0].Q);
    lowest = std::min(lowest, least / first.wheels[0].Q);
    highest = std::max(highest, most / first.wheels[0].Q);
  }
  testing::measured("ground.along_least", lowest);
  testing::measured("ground.along_most", highest);
}

// A wheelset in the air beside rails that their supports have carried away, or with them.
TEST(MovingSupports, DerailmentKnowsWhereTheRailsAre) {
  SceneParameters scene = shaken(Reduction::window, NormalContact::hertz);
  scene.contact.normal = NormalContact::hertz;
  VsiModel model = build_model(scene);
  model.ground_motion.emplace(GroundRecord::from_displacement({0.0, 1.0, 2.0}, {{0.0, 0.0}, {0.3, 0.0}, {0.6, 0.0}}));
  VsiState state(model);
  state.time = 1.0;
  const ContactProblem present = present_contact(model, state);
  const double ground = model.ground_motion->at(0.0, 1.0).displacement[0];
  ASSERT_GT(ground, 0.2);
  for (int w = 0; w < model.wheelsets(); ++w) {
    for (int side = 0; side < 2; ++side) {
      const RailHeadMotion rail = rail_motion(present, present.predicted, w, side);
      EXPECT_NEAR(rail.displacement[0], ground, 1e-9);
      EXPECT_NEAR(rail.displacement[2], 0.0, 1e-9);
      EXPECT_NEAR(rail.velocity[0], model.ground_motion->at(0.0, 1.0).velocity[0], 1e-9);
    }
  }
}

}  // namespace
}  // namespace railtab
