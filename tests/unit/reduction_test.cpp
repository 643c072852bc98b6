#include "railtab/runtime/structure/reduction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "railtab/runtime/structure/simple_beam.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vsi/local_flexibility.hpp"

namespace railtab {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

StructureModel two_spans() {
  TrackParameters track;
  track.length_before = track.length_after = 9.0;
  BridgeParameters span;
  span.length = 12.0;
  span.elements = 12;
  return build_track_bridge(track, {span, span});
}

std::vector<RailContact> wheels_on(const StructureModel& structure) {
  std::vector<RailContact> contacts;
  for (const double x : {-2.13, 0.4, 6.05, 8.55}) {
    contacts.push_back(rail_contact(structure, RailSide::left, x));
    contacts.push_back(rail_contact(structure, RailSide::right, x));
  }
  return contacts;
}

TEST(LowestModes, OfABeamHaveItsFrequencies) {
  const SimpleBeamParameters beam;
  const StructureModel structure = build_simple_beam(beam);
  const ModalBasis modes = lowest_modes(structure.stiffness, structure.mass, 5);
  ASSERT_EQ(modes.omega2.size(), 5);
  for (int n = 1; n <= 5; ++n) {
    const double omega = std::pow(n * std::numbers::pi / beam.length, 2) * std::sqrt(beam.E * beam.I / beam.mass);
    EXPECT_NEAR(std::sqrt(modes.omega2[n - 1]) / omega, 1.0, 1e-5 * std::pow(n, 4) / 5.0) << n;
  }
}

// Two spans that do not know of each other have every frequency twice, which one vector alone would not find.
TEST(LowestModes, FindsEqualFrequenciesAndOrthonormalShapes) {
  const StructureModel one = build_simple_beam({});
  std::vector<Eigen::Triplet<double>> K, M;
  const int n = one.dofs();
  for (int copy = 0; copy < 2; ++copy) {
    for (int j = 0; j < n; ++j) {
      for (Sparse::InnerIterator e(one.stiffness, j); e; ++e)
        K.emplace_back(copy * n + static_cast<int>(e.row()), copy * n + j, e.value());
      for (Sparse::InnerIterator e(one.mass, j); e; ++e)
        M.emplace_back(copy * n + static_cast<int>(e.row()), copy * n + j, e.value());
    }
  }
  Sparse stiffness(2 * n, 2 * n), mass(2 * n, 2 * n);
  stiffness.setFromTriplets(K.begin(), K.end());
  mass.setFromTriplets(M.begin(), M.end());
  const ModalBasis modes = lowest_modes(stiffness, mass, 12);
  ASSERT_EQ(modes.omega2.size(), 12);
  for (int k = 0; k < 12; k += 2) EXPECT_NEAR(modes.omega2[k + 1] / modes.omega2[k], 1.0, 1e-9);
  const Eigen::MatrixXd identity = modes.shape.transpose() * (mass * modes.shape);
  EXPECT_LT((identity - Eigen::MatrixXd::Identity(12, 12)).cwiseAbs().maxCoeff(), 1e-10);
  const Eigen::MatrixXd residual = stiffness * modes.shape - mass * modes.shape * modes.omega2.asDiagonal();
  EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-6 * (stiffness * modes.shape).cwiseAbs().maxCoeff());
}

TEST(LowestModes, AllModesOfASmallStructureAreItself) {
  const StructureModel structure = build_simple_beam({.elements = 4});
  const StructureModel modal = reduce_to_modes(structure, 1000);
  EXPECT_EQ(modal.dofs(), structure.dofs());
  const StructureResponse whole(structure), reduced(modal);
  const RailContact at = rail_contact(structure, RailSide::left, 11.3),
                    modal_at = rail_contact(modal, RailSide::left, 11.3);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(structure.dofs()), modal_load = load;
  add_rail_load(at, {0.0, 1.0, 0.0}, load);
  add_rail_load(modal_at, {0.0, 1.0, 0.0}, modal_load);
  const double expected = rail_head(at, whole.solve(load))[1];
  EXPECT_NEAR(rail_head(modal_at, reduced.solve(modal_load))[1] / expected, 1.0, 1e-8);
}

