// A scene costs what it names: on rigid track with a linear creep law no matrix of a structure is built and no file
// of one, nor the creep table, is opened.

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/runtime/scene/run_plan.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/vsi/step_record.hpp"
#include "railtab/tables/files/creep_table_file.hpp"

namespace railtab {
namespace {

/// Counts how often files are opened, by the kernel's own account (inotify).
class Opens {
 public:
  explicit Opens(const std::vector<std::filesystem::path>& files) : handle_(inotify_init1(IN_NONBLOCK)) {
    for (const auto& file : files) EXPECT_GE(inotify_add_watch(handle_, file.c_str(), IN_OPEN), 0) << file;
  }
  ~Opens() { close(handle_); }
  Opens(const Opens&) = delete;
  Opens& operator=(const Opens&) = delete;

  /// Since the last call.
  [[nodiscard]] int count() const {
    alignas(inotify_event) std::array<char, 4096> buffer;
    int events = 0;
    for (ssize_t bytes = 0; (bytes = read(handle_, buffer.data(), buffer.size())) > 0;) {
      for (ssize_t at = 0; at < bytes; ++events) {
        const auto* event = reinterpret_cast<const inotify_event*>(buffer.data() + at);
        at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
      }
    }
    return events;
  }

 private:
  int handle_;
};

class LeanScene : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / ("lean_scene_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    for (const char* name : {"mass.mtx", "damping.mtx", "stiffness.mtx", "dofs.csv"}) {
      std::ofstream(folder_ / name) << "nothing that a reader would take";
      files_.push_back(folder_ / name);
    }
    files_.push_back(shipped_creep_table());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Every file named, whatever the track: parameters that a program has put together.
  [[nodiscard]] SceneParameters scene(TrackKind kind, const std::string& creep_law) const {
    std::ofstream(folder_ / "scene.toml")
        << "[contact]\nmode = \"online\"\ncreep_law = \"" << creep_law
        << "\"\n[track]\nkind = \"imported\"\n[structure]\nmass = \"mass.mtx\"\ndamping = \"damping.mtx\"\n"
           "stiffness = \"stiffness.mtx\"\ndofs = \"dofs.csv\"\n"
           "[integration]\nduration = 0.01\n";
    SceneParameters parameters = read_scene(folder_ / "scene.toml");
    parameters.track_kind = kind;
    if (kind == TrackKind::rigid) parameters.files.clear();  // whose checksums the results would keep
    return parameters;
  }

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> files_;
};

TEST_F(LeanScene, RigidTrackWithALinearCreepLawOpensNoFile) {
  const Opens opens(files_);
  const SceneParameters lean = scene(TrackKind::rigid, "linear");
  const RunSummary summary = run_scene(lean, {});
  EXPECT_TRUE(summary.complete) << summary.message;
  EXPECT_EQ(summary.structure_dofs, 0);
  EXPECT_EQ(summary.back_substitutions, 0);
  EXPECT_EQ(opens.count(), 0);
  // The count sees what is opened: the creep table by its law, the matrices by an imported track.
  EXPECT_TRUE(run_scene(scene(TrackKind::rigid, "table"), {}).complete);
  EXPECT_GT(opens.count(), 0);
  EXPECT_ANY_THROW(static_cast<void>(run_scene(scene(TrackKind::imported, "linear"), {})));
  EXPECT_GT(opens.count(), 0);
}

TEST_F(LeanScene, PlanSaysWhatIsLeftOut) {
  const RunPlan lean = plan_run(scene(TrackKind::rigid, "linear"));
  EXPECT_EQ(lean.structure_dofs, 0);
  EXPECT_EQ(lean.vehicle_dofs, 41);
  EXPECT_LT(lean.memory.step_reads, 1e6);
  SceneParameters vertical = scene(TrackKind::rigid, "linear");
  vertical.contact.normal = NormalContact::rigid;
  const RunPlan plan = plan_run(vertical);
  EXPECT_EQ(plan.vehicle_dofs, 16);
  std::string left_out;
  for (const std::string& part : plan.left_out) left_out += part + "\n";
  EXPECT_NE(left_out.find("the track is rigid"), std::string::npos);
  EXPECT_NE(left_out.find("lateral, roll and yaw degrees of freedom of the vehicles"), std::string::npos);
  EXPECT_NE(left_out.find("creep forces"), std::string::npos);
  vertical.track_kind = TrackKind::flexible;
  vertical.track.elements_per_bay = 2;
  vertical.structure.files = {};
  const RunPlan track = plan_run(vertical);
  EXPECT_GT(track.structure_dofs, 1000);
  EXPECT_GT(track.memory.step_reads, 8.0 * sizeof(double) * static_cast<double>(track.structure_dofs));
  EXPECT_GT(track.memory.most - track.memory.undivided, 1e6);  // operators of divided steps
  vertical.contact.normal = NormalContact::hertz;
  const long two_elements = plan_run(vertical).structure_dofs;
  EXPECT_GT(static_cast<double>(two_elements), 1.8 * static_cast<double>(track.structure_dofs));
  vertical.track.elements_per_bay = 0;
  const RunPlan one_element = plan_run(vertical);
  EXPECT_LT(4 * one_element.structure_dofs, 3 * two_elements);
  EXPECT_NE(one_element.left_out.back().find("rail nodes between sleepers"), std::string::npos);
}

}  // namespace
}  // namespace railtab
