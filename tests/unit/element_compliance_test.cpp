#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vsi/element_deflection.hpp"
#include "railtab/runtime/vsi/structure_response.hpp"

namespace railtab {
namespace {

StructureModel short_track(int elements_per_bay) {
  TrackParameters track;
  track.length_before = track.length_after = 9.0;
  track.elements_per_bay = elements_per_bay;
  return build_track_bridge(track, {});
}

/// Static compliance of the left rail's head along y, z and about x, 3 rows and columns per place, with the deflection
/// of its elements.
Eigen::MatrixXd head_compliance(const StructureModel& structure, const std::vector<double>& places) {
  StructureResponse response(structure);
  std::vector<RailContact> contacts;
  for (const double x : places) contacts.push_back(rail_contact(structure, RailSide::left, x));
  Eigen::MatrixXd result = response.compliance_at(contacts);
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < places.size(); ++j) {
      result.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) +=
          element_compliance(contacts[i], contacts[j]);
    }
  }
  return result;
}

// Where loads stand on nodes, a mesh of elements is exact at rest. One element per bay is so anywhere with the
// deflection of the element itself, and misses per cents without.
TEST(ElementCompliance, OneElementPerBayIsAsExactAtRestAsTwenty) {
  const StructureModel coarse = short_track(1), fine = short_track(20);
  double without = 0.0;
  for (int k = 0; k <= 20; k += 2) {
    // The second wheel stands on the same element, the third on the next but one.
    const double x = 0.03 * k;
    const std::vector<double> places{x, 0.03 * ((3 * k) % 20), x + 1.2};
    const Eigen::MatrixXd expected = head_compliance(fine, places), found = head_compliance(coarse, places);
    for (Eigen::Index i = 0; i < 9; ++i) {
      for (Eigen::Index j = 0; j < 9; ++j) {
        const double scale = std::sqrt(expected(i, i) * expected(j, j));
        EXPECT_NEAR(found(i, j), expected(i, j), 1e-7 * scale) << "x = " << x << ": " << i << ", " << j;
      }
    }
    const RailContact contact = rail_contact(coarse, RailSide::left, x);
    const Eigen::Matrix3d of_element = element_compliance(contact, contact);
    without = std::max(without, of_element(0, 0) / expected(0, 0));
  }
  EXPECT_GT(without, 0.02);
}

TEST(ElementCompliance, TwoElementsPerBayAreExactToo) {
  const StructureModel coarse = short_track(2), fine = short_track(20);
  for (const double x : {0.06, 0.15, 0.3, 0.45}) {
    const Eigen::MatrixXd expected = head_compliance(fine, {x}), found = head_compliance(coarse, {x});
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-7 * expected.cwiseAbs().maxCoeff()) << "x = " << x;
  }
}

// The velocity of the rail under a wheel goes with it: a jump at nodes would be one of the creepage.
TEST(ElementCompliance, HasNoSlopeAtNodes) {
  const StructureModel structure = short_track(1);
  const RailLine& rail = structure.rail[0];
  const double largest = rail_place(rail, 0.1).own.slope.cwiseAbs().maxCoeff();
  for (const double x : {0.6 - 1e-9, 0.6, 0.6 + 1e-9}) {
    EXPECT_LT(rail_place(rail, x).own.slope.cwiseAbs().maxCoeff(), 1e-6 * largest);
  }
}

TEST(ElementCompliance, APlaceHasTheInterpolationThere) {
  const StructureModel structure = short_track(1);
  RailLine rail = structure.rail[0];
  for (const bool smooth : {true, false}) {
    if (!smooth) rail.twist_rate.clear();
    for (const double x : {0.0, 0.2, 0.6, 0.75}) {
      const RailPlace place = rail_place(rail, x);
      const RailInterpolation rows = rail_interpolation(rail, x);
      EXPECT_LE(rail.x[place.element], x);
      EXPECT_LE(x, rail.x[place.element + 1]);
      EXPECT_EQ(place.rows.dof, rows.dof);
      EXPECT_EQ(place.rows.y, rows.y);
      EXPECT_EQ(place.rows.roll, rows.roll);
      EXPECT_EQ(place.rows.yaw, rows.yaw);
      const Eigen::Matrix3d own = element_compliance(rail, x, x);  // by another formula
      EXPECT_LE((place.own.compliance - own).cwiseAbs().maxCoeff(), 1e-12 * own.cwiseAbs().maxCoeff()) << x;
    }
  }
}