// Whatever modes are kept: with the static correction the flexibility between wheels is that of the whole structure.
TEST(StaticCorrection, MakesTheFlexibilityWhole) {
  const StructureModel structure = two_spans();
  StructureResponse rest(structure);
  const Eigen::MatrixXd exact = rest.compliance_at(wheels_on(structure));
  for (int modes : {3, 30}) {
    const StructureModel modal = reduce_to_modes(structure, modes);
    StructureResponse response(modal);
    const std::vector<RailContact> contacts = wheels_on(modal);
    LocalFlexibility local(structure, modal);
    local.follow(-3.0, 9.0);
    const Eigen::MatrixXd kept = response.compliance_at(contacts);
    double without = 0.0;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      for (std::size_t j = 0; j < contacts.size(); ++j) {
        const auto r = static_cast<Eigen::Index>(3 * i), c = static_cast<Eigen::Index>(3 * j);
        const Eigen::Matrix3d sum = kept.block<3, 3>(r, c) + local(contacts[i], contacts[j]);
        EXPECT_LT((sum - exact.block<3, 3>(r, c)).cwiseAbs().maxCoeff(), 1e-6 * exact.cwiseAbs().maxCoeff());
        without = std::max(without, (kept.block<3, 3>(r, c) - exact.block<3, 3>(r, c)).cwiseAbs().maxCoeff());
      }
    }
    EXPECT_GT(without, 0.1 * exact.cwiseAbs().maxCoeff()) << "the test would not notice a missing correction";
  }
}

// Largest relative error of the ten lowest squared frequencies.
double frequency_error(const StructureModel& structure, int modes) {
  const StructureModel reduced = reduce_parts(structure, modes);
  const ModalBasis a = lowest_modes(structure.stiffness, structure.mass, 10);
  const ModalBasis b = lowest_modes(reduced.stiffness, reduced.mass, 10);
  double largest = 0.0;
  for (int k = 0; k < 10; ++k) {
    EXPECT_GE(b.omega2[k], a.omega2[k] * (1.0 - 1e-7)) << "a reduced structure is never softer";
    largest = std::max(largest, b.omega2[k] / a.omega2[k] - 1.0);
  }
  return largest;
}

TEST(CraigBampton, FrequenciesConvergeFromAbove) {
  const StructureModel structure = two_spans();
  const double few = frequency_error(structure, 20), many = frequency_error(structure, 80);
  std::printf("error of ω² with 20 modes per part: %.2e, with 80: %.2e\n", few, many);
  EXPECT_LT(few, 0.15);
  EXPECT_LT(many, 0.1 * few);
}

TEST(CraigBampton, IsExactAtRest) {
  const StructureModel structure = two_spans();
  const StructureModel reduced = reduce_parts(structure, 20);
  EXPECT_LT(reduced.dofs(), structure.dofs());
  StructureResponse whole(structure), parts(reduced);
  const Eigen::MatrixXd exact = whole.compliance_at(wheels_on(structure));
  const Eigen::MatrixXd found = parts.compliance_at(wheels_on(reduced));
  EXPECT_LT((found - exact).cwiseAbs().maxCoeff(), 1e-8 * exact.cwiseAbs().maxCoeff());
  // The midspan's motion is recovered: deflection under a unit load on the rail there.
  const RailContact at = rail_contact(structure, RailSide::left, 6.0),
                    reduced_at = rail_contact(reduced, RailSide::left, 6.0);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(structure.dofs()), reduced_load = Eigen::VectorXd::Zero(reduced.dofs());
  add_rail_load(at, {0.0, 1.0, 0.0}, load);
  add_rail_load(reduced_at, {0.0, 1.0, 0.0}, reduced_load);
  const double expected = whole.solve(load)[structure.nodes[0].dof[2]];
  EXPECT_NEAR((reduced.node_rows * parts.solve(reduced_load))[2] / expected, 1.0, 1e-8);
}

// A factor of a range holds everything else.
TEST(StructureFactor, OfARangeHoldsTheRest) {
  const StructureModel structure = two_spans();
  const DofRange range{200, 400};
  const StructureFactor factor(structure.stiffness, range);
  const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(structure.dofs(), 1.0, 2.0);
  const Eigen::VectorXd x = factor.solve(load);
  EXPECT_EQ(x.head(200).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(x.tail(structure.dofs() - 600).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_LT((structure.stiffness * x - load).segment(200, 400).cwiseAbs().maxCoeff(), 1e-8);
}

}  // namespace
}  // namespace railtab
