#include "railtab/runtime/vsi/element_deflection.hpp"

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

void element_motion(const std::vector<RailContact>& contacts, const Eigen::VectorXd& force, const Eigen::VectorXd& rate,
                    const Eigen::VectorXd& slope_force, double speed, std::vector<RailHeadMotion>& motion) {
  motion.assign(contacts.size(), {});
  const int wheels = static_cast<int>(contacts.size());
  const auto add = [&](int i, const Eigen::Matrix3d& C, int j) {
    motion[index(i)].displacement += C * force.segment<3>(3 * j);
    motion[index(i)].velocity += C * rate.segment<3>(3 * j);
  };
  for (int i = 0; i < wheels; ++i) {
    const RailContact& at = contacts[index(i)];
    if (!at.on_rail || at.rail->twist_rate.empty()) continue;
    RailHeadMotion& m = motion[index(i)];
    const Vector3 slope = 0.5 * at.own.slope * slope_force.segment<3>(3 * i);
    add(i, at.own.compliance, i);
    m.velocity += speed * slope;
    m.yaw = slope[0];
    m.slope = slope[1];
    // Wheels of one rail are two apart, in the order of the train.
    for (int j = i + 2; j < wheels && contacts[index(j)].on_rail && contacts[index(j)].element == at.element; j += 2) {
      const Eigen::Matrix3d other = element_compliance(at, contacts[index(j)]);
      add(i, other, j);
      add(j, other, i);
    }
  }
}

void add_rail_part(double weight, const Eigen::VectorXd& of_wheelsets, Eigen::VectorXd& sum) {
  for (int wheel = 0; wheel < static_cast<int>(sum.size()) / 3; ++wheel) {
    sum.segment<3>(3 * wheel) += weight * of_wheelsets.segment<3>(rail_unknown(wheel));
  }
}

Eigen::VectorXd rail_part(const Eigen::VectorXd& of_wheelsets) {
  Eigen::VectorXd part = Eigen::VectorXd::Zero(of_wheelsets.size() / wheelset_unknowns * 6);
  add_rail_part(1.0, of_wheelsets, part);
  return part;
}

}  // namespace railtab
