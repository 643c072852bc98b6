#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <string>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/spring_damper.hpp"
#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {
namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Vector12d = Eigen::Matrix<double, 12, 1>;

/// Where a point with arm r goes when its body moves by u and turns by the finite rotation vector theta.
Vector3d moved(const Vector3d& r, const Vector3d& u, const Vector3d& theta) {
  return u + Eigen::AngleAxisd(theta.norm(), theta.normalized()) * r - r;
}

TEST(SpringDamper, EnergyEqualsThatOfFiniteRotationsInTheLimit) {
  const Vector3d stiffness(3e6, 5e6, 7e6);
  for (int sample = 0; sample < 20; ++sample) {
    const Vector3d arm_a = Vector3d::Random(), arm_b = Vector3d::Random();
    const Vector12d q = Vector12d::Random();
    const double quadratic = 0.5 * q.dot(spring_matrix(arm_a, arm_b, stiffness, Vector3d::Zero()) * q);

    constexpr double epsilon = 1e-6;  // second-order rotations then change the energy by about 1e-6 of itself
    const Vector3d elongation = moved(arm_b, epsilon * q.segment<3>(6), epsilon * q.segment<3>(9)) -
                                moved(arm_a, epsilon * q.segment<3>(0), epsilon * q.segment<3>(3));
    const double finite = 0.5 * elongation.dot(stiffness.cwiseProduct(elongation)) / (epsilon * epsilon);
    EXPECT_NEAR(quadratic, finite, 2e-5 * quadratic);
  }
}

