#include "railtab/runtime/vsi/derailment.hpp"

#include <gtest/gtest.h>

namespace railtab {
namespace {

// One wheelset over rigid rails, free along y and z and in the air.
VsiModel wheelset() {
  VsiModel model;
  model.vehicle = assemble_vehicle({"wheelset",
                                    {{"wheelset", 1500.0, {1, 1, 1}, {0, 0, -0.46}}},
                                    {},
                                    {0},
                                    {{held, 0, 1, held, held, held}},
                                    0.46,
                                    10.0});
  model.vehicle_x = {0.0};
  model.contact.speed = 20.0;
  return model;
}

VsiState standing(const VsiModel& model, double y, double z, double time = 0.0) {
  VsiState state(model);
  state.time = time;
  state.vehicle[0].displacement << y, z;
  return state;
}

TEST(Derailment, IsBesideAboveOrBelowTheRailsWithAWheelInTheAir) {
  const VsiModel model = wheelset();
  EXPECT_EQ(derailment(model, standing(model, 0.14, 0.09)), "");
  EXPECT_EQ(derailment(model, standing(model, 0.0, -0.99)), "");
  EXPECT_EQ(derailment(model, standing(model, 0.16, -0.02, 1.5)),
            "wheelset 1 has left the rails at t = 1.5 s: it stands 0.16 m to the right and 0.02 m above");
  EXPECT_EQ(derailment(model, standing(model, -0.01, 0.11)),
            "wheelset 1 has left the rails at t = 0 s: it stands 0.01 m to the left and 0.11 m below");
  EXPECT_EQ(derailment(model, standing(model, 0.0, -1.01)),
            "wheelset 1 has left the rails at t = 0 s: it stands 0 m to the right and 1.01 m above");
  VsiState carried = standing(model, 0.16, 0.0);
  for (WheelContact& contact : carried.contact.contact) contact.patches.count = 1;
  EXPECT_EQ(derailment(model, carried), "");
}

TEST(Derailment, IsAgainstRailsThatTheGroundCarriesAlong) {
  VsiModel model = wheelset();
  model.ground_motion.emplace(GroundRecord::from_displacement({0.0, 1.0, 2.0}, {{0.0, 0.0}, {0.3, 0.0}, {0.6, 0.0}}));
  const double ground = model.ground_motion->at(0.0, 1.0).displacement[0];
  ASSERT_GT(ground, 0.2);
  EXPECT_EQ(derailment(model, standing(model, ground, 0.0, 1.0)), "");
  EXPECT_NE(derailment(model, standing(model, 0.0, 0.0, 1.0)), "");
}

}  // namespace
}  // namespace railtab
