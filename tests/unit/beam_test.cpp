#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/structure/beam_element.hpp"
#include "railtab/runtime/structure/simple_beam.hpp"

namespace railtab {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Vector12d = Eigen::Matrix<double, 12, 1>;

const BeamSection section{210e9, 76.7e-4, 3038e-8, 512e-8, 195e3, 60.21, 0.279};
constexpr double L = 1.7;

/// Gauss points and weights of order 7 on 0..1.
constexpr std::array<std::array<double, 2>, 4> gauss{{{0.0694318442029737, 0.1739274225687269},
                                                      {0.3300094782075719, 0.3260725774312731},
                                                      {0.6699905217924281, 0.3260725774312731},
                                                      {0.9305681557970263, 0.1739274225687269}}};

TEST(BeamElement, MassIsTheIntegralOfTheShapes) {
  BeamMatrix expected = BeamMatrix::Zero();
  Vector6d density;
  density << section.mass, section.mass, section.mass, section.rotary_inertia, 0, 0;
  for (const auto& [t, weight] : gauss) {
    const BeamShape N = beam_shape(L, t * L);
    expected += weight * L * N.transpose() * density.asDiagonal() * N;
  }
  EXPECT_LT((beam_mass(section, L) - expected).norm(), 1e-12 * expected.norm());
}

TEST(BeamElement, StiffnessIsTheIntegralOfTheStrains) {
  // strains are the x-derivatives of x, roll, pitch and yaw; central differences of the shapes are exact enough
  constexpr double h = 1e-5;
  BeamMatrix expected = BeamMatrix::Zero();
  Vector6d rigidity;
  rigidity << section.E * section.A, 0, 0, section.GJ, section.E * section.Iy, section.E * section.Iz;
  for (const auto& [t, weight] : gauss) {
    const BeamShape B = (beam_shape(L, t * L + h) - beam_shape(L, t * L - h)) / (2 * h);
    expected += weight * L * B.transpose() * rigidity.asDiagonal() * B;
  }
  EXPECT_LT((beam_stiffness(section, L) - expected).norm(), 1e-9 * expected.norm());
}

TEST(BeamElement, RigidMotionsAreFreeOfForce) {
  const BeamMatrix K = beam_stiffness(section, L);
  EXPECT_EQ((K - K.transpose()).norm(), 0.0);
  for (int motion = 0; motion < 6; ++motion) {
    const Vector6d rigid = Vector6d::Unit(motion);
    const Eigen::Vector3d theta = rigid.tail<3>();
    Vector12d u;
    u << rigid, rigid.head<3>() + theta.cross(Eigen::Vector3d(L, 0, 0)), theta;
    EXPECT_LT((K * u).norm(), 1e-12 * K.norm()) << "motion " << motion;
  }
}

TEST(BeamElement, CantileverBendsToTheSideOfTheForce) {
  const Eigen::Matrix<double, 6, 6> tip = beam_stiffness(section, L).bottomRightCorner<6, 6>();
  const double force = 1000;
  const Vector6d down = dense_solution(tip, force * Vector6d::Unit(2));
  EXPECT_NEAR(down[2], force * std::pow(L, 3) / (3 * section.E * section.Iy), 1e-12);
  EXPECT_NEAR(down[4], -force * L * L / (2 * section.E * section.Iy), 1e-12);  // pitch = -dz/dx
  const Vector6d right = dense_solution(tip, force * Vector6d::Unit(1));
  EXPECT_NEAR(right[1], force * std::pow(L, 3) / (3 * section.E * section.Iz), 1e-12);
  EXPECT_NEAR(right[5], force * L * L / (2 * section.E * section.Iz), 1e-12);  // yaw = dy/dx
  const Vector6d twisted = dense_solution(tip, force * Vector6d::Unit(3));
  EXPECT_NEAR(twisted[3], force * L / section.GJ, 1e-12);
  const Vector6d pulled = dense_solution(tip, force * Vector6d::Unit(0));
  EXPECT_NEAR(pulled[0], force * L / (section.E * section.A), 1e-15);
}

TEST(BeamElement, RayleighDampingHasItsRatioAtBothFrequencies) {
  const RayleighDamping damping = rayleigh_damping(0.02, 30.0, 120.0);
  for (const double omega : {30.0, 120.0}) {
    EXPECT_NEAR(0.5 * (damping.mass_factor / omega + damping.stiffness_factor * omega), 0.02, 1e-15);
  }
  const double between = 60.0;
  EXPECT_LT(0.5 * (damping.mass_factor / between + damping.stiffness_factor * between), 0.02);
}

/// A rail of three unequal elements whose dofs are numbered 0..23.
RailLine uneven_rail() {
  RailLine rail;
  rail.x = {-1.0, 0.5, 0.9, 4.0};
  rail.head_height = 0.09;
  for (int node = 0; node < 4; ++node) {
    rail.dof.push_back({6 * node, 6 * node + 1, 6 * node + 2, 6 * node + 3, 6 * node + 4, 6 * node + 5});
  }
  return rail;
}

double value(const std::array<double, 12>& row, const RailInterpolation& rows, const Eigen::VectorXd& a) {
  double sum = 0;
  for (int k = 0; k < 12; ++k) {
    if (rows.dof[k] != held) sum += row[k] * a[rows.dof[k]];
  }
  return sum;
}

TEST(RailInterpolation, ReproducesCubicBendingAndLinearTwistWithTheHeadsArm) {
  const RailLine rail = uneven_rail();
  const auto y = [](double x) { return 1 - 2 * x + 0.5 * x * x - 0.3 * x * x * x; };
  const auto dy = [](double x) { return -2 + x - 0.9 * x * x; };
  const auto z = [](double x) { return 2 + x - 0.7 * x * x + 0.1 * x * x * x; };
  const auto dz = [](double x) { return 1 - 1.4 * x + 0.3 * x * x; };
  const auto roll = [](double x) { return 0.2 + 0.4 * x; };
  Eigen::VectorXd a = Eigen::VectorXd::Zero(24);
  for (size_t node = 0; node < 4; ++node) {
    const double x = rail.x[node];
    const DofIndices& dof = rail.dof[node];
    a[dof[1]] = y(x);
    a[dof[2]] = z(x);
    a[dof[3]] = roll(x);
    a[dof[4]] = -dz(x);
    a[dof[5]] = dy(x);
  }
  for (const double x : {-1.0, -0.3, 0.5, 0.7, 0.9, 2.2, 3.9, 4.0}) {
    const RailInterpolation rows = rail_interpolation(rail, x);
    EXPECT_NEAR(value(rows.y, rows, a), y(x) + 0.09 * roll(x), 1e-12) << "x = " << x;
    EXPECT_NEAR(value(rows.z, rows, a), z(x), 1e-12);
    EXPECT_NEAR(value(rows.roll, rows, a), roll(x), 1e-12);
    EXPECT_NEAR(value(rows.yaw, rows, a), dy(x) + 0.09 * 0.4, 1e-12);
    EXPECT_NEAR(value(rows.pitch, rows, a), -dz(x), 1e-12);
  }
}

// A bar that warps in each of its own shapes: constant, linear, cosh and sinh.
TEST(RailInterpolation, ReproducesTheTwistOfABarThatWarps) {
  RailLine rail = uneven_rail();
  rail.stiffness = {6e6, 1e6, 2e5, 0.4};
  rail.twist_rate = {24, 25, 26, 27};
  const auto roll = [](double x) { return 0.2 + 0.4 * x + 0.1 * std::cosh(x / 0.4) - 0.3 * std::sinh(x / 0.4); };
  const auto rate = [](double x) { return 0.4 + 0.25 * std::sinh(x / 0.4) - 0.75 * std::cosh(x / 0.4); };
  Eigen::VectorXd a = Eigen::VectorXd::Zero(28);
  for (size_t node = 0; node < 4; ++node) {
    a[rail.dof[node][3]] = roll(rail.x[node]);
    a[rail.twist_rate[node]] = rate(rail.x[node]);
  }
  for (const double x : {-1.0, -0.3, 0.5, 0.7, 0.9, 2.2, 3.9, 4.0}) {
    const RailInterpolation rows = rail_interpolation(rail, x);
    EXPECT_NEAR(value(rows.roll, rows, a), roll(x), 1e-11 * std::cosh(x / 0.4)) << "x = " << x;
    EXPECT_NEAR(value(rows.y, rows, a), 0.09 * roll(x), 1e-11 * std::cosh(x / 0.4));
    EXPECT_NEAR(value(rows.yaw, rows, a), 0.09 * rate(x), 1e-11 * std::cosh(x / 0.4));
  }
}

TEST(RailInterpolation, LateralForceAtTheHeadTwistsTheAxis) {
  const RailLine rail = uneven_rail();
  const RailInterpolation rows = rail_interpolation(rail, 0.7);
  double force = 0, moment = 0;
  for (int k = 0; k < 12; ++k) {
    if (k % 6 == 1) force += rows.y[k];
    if (k % 6 == 3) moment += rows.y[k];
  }
  EXPECT_NEAR(force, 1.0, 1e-14);
  // head at r = (0, 0, -h): r × F about x is -(-h)·F_y
  EXPECT_NEAR(moment, 0.09, 1e-14);
}

TEST(RailInterpolation, ContainsIsTheClosedRange) {
  const RailLine rail = uneven_rail();
  EXPECT_TRUE(contains(rail, -1.0));
  EXPECT_TRUE(contains(rail, 4.0));
  EXPECT_FALSE(contains(rail, 4.0 + 1e-12));
  EXPECT_FALSE(contains(rail, -1.1));
  EXPECT_FALSE(contains(rail, std::nan("")));
  EXPECT_FALSE(contains(RailLine{}, 0.0));
}

TEST(SimpleBeam, BothRailsAreTheBeam) {
  const StructureModel beam = build_simple_beam({});
  EXPECT_EQ(beam.dofs(), 2 * 21 - 2);
  EXPECT_EQ(beam.rail[0].dof, beam.rail[1].dof);
  EXPECT_EQ(beam.rail[0].head_height, 0.0);
  EXPECT_EQ(beam.rail[0].x.front(), 0.0);
  EXPECT_EQ(beam.rail[0].x.back(), 25.0);
  EXPECT_EQ(beam.damping.nonZeros(), 0);
  ASSERT_EQ(beam.nodes.size(), 1u);
  EXPECT_EQ(beam.nodes[0].x, 12.5);
  EXPECT_EQ(beam.nodes[0].name, "deck-midspan-1");
}

TEST(SimpleBeam, RejectsWrongParameters) {
  SimpleBeamParameters p;
  p.elements = 3;
  EXPECT_THROW((void)build_simple_beam(p), InputError);
  p = {};
  p.mass = 0;
  EXPECT_THROW((void)build_simple_beam(p), InputError);
}

}  // namespace
}  // namespace railtab
