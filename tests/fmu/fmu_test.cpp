// FMUs of track and bridge against the runs that their wheel loads come from: driven by the importer in
// importer.py, which shares no code with railtab.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "../measured.hpp"
#include "../robustness/vsi_fixture.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

// docs/examples/demo.toml with contacts that need no table, and forces at the ends of undivided steps.
std::string demo_scene() {
  const std::string examples = RAILTAB_SOURCE_DIR "/docs/examples/";
  std::ifstream in(examples + "demo.toml");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto replace = [&](const std::string& what, const std::string& by) {
    const std::size_t place = text.find(what);
    ASSERT_NE(place, std::string::npos) << what;
    text.replace(place, what.size(), by);
  };
  replace("mode = \"table\"\ntable = ", "mode = \"online\"  # ");
  replace("demo_irregularity.csv", examples + "demo_irregularity.csv");
  replace("[integration]\n", "[integration]\ncontact_force = \"endpoint\"\n");
  return text;
}

// Loads and motions at a time, by the names of the FMU's variables.
class Record {
 public:
  Record(const VsiModel& model, const std::filesystem::path& file) : model_(model), out_(file, std::ios::binary) {}

  // @param time at which wheelsets stand where they are recorded
  void add(const VsiState& state, double time) {
    row_.clear();
    const std::vector<RailContact> contacts = place_wheels(model_, time);
    const ElementDeflection& d = state.deflection;
    std::vector<RailHeadMotion> elements;
    const double speed = named_ ? model_.speed(time) : 0.0;  // an FMU learns of it by its first step
    element_motion(contacts, d.force, d.rate, d.slope_force, speed, elements);
    for (int wheel = 0; wheel < 2 * model_.wheelsets(); ++wheel) {
      const std::string wheelset = "wheelset[" + std::to_string(wheel / 2 + 1) + "]";
      if (wheel % 2 == 0) value(wheelset + ".x", model_.wheelset_x(wheel / 2, time));
      const std::string name = wheelset + (wheel % 2 == 0 ? ".left." : ".right.");
      const Eigen::Vector3d load = state.contact.end_force.segment<3>(rail_unknown(wheel));
      const RailContact& contact = contacts[static_cast<std::size_t>(wheel)];
      const LinearMotion& motion = state.structure.whole();
      const RailHeadMotion& element = elements[static_cast<std::size_t>(wheel)];
      values(name, {"Y", "Q", "Mx"}, load);
      values(name + "rail_", {"y", "z", "roll"}, rail_head(contact, motion.displacement) + element.displacement);
      values(name + "rail_", {"y_rate", "z_rate", "roll_rate"}, rail_head(contact, motion.velocity) + element.velocity);
      values(name + "rail_", {"yaw", "pitch"},
             rail_slopes(contact, motion.displacement) + Eigen::Vector2d(element.yaw, -element.slope));
    }
    StepRecord record;
    fill_record(model_, state, record);
    for (std::size_t n = 0; n < record.nodes.size(); ++n) {
      const std::string name = "node[" + std::to_string(n + 1) + "].";
      value(name + "y", record.nodes[n].displacement[1]);
      value(name + "z", record.nodes[n].displacement[2]);
      value(name + "y_acceleration", record.nodes[n].acceleration[1]);
      value(name + "z_acceleration", record.nodes[n].acceleration[2]);
    }
    if (!named_) out_ << names_ << '\n';
    named_ = true;
    out_.write(reinterpret_cast<const char*>(row_.data()), static_cast<std::streamsize>(row_.size() * sizeof(double)));
  }

 private:
  void value(const std::string& name, double number) {
    if (!named_) names_ += (names_.empty() ? "" : " ") + name;
    row_.push_back(number);
  }
  void values(const std::string& prefix, const std::vector<const char*>& names, const Eigen::VectorXd& numbers) {
    for (std::size_t i = 0; i < names.size(); ++i) value(prefix + names[i], numbers[static_cast<Eigen::Index>(i)]);
  }

  const VsiModel& model_;
  std::ofstream out_;
  std::string names_;
  bool named_ = false;
  std::vector<double> row_;
};