TEST(ElementCompliance, HasItsSlope) {
  const StructureModel structure = short_track(1);
  const RailLine& rail = structure.rail[1];
  for (const double x : {0.05, 0.2, 0.3, 0.5}) {
    constexpr double h = 1e-5;
    const Eigen::Matrix3d difference =
        (element_compliance(rail, x + h, x + h) - element_compliance(rail, x - h, x - h)) / (2.0 * h);
    const Eigen::Matrix3d slope = rail_place(rail, x).own.slope;
    EXPECT_LT((slope - difference).cwiseAbs().maxCoeff(), 1e-9 * element_compliance(rail, 0.3, 0.3).maxCoeff() / h);
    // half of it is the slope of the line under a load that stands
    const Eigen::Matrix3d line = (element_compliance(rail, x + h, x) - element_compliance(rail, x - h, x)) / (2.0 * h);
    EXPECT_LT((0.5 * slope - line).cwiseAbs().maxCoeff(), 1e-2 * slope.cwiseAbs().maxCoeff() + 1e-9);
  }
}

TEST(ElementCompliance, IsZeroAtNodesAndOffTheElement) {
  const StructureModel structure = short_track(1);
  const RailLine& rail = structure.rail[0];
  EXPECT_TRUE(element_compliance(rail, 0.6, 0.6).isZero(1e-20));
  EXPECT_TRUE(element_compliance(rail, 0.7, 0.5).isZero(0.0));
  RailLine unknown = rail;
  unknown.stiffness = {};
  unknown.twist_rate.clear();
  EXPECT_TRUE(element_compliance(unknown, 0.3, 0.3).isZero(0.0));
}

/// Largest error of g, and of dg/dt by its amplitude, under f = sin ωt over some time constants.
std::array<double, 2> error_of_steps(double time_step, double alpha) {
  constexpr double omega = 2000.0, duration = 2e-3, tau = ElementStep::time_constant;
  const ElementStep step(HhtScheme{.alpha = alpha, .time_step = time_step});
  const double square = 1.0 + tau * tau * omega * omega;
  const auto g = [&](double t) { return (std::sin(omega * t) - tau * omega * std::cos(omega * t)) / square; };
  const auto rate = [&](double t) {
    return omega * (std::cos(omega * t) + tau * omega * std::sin(omega * t)) / square;
  };
  ElementDeflection d{Eigen::VectorXd::Constant(3, g(0.0)), Eigen::VectorXd::Constant(3, rate(0.0)),
                      Eigen::VectorXd::Zero(3)};
  std::array<double, 2> largest{};
  for (int i = 1; i <= std::lround(duration / time_step); ++i) {
    const double t = i * time_step;
    Eigen::VectorXd end = step.free(d) + step.share * Eigen::VectorXd::Constant(3, std::sin(omega * t));
    step.close(end, d);
    largest[0] = std::max(largest[0], std::abs(d.force[1] - g(t)));
    largest[1] = std::max(largest[1], std::abs(d.rate[1] - rate(t)) / omega);
  }
  return largest;
}

TEST(ElementDeflection, FollowsForcesWithSecondOrder) {
  const auto coarse = error_of_steps(2e-5, 0.0), fine = error_of_steps(1e-5, 0.0);
  for (int k = 0; k < 2; ++k) {
    EXPECT_LT(fine[index(k)], 1e-4);
    EXPECT_NEAR(coarse[index(k)] / fine[index(k)], 4.0, 0.4) << k;
  }
  EXPECT_LT(error_of_steps(1e-5, -0.3)[0], 1e-2);
}

// A force that jumps moves the head by what it does at rest, at a velocity that no short step raises.
TEST(ElementDeflection, OfAForceThatJumpsIsAsAtRestAndOfBoundedVelocity) {
  for (const double time_step : {1e-3, 1e-4, 1e-5, 1e-6}) {
    const ElementStep step(HhtScheme{.alpha = -0.05, .time_step = time_step});
    ElementDeflection d{Eigen::VectorXd::Zero(3), Eigen::VectorXd::Zero(3), Eigen::VectorXd::Zero(3)};
    double fastest = 0.0;
    for (int i = 0; i < 3000; ++i) {
      Eigen::VectorXd end = step.free(d) + Eigen::VectorXd::Constant(3, step.share);
      step.close(end, d);
      fastest = std::max(fastest, d.rate.cwiseAbs().maxCoeff());
    }
    EXPECT_NEAR(d.force[0], 1.0, 1e-9) << time_step;
    EXPECT_LT(fastest, 1.0 / ElementStep::time_constant) << time_step;
  }
}

}  // namespace
}  // namespace railtab