TEST(SpringDamper, RotationalStiffnessResistsRelativeRotationOnly) {
  const PairMatrix K = spring_matrix({0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, Vector3d::Zero(), {2.0, 3.0, 4.0});
  Vector12d q = Vector12d::Zero();
  q.segment<3>(3) << 0.1, 0.2, 0.3;
  q.segment<3>(9) << 0.1, 0.2, 0.3;
  EXPECT_LT((K * q).norm(), 1e-15);
  q.segment<3>(9) << 1.1, 1.2, 1.3;
  const Vector12d moment = K * q;
  EXPECT_NEAR(moment[9], 2.0, 1e-14);
  EXPECT_NEAR(moment[10], 3.0, 1e-14);
  EXPECT_NEAR(moment[11], 4.0, 1e-14);
  EXPECT_NEAR(moment[3], -2.0, 1e-14);
}

/// f·(R_mᵀ(p_b − p_a)) less its part of first order, R_m turning by the shares of both rotations.
double second_order_potential(const Vector3d& arm_a, const Vector3d& arm_b, const Vector3d& force,
                              const Vector3d& share_b, const Vector12d& q) {
  const Vector3d u_a = q.segment<3>(0), theta_a = q.segment<3>(3), u_b = q.segment<3>(6), theta_b = q.segment<3>(9);
  const Vector3d mean = (Vector3d::Ones() - share_b).cwiseProduct(theta_a) + share_b.cwiseProduct(theta_b);
  const Vector3d apart = moved(arm_b, u_b, theta_b) - moved(arm_a, u_a, theta_a);
  const Vector3d linear = u_b + theta_b.cross(arm_b) - u_a - theta_a.cross(arm_a);
  return force.dot(Eigen::AngleAxisd(-mean.norm(), mean.normalized()) * apart) - force.dot(linear);
}

TEST(Preload, IsThePotentialOfAForceThatTurnsWithItsEnds) {
  for (int sample = 0; sample < 20; ++sample) {
    const Vector3d arm_a = Vector3d::Random(), arm_b = Vector3d::Random(), force = Vector3d::Random();
    const Vector3d share = 0.5 * (Vector3d::Random() + Vector3d::Ones());
    const Vector12d q = Vector12d::Random();
    const PairMatrix K = preload_matrix(arm_a, arm_b, force, share);
    EXPECT_LT((K - K.transpose()).norm(), 1e-15);
    constexpr double epsilon = 1e-4;
    const double up = second_order_potential(arm_a, arm_b, force, share, epsilon * q);
    const double down = second_order_potential(arm_a, arm_b, force, share, -epsilon * q);
    EXPECT_NEAR(0.5 * q.dot(K * q), 0.5 * (up + down) / (epsilon * epsilon), 1e-6);
  }
}

TEST(Preload, TurnsWithBothBodies) {
  const Vector3d a(0.3, -0.2, 0.5), b(-0.4, 0.1, -0.6), point(0.2, 0.7, 0.1), axis(0.3, 0.5, -0.8);
  const PairMatrix K = preload_matrix(point - a, point - b, {1.0, -2.0, 3.0}, Vector3d::Constant(0.3));
  Vector12d q;  // about the origin, where nothing is
  q << axis.cross(a), axis, axis.cross(b), axis;
  const Vector3d second_order = 0.5 * axis.cross(axis.cross(b - a));  // of u_b - u_a
  EXPECT_NEAR(0.5 * q.dot(K * q) + Vector3d(1.0, -2.0, 3.0).dot(second_order), 0.0, 1e-14);
}

/// A frame on two wheelsets, 2 m apart, each on two springs 1 m left and right of the centre; all dofs free.
VehicleModel frame(const Vector3d& frame_position, const std::vector<DofIndices>& held_dofs = {},
                   GeometricStiffness geometric = GeometricStiffness::omitted) {
  const std::vector<RigidBody> bodies{{"front", 1000, {500, 60, 500}, {1, 0, -0.5}},
                                      {"rear", 1000, {500, 60, 500}, {-1, 0, -0.5}},
                                      {"frame", 3000, {2000, 1500, 3000}, frame_position}};
  std::vector<Suspension> suspension;
  for (const int wheelset : {0, 1}) {
    for (const double y : {-1.0, 1.0}) {
      suspension.push_back({wheelset, 2, {wheelset == 0 ? 1.0 : -1.0, y, -0.5}, {2e7, 5e6, 1e6}, {1e3, 2e3, 3e3}});
    }
  }
  return assemble_vehicle({"frame", bodies, suspension, {0, 1}, held_dofs, 0.5, 10.0, 1, {10.0, geometric}});
}

// Wheelsets stand still, a force pushes the frame aside: the moment about the rails is that of the force at its height
// and of the weight that has moved.
TEST(Vehicle, LeansUnderALateralForceByItsWeight) {
  const double height = 2.0, weight = 3000 * 10.0;
  const VehicleModel vehicle = frame({0.0, 0.0, -height}, {}, GeometricStiffness::included);
  std::vector<int> rests, moves;
  for (int row = 0; row < 18; ++row) (row < 12 ? rests : moves).push_back(row);
  Vector6d load = Vector6d::Zero();
  load[1] = 1e3;
  const Eigen::MatrixXd K = vehicle.stiffness(moves, moves);
  const Vector6d u = dense_solution(K, load);
  const Eigen::VectorXd pushed = -vehicle.stiffness(rests, moves) * u;  // forces on the wheelsets
  double lateral = 0.0, moment = 0.0;
  for (const int w : {0, 6}) {
    lateral += pushed[w + 1];
    moment += pushed[w + 3] + 0.5 * pushed[w + 1];  // axles are 0.5 m above the rails
  }
  EXPECT_NEAR(lateral, load[1], 1e-9 * load[1]);
  const double expected = load[1] * height + weight * u[1];
  EXPECT_NEAR(moment, expected, 1e-9 * expected);
  EXPECT_GT(weight * u[1], 1e-3 * expected);
  const VehicleModel upright = frame({0.0, 0.0, -height});
  EXPECT_GT(u[1], dense_solution(upright.stiffness(moves, moves), load)(1));
}

TEST(Vehicle, ThatFallsOverIsRejected) {
  try {
    static_cast<void>(frame({0.0, 0.0, -400.0}, {}, GeometricStiffness::included));
    FAIL() << "a frame 400 m above its springs stands";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("falls over under its weight"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("springs that resist sideways motion, and roll and pitch"),
              std::string::npos)
        << error.what();
  }
}

TEST(Vehicle, MatricesAreSymmetricAndPositiveSemidefinite) {
  const VehicleModel vehicle = frame({0.1, 0.05, -0.8});
  ASSERT_EQ(vehicle.dofs(), 18);
  EXPECT_EQ((vehicle.mass - vehicle.mass.transpose()).norm(), 0.0);
  for (const Eigen::MatrixXd& matrix : {vehicle.stiffness, vehicle.damping}) {
    EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-14 * matrix.norm());
    const Eigen::VectorXd eigenvalues = symmetric_spectrum(matrix).values;
    EXPECT_GT(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff());
  }
}

TEST(Vehicle, FreeVehicleHasSixRigidMotionsAndFreeWheelRotation) {
  const VehicleModel vehicle = frame({0.1, 0.05, -0.8});
  for (int motion = 0; motion < 6; ++motion) {
    const Vector6d rigid = Vector6d::Unit(motion);
    const Vector3d theta = rigid.tail<3>();
    Eigen::VectorXd u(18);
    for (size_t b = 0; b < 3; ++b) {
      const Vector3d displacement = rigid.head<3>() + theta.cross(vehicle.bodies[b].position);
      for (int i = 0; i < 3; ++i) {
        u[vehicle.dof[b][i]] = displacement[i];
        u[vehicle.dof[b][3 + i]] = theta[i];
      }
    }
    EXPECT_LT((vehicle.stiffness * u).norm(), 1e-14 * vehicle.stiffness.norm() * u.norm()) << "motion " << motion;
  }
  const Eigen::VectorXd eigenvalues = symmetric_spectrum(vehicle.stiffness).values;
  const double zero = 1e-12 * eigenvalues.maxCoeff();
  EXPECT_EQ((eigenvalues.array().abs() < zero).count(), 6 + 2);  // two wheelsets turn freely about their axles
}

