#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

/// ω² and lower/upper amplitude ratio of a mass on a mass on the ground: m1 on k1 on m2 on k2.
struct ChainMode {
  double omega2, ratio;
};
std::array<ChainMode, 2> two_mass_chain(double m1, double k1, double m2, double k2) {
  const double half_sum = 0.5 * (k1 / m1 + (k1 + k2) / m2);
  const double root = std::sqrt(half_sum * half_sum - k1 * k2 / (m1 * m2));
  std::array<ChainMode, 2> modes;
  for (int i = 0; i < 2; ++i) {
    const double omega2 = half_sum + (i == 0 ? -root : root);
    modes[i] = {omega2, (k1 - m1 * omega2) / k1};
  }
  return modes;
}

/// |K·u - ω²·M·u| over the dofs of car body and bogies (the wheelsets stand still), relative to |K·u|.
double mode_residual(const VehicleModel& coach, const Eigen::VectorXd& u, double omega2) {
  double residual = 0, scale = 0;
  for (int body = 0; body < 3; ++body) {
    for (const int dof : coach.dof[body]) {
      if (dof == held) continue;
      const double force = coach.stiffness.row(dof).dot(u);
      residual += std::pow(force - omega2 * coach.mass.row(dof).dot(u), 2);
      scale += force * force;
    }
  }
  return std::sqrt(residual / scale);
}

CoachParameters manchester() { return coach_parameters("manchester-coach"); }

/// Closed forms know no weight that leans.
constexpr VehicleWeight springs_alone{standard_gravity, GeometricStiffness::omitted};

TEST(Coach, HasFortyOneDofsAndSymmetricMatrices) {
  for (const char* name : {"manchester-coach", "chinese-high-speed-car"}) {
    const VehicleModel coach = build_coach(coach_parameters(name));
    EXPECT_EQ(coach.name, name);
    ASSERT_EQ(coach.dofs(), 41);
    EXPECT_EQ(coach.dof[0][0], held);
    EXPECT_EQ(coach.wheelsets, (std::vector<int>{3, 4, 5, 6}));
    EXPECT_GT(coach.bodies[3].position.x(), coach.bodies[4].position.x());
    EXPECT_LT((coach.stiffness - coach.stiffness.transpose()).norm(), 1e-14 * coach.stiffness.norm());
    EXPECT_LT((coach.damping - coach.damping.transpose()).norm(), 1e-14 * coach.damping.norm());
    EXPECT_GT(coach.mass.diagonal().minCoeff(), 0.0);
  }
}

TEST(Coach, StaticLoadIsTheWeightOnFourEqualAxles) {
  const VehicleModel coach = build_coach(coach_parameters("manchester-coach"));
  const double weight = (32000.0 + 2 * 2615.0 + 4 * 1813.0) * 9.81;
  EXPECT_NEAR(coach.static_load.sum(), weight, 1e-9 * weight);
  for (const int w : coach.wheelsets) {
    EXPECT_NEAR(coach.static_load[coach.dof[w][2]], weight / 4, 1e-9 * weight);
    EXPECT_NEAR(coach.static_load[coach.dof[w][3]], 0.0, 1e-9 * weight);
  }
}

// In a curve with cant wheels carry more than on level track, which Q0 refers to.
TEST(Coach, StaticWheelLoadIsThatOfLevelTrack) {
  constexpr double in_curve = 1.05 * standard_gravity;
  const CoachParameters p = coach_parameters("manchester-coach");
  const VehicleModel level = build_coach(p), leans = build_coach(p, MotionPlane::spatial, {in_curve});
  for (int w = 0; w < 4; ++w) {
    const double load = static_wheel_load(level, w);
    EXPECT_EQ(wheel_load_at_rest(level, w), load);
    EXPECT_NEAR(wheel_load_at_rest(leans, w), 1.05 * load, 1e-9 * load);
    EXPECT_NEAR(static_wheel_load(leans, w), load, 1e-9 * load);
  }
}

TEST(Coach, BounceIsThatOfTwoMassesOnTwoSprings) {
  const VehicleModel coach = build_coach(manchester());
  for (const ChainMode& mode : two_mass_chain(32000.0, 4 * 0.430e6, 2 * 2615.0, 8 * 1.220e6)) {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(41);
    u[coach.dof[0][2]] = 1.0;
    u[coach.dof[1][2]] = u[coach.dof[2][2]] = mode.ratio;
    EXPECT_LT(mode_residual(coach, u, mode.omega2), 1e-12) << std::sqrt(mode.omega2) / (2 * std::numbers::pi) << " Hz";
  }
}

