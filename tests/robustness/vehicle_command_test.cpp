// The critical speed that `vsi vehicle NAME --table` prints, and what it rejects.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tablegen_fixture.hpp"

namespace railtab {
namespace {

class VehicleOnTable : public TablegenFixture {
 protected:
  void SetUp() override {
    TablegenFixture::SetUp();
    ASSERT_EQ(tablegen("geometry --wheel S1002 --rail 60E1 --rail-inclination 1:40 --lateral=-0.0002:0.0002 --yaw 0:0 "
                       "--roll 0:0 --tolerance 1e-6 --quiet -o t.h5")
                  .exit_code,
              0);
  }
  [[nodiscard]] Outcome vsi(const std::string& arguments) const { return shell("'" VSI_COMMAND "' " + arguments); }
  [[nodiscard]] nlohmann::json json(const std::string& arguments) const {
    const Outcome outcome = vsi(arguments + " --json");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }
  void expect_rejected(const std::string& arguments, const std::string& part) const {
    const Outcome outcome = vsi("vehicle " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  }
};

/// The table's path against a scene with the online search of the same pair.
TEST_F(VehicleOnTable, CriticalSpeedIsThatOfASceneOnItsProfiles) {
  std::ofstream(folder_ / "scene.toml") << "[train]\nvehicle = \"manchester-coach\"\n[contact]\nmode = \"online\"\n"
                                           "rail_inclination = \"1:40\"\n[track]\nkind = \"rigid\"\n"
                                           "[integration]\nduration = 1.0\n";
  for (const std::string amplitude : {"", " --amplitude 3e-3"}) {
    const nlohmann::json scene = json("critical-speed scene.toml" + amplitude);
    const nlohmann::json found = json("vehicle manchester-coach --table t.h5" + amplitude)["hunting"];
    const double speed = found["linear_critical_speed"].get<double>();
    EXPECT_NEAR(speed / scene["linear_critical_speed"].get<double>(), 1.0, 1e-4);
    for (const char* key : {"wheel", "rail", "friction", "amplitude", "searched_to"}) {
      EXPECT_EQ(found[key], scene[key]) << key;
    }
    const std::string text = vsi("vehicle manchester-coach --table t.h5" + amplitude).out;
    EXPECT_NE(text.find(fmt::format("linear critical speed {:.2f} km/h", 3.6 * speed)), std::string::npos) << text;
  }
  EXPECT_TRUE(json("vehicle manchester-coach")["hunting"].is_null());
}

TEST_F(VehicleOnTable, RejectsTablesAndVehiclesThatDoNotFit) {
  expect_rejected("crh380a --table t.h5",
                  "--table: found t.h5, of wheels of 0.46 m radius, expected a table for 0.43 m");
  expect_rejected("velaro-e-coach --table t.h5", "--table: found velaro-e-coach, whose data are vertical only");
  expect_rejected("manchester-coach --table none.h5", "none.h5");
  expect_rejected("manchester-coach --amplitude 3e-3", "--amplitude: found no --table");
  expect_rejected("manchester-coach --table t.h5 --amplitude 1", "--amplitude: found 1 m, expected above 0");
}

}  // namespace
}  // namespace railtab