TEST(Vehicle, GyroscopicMatrixIsTheRateOfTheWheelsetsAngularMomentum) {
  const VehicleModel vehicle = frame({0, 0, -0.8});
  EXPECT_EQ((vehicle.gyroscopic + vehicle.gyroscopic.transpose()).norm(), 0.0);
  // second route: angular momentum of the spinning axle, turned by a finite rotation, differentiated numerically
  const double Jy = 60, Omega = 1.0 / vehicle.wheel_radius.front();       // at a running speed of 1 m/s
  const Vector3d spin = Jy * Vector3d(0, -Omega, 0);                      // forward rolling with z down
  ASSERT_LT(Vector3d(0, -Omega, 0).cross(Vector3d(0, 0, 0.5)).x(), 0.0);  // the wheel's bottom moves backwards
  constexpr double step = 1e-6;
  for (int axis : {0, 2}) {
    const Vector3d rate = Vector3d::Unit(axis);
    const Vector3d after = Eigen::AngleAxisd(step, rate) * spin, before = Eigen::AngleAxisd(-step, rate) * spin;
    const Vector3d momentum_rate = (after - before) / (2 * step);
    for (int w : {0, 1}) {
      Eigen::VectorXd velocity = Eigen::VectorXd::Zero(vehicle.dofs());
      velocity[vehicle.dof[w][3 + axis]] = 1.0;
      const Eigen::VectorXd moment = vehicle.gyroscopic * velocity;
      EXPECT_NEAR(moment[vehicle.dof[w][3]], momentum_rate.x(), 1e-6 * Jy * Omega);
      EXPECT_NEAR(moment[vehicle.dof[w][5]], momentum_rate.z(), 1e-6 * Jy * Omega);
      EXPECT_NEAR(moment.norm(), Jy * Omega, 1e-9 * Jy * Omega);
    }
  }
}

TEST(Vehicle, StaticLoadFollowsTheLeverRule) {
  // centre of gravity of the frame 0.2 m ahead of and 0.1 m right of the middle
  const VehicleModel vehicle = frame({0.2, 0.1, -0.8});
  const double g = 10.0;
  const double front = 1000 * g + 3000 * g * (1 + 0.2) / 2, rear = 1000 * g + 3000 * g * (1 - 0.2) / 2;
  EXPECT_NEAR(vehicle.static_load[vehicle.dof[0][2]], front, 1e-6);
  EXPECT_NEAR(vehicle.static_load[vehicle.dof[1][2]], rear, 1e-6);
  // right of the centre and downwards: r × F = (0.1, ...) × (..., W) about +x
  const double roll = vehicle.static_load[vehicle.dof[0][3]] + vehicle.static_load[vehicle.dof[1][3]];
  EXPECT_NEAR(roll, 3000 * g * 0.1, 1e-6);
  double elsewhere = 0;
  for (int i = 0; i < vehicle.dofs(); ++i) {
    const bool at_wheelset =
        i == vehicle.dof[0][2] || i == vehicle.dof[1][2] || i == vehicle.dof[0][3] || i == vehicle.dof[1][3];
    if (!at_wheelset) elsewhere += std::abs(vehicle.static_load[i]);
  }
  EXPECT_EQ(elsewhere, 0.0);
}

