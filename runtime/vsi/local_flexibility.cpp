#include "railtab/runtime/vsi/local_flexibility.hpp"

#include <cmath>

namespace railtab {

namespace {
constexpr double window = 12.0;  // m: rails on pads and ballast have come to rest there
}

LocalFlexibility::LocalFlexibility(const StructureModel& unreduced, const StructureModel& reduced)
    : unreduced_(unreduced),
      rest_(unreduced),
      modal_flexibility_(Eigen::VectorXd(reduced.stiffness.diagonal()).cwiseInverse()) {}

void LocalFlexibility::follow(double from, double to) { rest_.tabulate_compliance(unreduced_, window, from, to); }

Eigen::Matrix3d LocalFlexibility::operator()(const RailContact& i, const RailContact& j) const noexcept {
  if (!i.on_rail || !j.on_rail || std::abs(i.x - j.x) > window) return Eigen::Matrix3d::Zero();
  return rest_.compliance(i, j) -
         i.modal.topRows<3>() * modal_flexibility_.asDiagonal() * j.modal.topRows<3>().transpose();
}

}  // namespace railtab