class FmuAgainstRun : public VsiCommand {
 protected:
  // Runs scene.toml and writes its FMU, track.fmu, and two records: with wheelsets where the steps put them (by_step),
  // and where they are at the times of the records (by_time).
  void record_run() const {
    SceneParameters scene = read_scene(folder_ / "scene.toml");
    // Without checkpoints: at these a run rearranges its motion, and the rounding of a displacement changes
    // accelerations by 1e-11 of the largest.
    scene.integration.reinitialise_every = std::numeric_limits<long>::max();
    const VsiModel model = build_model(scene);
    VsiState state(model);
    ASSERT_TRUE(static_equilibrium(model, state).converged);
    const double time_step = scene.integration.time_step;
    double before = -time_step;
    Record by_time(model, folder_ / "by_time"), by_step(model, folder_ / "by_step");
    RunObserver observer;
    observer.state = [&](const VsiState& at) {
      by_time.add(at, at.time);
      by_step.add(at, before + time_step);
      before = at.time;
    };
    const RunSummary summary = simulate(model, scene.integration, run_duration(scene, model), 1, state, observer);
    ASSERT_TRUE(summary.complete) << summary.message;
    ASSERT_EQ(summary.halved_steps + summary.impact_steps, 0) << "steps are undivided";
    ASSERT_EQ(vsi("fmu scene.toml -o track.fmu -q").exit_code, 0);
  }

  // Differences of a record from the FMU that it drives, relative to the largest amounts, by kinds of outputs.
  [[nodiscard]] std::map<std::string, double> differences(const std::string& record) const {
    const Outcome compared =
        run("PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 '" RAILTAB_SOURCE_DIR "/tests/fmu/compare_run.py' track.fmu " +
            record);
    EXPECT_EQ(compared.exit_code, 0) << compared.output;
    std::istringstream lines(compared.output);
    std::map<std::string, double> result;
    std::string kind;
    for (double difference = 0.0, amount = 0.0; lines >> kind >> difference >> amount;) {
      EXPECT_GT(amount, 0.0) << kind;
      result[kind] = difference;
    }
    constexpr std::size_t rail_and_node_motions = 12;
    EXPECT_EQ(result.size(), rail_and_node_motions) << compared.output;
    return result;
  }
};

double largest(const std::map<std::string, double>& differences) {
  double result = 0.0;
  for (const auto& [kind, difference] : differences) {
    std::printf("%s: %.2g\n", kind.c_str(), difference);
    result = std::max(result, difference);
  }
  return result;
}

// The run starts where an FMU does, from the static equilibrium under the loads of the wheels, without pre-roll.
TEST_F(FmuAgainstRun, ReproducesTheMotionsOfTheDemo) {
  write("scene.toml", demo_scene());
  record_run();
  // The FMU's step is that of the run. Rounding is what is left: compilers may contract products and sums of the same
  // formula in other ways, an ulp per operation that 4000 steps do not enlarge.
  const double of_steps = largest(differences("by_step"));
  EXPECT_LT(of_steps, 1e-12);
  testing::measured("fmu.by_step", of_steps);
  // A step ends at t + Δt, after which the run sets its clock to n·Δt: wheelsets recorded there stand beside the loads
  // of the step by up to an ulp of their position, 1e-14 m.
  const double of_times = largest(differences("by_time"));
  EXPECT_LT(of_times, 1e-9);
  testing::measured("fmu.by_time", of_times);
}

// An imported bridge: its matrices are not factored in sections.
TEST_F(FmuAgainstRun, ReproducesTheMotionsOfABridgeByItsModes) {
  const std::string head =
      "[train]\nvehicle = \"manchester-coach\"\nstart = -1.0\n[contact]\nmode = \"online\"\n"
      "[track]\nkind = \"flexible\"\nlength_before = 30\nlength_after = 10\n";
  write("beam.toml", head + "[[bridge]]\nlength = 16\nelements = 8\n");
  const Outcome modes = vsi("structure beam.toml --modes 6 -o few");
  ASSERT_EQ(modes.exit_code, 0) << modes.output;
  const std::size_t place = modes.output.find("[structure]");
  ASSERT_NE(place, std::string::npos) << modes.output;
  write("scene.toml", head + modes.output.substr(place) +
                          "[integration]\ntime_step = 1e-3\nduration = 0.3\ncontact_force = \"endpoint\"\n");
  record_run();
  EXPECT_LT(largest(differences("by_step")), 1e-12);
}

}  // namespace
}  // namespace railtab