TEST(Coach, PitchIsThatOfTheChainAtTheBogieDistance) {
  CoachParameters p = manchester();
  p.secondary.kx = 0;  // else the car body's pitch drags the bogies along x
  p.secondary_bending = 0;
  const VehicleModel coach = build_coach(p, MotionPlane::spatial, springs_alone);
  const double L = p.half_bogie_distance;
  for (const ChainMode& mode : two_mass_chain(1.97e6 / (L * L), 4 * 0.430e6, 2 * 2615.0, 8 * 1.220e6)) {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(41);
    u[coach.dof[0][4]] = 1.0;              // nose up: z = -x·pitch
    u[coach.dof[1][2]] = -L * mode.ratio;  // front
    u[coach.dof[2][2]] = L * mode.ratio;
    EXPECT_LT(mode_residual(coach, u, mode.omega2), 1e-12) << std::sqrt(mode.omega2) / (2 * std::numbers::pi) << " Hz";
  }
}

TEST(Coach, SwayIsThatOfTheChainWhereAllHeightsAgree) {
  CoachParameters p = manchester();
  p.car_body_height = p.secondary_height = p.bogie_height = p.nominal_radius;  // no roll in the lateral motion
  const VehicleModel coach = build_coach(p, MotionPlane::spatial, springs_alone);
  for (const ChainMode& mode : two_mass_chain(32000.0, 4 * 0.160e6, 2 * 2615.0, 8 * 3.884e6)) {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(41);
    u[coach.dof[0][1]] = 1.0;
    u[coach.dof[1][1]] = u[coach.dof[2][1]] = mode.ratio;
    EXPECT_LT(mode_residual(coach, u, mode.omega2), 1e-12) << std::sqrt(mode.omega2) / (2 * std::numbers::pi) << " Hz";
  }
}

TEST(Coach, RollBarAndBendingResistTheCarBodysRoll) {
  const VehicleModel coach = build_coach(manchester());
  CoachParameters soft = manchester();
  soft.roll_bar = soft.secondary_bending = 0;
  const VehicleModel without = build_coach(soft);
  const int roll = coach.dof[0][3];
  EXPECT_NEAR(coach.stiffness(roll, roll) - without.stiffness(roll, roll), 2 * 0.94e6 + 4 * 10.5e3, 1e-6);
  // vertical springs 1 m off the centre, lateral springs 0.9725 m below the centre of gravity
  EXPECT_NEAR(without.stiffness(roll, roll), 4 * 0.430e6 + 4 * 0.160e6 * std::pow(1.8 - 0.8275, 2), 1e-6);
}

TEST(Coach, SpringsHoldEveryMotionOnStandingWheelsets) {
  const VehicleModel coach = build_coach(manchester());
  const Eigen::VectorXd eigenvalues = symmetric_spectrum(coach.stiffness.topLeftCorner(17, 17)).values;
  EXPECT_GT(eigenvalues.minCoeff(), 1e4);
}

std::string message_of(const CoachParameters& p) {
  try {
    (void)build_coach(p);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

TEST(Coach, RejectsWrongParameters) {
  try {
    (void)coach_parameters("manchester");
    FAIL() << "an unknown vehicle was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'manchester'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("manchester-coach, manchester-coach-series, metro-gz18"),
              std::string::npos);
  }
  CoachParameters p = manchester();
  p.bogie.mass = -1;
  EXPECT_NE(message_of(p).find("vehicle.bogie.mass: found -1"), std::string::npos);
  p = manchester();
  p.primary.kz = std::nan("");
  EXPECT_NE(message_of(p).find("vehicle.primary.kz: found nan"), std::string::npos);
  p = manchester();
  p.length = 21.5;
  EXPECT_NE(message_of(p).find("vehicle.length: found 21.5"), std::string::npos);
  p = manchester();
  p.half_wheelbase = 10;
  EXPECT_NE(message_of(p).find("vehicle.half_wheelbase: found 10"), std::string::npos);
}

}  // namespace
}  // namespace railtab
