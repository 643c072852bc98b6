#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/structure/torsion_element.hpp"

namespace railtab {
namespace {

/// From bars that hardly warp to bars that hardly twist otherwise: L/λ = 100, 4 and 0.1.
const TorsionElement elements[] = {{2e5, 0.006, 0.6}, {2e5, 0.15, 0.6}, {2e5, 6.0, 0.6}};

TEST(TorsionElement, ShapesAreOneAtTheirOwnEnd) {
  for (const TorsionElement& element : elements) {
    const TorsionShape first = torsion_shape(element, 0.0), last = torsion_shape(element, element.length);
    EXPECT_LT((first.twist - Eigen::Vector4d::Unit(0)).norm(), 1e-10) << element.warping_length;
    EXPECT_LT((first.rate - Eigen::Vector4d::Unit(1)).norm(), 1e-9);
    EXPECT_LT((last.twist - Eigen::Vector4d::Unit(2)).norm(), 1e-10);
    EXPECT_LT((last.rate - Eigen::Vector4d::Unit(3)).norm(), 1e-9);
  }
}

TEST(TorsionElement, RatesAreTheSlopesOfTwists) {
  constexpr double h = 1e-5;
  for (const TorsionElement& element : elements) {
    for (const double s : {0.002, 0.1, 0.3, 0.55}) {
      const Eigen::Vector4d slope =
          (torsion_shape(element, s + h).twist - torsion_shape(element, s - h).twist) / (2.0 * h);
      EXPECT_LT((torsion_shape(element, s).rate - slope).norm(), 1e-5) << element.warping_length << ", " << s;
    }
  }
}

// Little warping leaves linear shapes, much warping the cubic ones of a beam in bending.
TEST(TorsionElement, ShapesHaveTheirLimits) {
  const double t = 0.3, L = 0.6, s = t * L;
  const TorsionShape stiff = torsion_shape({2e5, 100.0 * L, L}, s), soft = torsion_shape({2e5, 1e-3 * L, L}, s);
  const Eigen::Vector4d cubic(1 - t * t * (3 - 2 * t), s * (1 - t) * (1 - t), t * t * (3 - 2 * t), -s * t * (1 - t));
  EXPECT_LT((stiff.twist - cubic).norm(), 1e-4);
  EXPECT_LT((soft.twist - Eigen::Vector4d(1 - t, 0.0, t, 0.0)).norm(), 2e-3);
}

// GJ ∫ (N' N'ᵀ + λ² N'' N''ᵀ), with Simpson's rule on intervals that resolve λ.
TEST(TorsionElement, StiffnessIsTheIntegralOfTheStrains) {
  for (const TorsionElement& element : elements) {
    constexpr int intervals = 4000;
    const double step = element.length / intervals, h = 1e-3 * step;
    Eigen::Matrix4d expected = Eigen::Matrix4d::Zero();
    for (int i = 0; i <= intervals; ++i) {
      const double s = std::clamp(i * step, h, element.length - h);
      const double weight = step / 3.0 * (i == 0 || i == intervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0);
      const Eigen::Vector4d rate = torsion_shape(element, s).rate;
      const Eigen::Vector4d bend =
          (torsion_shape(element, s + h).rate - torsion_shape(element, s - h).rate) / (2.0 * h);
      expected += weight * element.GJ *
                  (rate * rate.transpose() + element.warping_length * element.warping_length * bend * bend.transpose());
    }
    const Eigen::Matrix4d K = torsion_stiffness(element);
    EXPECT_LT((K - expected).norm(), 1e-4 * K.norm()) << element.warping_length;
    EXPECT_LT((K * Eigen::Vector4d(1.0, 0.0, 1.0, 0.0)).norm(), 1e-9 * K.norm());
    EXPECT_EQ((K - K.transpose()).norm(), 0.0);
  }
}

TEST(TorsionElement, MassOfARigidTwistIsTheRotaryInertia) {
  for (const TorsionElement& element : elements) {
    const Eigen::Vector4d rigid(1.0, 0.0, 1.0, 0.0);
    const Eigen::Matrix4d M = torsion_mass(element, 0.28);
    EXPECT_NEAR(rigid.dot(M * rigid), 0.28 * element.length, 1e-12);
    EXPECT_LT((M - M.transpose()).norm(), 1e-15);
  }
  // cubic shapes: those of a beam in bending
  const Eigen::Matrix4d cubic = torsion_mass({2e5, 600.0, 0.6}, 1.0);
  EXPECT_NEAR(cubic(0, 0), 156.0 * 0.6 / 420.0, 1e-7);
  EXPECT_NEAR(cubic(1, 2), 13.0 * 0.6 * 0.6 / 420.0, 1e-7);
}

/// Twist at the node between two elements, of the whole that is held at both ends, under a unit moment there; and the
/// twist at `x` of the second.
Eigen::Vector2d twist_of_two(double GJ, double lambda, double first, double second, double x) {
  const TorsionElement before{GJ, lambda, first}, after{GJ, lambda, second};
  const Eigen::Matrix2d K =
      torsion_stiffness(before).bottomRightCorner<2, 2>() + torsion_stiffness(after).topLeftCorner<2, 2>();
  const Eigen::Vector2d node = dense_solution(K, Eigen::Vector2d(1.0, 0.0));
  return {node[0], torsion_shape(after, x).twist.head<2>().dot(node)};
}

// The exact solution of one element, loaded between its nodes, is that of two with a node under the load.
TEST(TorsionElement, ComplianceIsThatWithANodeUnderTheLoad) {
  for (const TorsionElement& element : elements) {
    for (const double loaded : {0.01, 0.2, 0.3, 0.5}) {
      const double beyond = 0.5 * (element.length - loaded);
      const Eigen::Vector2d twist =
          twist_of_two(element.GJ, element.warping_length, loaded, element.length - loaded, beyond);
      const double own = torsion_compliance(element, loaded, loaded);
      const TorsionPlace place = torsion_place(element, loaded);
      EXPECT_EQ(place.compliance, own);
      EXPECT_EQ(place.shape.twist, torsion_shape(element, loaded).twist);
      EXPECT_EQ(place.shape.rate, torsion_shape(element, loaded).rate);
      EXPECT_NEAR(own, twist[0], 1e-7 * twist[0]) << element.warping_length << ", " << loaded;
      EXPECT_NEAR(torsion_compliance(element, loaded + beyond, loaded), twist[1], 1e-7 * twist[0]);
      EXPECT_NEAR(torsion_compliance(element, loaded, loaded + beyond), twist[1], 1e-7 * twist[0]);
    }
  }
}

TEST(TorsionElement, ComplianceHasItsSlope) {
  constexpr double h = 1e-5;
  for (const TorsionElement& element : elements) {
    for (const double x : {0.01, 0.2, 0.3, 0.5}) {
      const double difference =
          (torsion_compliance(element, x + h, x + h) - torsion_compliance(element, x - h, x - h)) / (2.0 * h);
      const double scale = torsion_compliance(element, 0.3, 0.3) / element.length;
      EXPECT_NEAR(torsion_place(element, x).slope, difference, 1e-5 * scale) << element.warping_length << ", " << x;
    }
  }
}

}  // namespace
}  // namespace railtab