TEST(Vehicle, HeldDofsAreNoUnknowns) {
  std::vector<DofIndices> dofs(3, DofIndices{0, 0, 0, 0, 0, 0});
  dofs[2][0] = held;
  const VehicleModel vehicle = frame({0, 0, -0.8}, dofs);
  EXPECT_EQ(vehicle.dofs(), 17);
  EXPECT_EQ(vehicle.dof[2][0], held);
  EXPECT_EQ(vehicle.dof[2][1], 12);
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

TEST(Vehicle, RejectsWhatIsNoVehicle) {
  const RigidBody axle{"axle", 1000, {500, 60, 500}, {0, 0, -0.5}};
  const RigidBody box{"box", 3000, {500, 500, 500}, {0, 0, -1.0}};
  const Suspension spring{0, 1, {0, 0, -0.5}, {1e6, 1e6, 1e6}, {0, 0, 0}, {1e6, 1e6, 1e6}};
  const auto assemble = [](std::vector<RigidBody> bodies, const std::vector<Suspension>& suspension,
                           std::vector<int> wheelsets, const std::vector<DofIndices>& dofs = {}) {
    return message_of([&] { (void)assemble_vehicle({"v", bodies, suspension, wheelsets, dofs, 0.5, 10.0}); });
  };
  EXPECT_EQ(assemble({axle, box}, {spring}, {0}), "no InputError");

  RigidBody massless = box;
  massless.mass = 0;
  EXPECT_NE(assemble({axle, massless}, {spring}, {0}).find("v.box.mass: found 0"), std::string::npos);
  RigidBody flat = box;
  flat.inertia.z() = -1;
  EXPECT_NE(assemble({axle, flat}, {spring}, {0}).find("v.box.inertia: found -1"), std::string::npos);
  Suspension astray = spring;
  astray.body_b = 2;
  EXPECT_NE(assemble({axle, box}, {astray}, {0}).find("v.suspension[0]: found body 2"), std::string::npos);
  EXPECT_NE(assemble({axle, box}, {spring}, {5}).find("v.wheelsets[0]: found body 5"), std::string::npos);
  EXPECT_NE(assemble({axle, box}, {spring}, {0}, {DofIndices{}}).find("v.held_dofs: found 1 bodies"),
            std::string::npos);
  EXPECT_NE(assemble({axle, box}, {}, {0}).find("no spring carries"), std::string::npos);

  RigidBody rear = axle, overhanging = box;
  rear.name = "rear";
  rear.position.x() = -2.0;
  overhanging.position.x() = 2.0;
  Suspension front_spring = spring, rear_spring = spring;
  front_spring.body_b = rear_spring.body_b = 2;
  front_spring.rotational_stiffness.setZero();
  rear_spring.rotational_stiffness.setZero();
  rear_spring.body_a = 1;
  rear_spring.point.x() = -2.0;
  // the rear carries its own 9.81 kN less the box's 29.43 kN on a lever of one wheelbase
  EXPECT_NE(assemble({axle, rear, overhanging}, {front_spring, rear_spring}, {0, 1})
                .find("v: found rear that carries -19620 N, expected a vehicle that stands on all its wheelsets"),
            std::string::npos)
      << assemble({axle, rear, overhanging}, {front_spring, rear_spring}, {0, 1});
}

TEST(Vehicle, WeightsThatNoSpringCarriesAreThoseOfOneBody) {
  const RigidBody axle{"axle", 1000, {500, 60, 500}, {0, 0, -0.5}};
  const RigidBody box{"box", 3000, {500, 500, 500}, {0, 0, -1.0}, 0};
  RigidBody heavy = box;
  heavy.name = "heavy";
  heavy.mass = 6000;
  heavy.coach = 1;
  const auto message = [](const std::vector<RigidBody>& bodies, const std::vector<Suspension>& suspension,
                          int coaches) {
    return message_of([&] { (void)assemble_vehicle({"v", bodies, suspension, {0}, {}, 0.5, 10.0, coaches}); });
  };
  EXPECT_NE(message({axle, box, heavy}, {}, 1).find("found a weight of 5.89e+04 N of heavy that no spring carries"),
            std::string::npos)
      << message({axle, box, heavy}, {}, 1);
  EXPECT_NE(message({axle, box, heavy}, {}, 2).find("of heavy of vehicle 2 that no spring carries"), std::string::npos)
      << message({axle, box, heavy}, {}, 2);
  const Suspension ahead{0, 1, {0.5, 0, -0.5}, {1e6, 1e6, 1e6}, {0, 0, 0}};
  EXPECT_NE(message({axle, box}, {ahead}, 1).find("2.94e+04 N of box that its springs do not hold in balance"),
            std::string::npos)
      << message({axle, box}, {ahead}, 1);
}

// The box beside the middle turns the axle by 58860 N m, 39240 N of which each of the wheels 1.5 m apart takes.
TEST(Vehicle, NoWheelIsPulledDown) {
  const RigidBody axle{"axle", 1000, {500, 60, 500}, {0, 0, -0.5}};
  const Suspension spring{0, 1, {0, 0, -0.5}, {1e6, 1e6, 1e6}, {0, 0, 0}, {1e6, 1e6, 1e6}};
  const auto message = [&](double y) {
    const RigidBody box{"box", 3000, {500, 500, 500}, {0, y, -1.0}};
    return message_of([&] { (void)assemble_vehicle({"v", {axle, box}, {spring}, {0}, {}, 0.5, 10.0}); });
  };
  EXPECT_NE(message(2.0).find("v: found axle whose left wheel carries -19620 N, expected a vehicle that stands on all "
                              "its wheels"),
            std::string::npos)
      << message(2.0);
  EXPECT_NE(message(-2.0).find("axle whose right wheel carries -19620 N"), std::string::npos) << message(-2.0);
  EXPECT_EQ(message(0.9), "no InputError");  // of 1 m that load one wheel alone
}

}  // namespace
}  // namespace railtab
