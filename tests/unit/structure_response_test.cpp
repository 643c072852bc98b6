#include "railtab/runtime/vsi/structure_response.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/tables/input_error.hpp"

namespace railtab {
namespace {

StructureModel short_bridge() {
  TrackParameters track;
  track.length_before = track.length_after = 6.0;
  BridgeParameters span;
  span.length = 6.0;
  span.elements = 10;
  return build_track_bridge(track, {span});
}

// Two routes: the table of node compliances with shape functions, and a solve for the very positions.
TEST(StructureResponse, TabulatedComplianceIsThatOfASolveAtThePositions) {
  const StructureModel structure = short_bridge();
  StructureResponse response(structure, HhtScheme{.alpha = -0.1, .time_step = 1e-3});
  response.tabulate_compliance(structure, 100.0);  // all of it: nothing is left to the far field
  std::vector<RailContact> contacts;
  for (const double x : {-3.21, 0.1, 2.345, 5.99}) {
    contacts.push_back(rail_contact(structure, RailSide::left, x));
    contacts.push_back(rail_contact(structure, RailSide::right, x));
  }
  const Eigen::MatrixXd solved = response.compliance_at(contacts);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      const Eigen::Matrix3d tabulated = response.compliance(contacts[i], contacts[j]);
      const Eigen::Matrix3d exact =
          solved.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j));
      EXPECT_LT((tabulated - exact).cwiseAbs().maxCoeff(), 1e-10 * solved.cwiseAbs().maxCoeff()) << i << " " << j;
    }
  }
}

TEST(StructureResponse, RefusesANumberThatIsNotFinite) {
  StructureModel structure = short_bridge();
  structure.stiffness.coeffRef(7, 7) = std::numeric_limits<double>::quiet_NaN();
  try {
    const StructureResponse response(structure);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "stiffness matrix of the structure, row 8, column 8: found nan, expected a finite number");
  }
}

TEST(StructureResponse, RefusesAMechanism) {
  StructureModel structure = short_bridge();
  structure.stiffness *= -1.0;
  EXPECT_THROW(StructureResponse{structure}, ComputationError);
}

}  // namespace
}  // namespace railtab
