#include "railtab/runtime/base/spring_damper.hpp"

namespace railtab {
namespace {

/// [r]× with [r]× v = r × v.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& r) {
  Eigen::Matrix3d m;
  m << 0, -r.z(), r.y(),  //
      r.z(), 0, -r.x(),   //
      -r.y(), r.x(), 0;
  return m;
}

}  // namespace

SpringKinematics spring_kinematics(const Eigen::Vector3d& arm_a, const Eigen::Vector3d& arm_b) {
  SpringKinematics B = SpringKinematics::Zero();
  // θ × r = -[r]× θ
  B.block<3, 3>(0, 0) = -Eigen::Matrix3d::Identity();
  B.block<3, 3>(0, 3) = cross_matrix(arm_a);
  B.block<3, 3>(0, 6) = Eigen::Matrix3d::Identity();
  B.block<3, 3>(0, 9) = -cross_matrix(arm_b);
  B.block<3, 3>(3, 3) = -Eigen::Matrix3d::Identity();
  B.block<3, 3>(3, 9) = Eigen::Matrix3d::Identity();
  return B;
}

PairMatrix spring_matrix(const Eigen::Vector3d& arm_a, const Eigen::Vector3d& arm_b, const Eigen::Vector3d& along,
                         const Eigen::Vector3d& about) {
  const SpringKinematics B = spring_kinematics(arm_a, arm_b);
  Eigen::Matrix<double, 6, 1> k;
  k << along, about;
  const SpringKinematics kB = k.asDiagonal() * B;
  return B.transpose() * kB;
}

PairMatrix preload_matrix(const Eigen::Vector3d& arm_a, const Eigen::Vector3d& arm_b, const Eigen::Vector3d& force,
                          const Eigen::Vector3d& share_b) {
  using Rows = Eigen::Matrix<double, 3, 12>;
  const Rows e = spring_kinematics(arm_a, arm_b).topRows<3>();
  Rows mean_rotation = Rows::Zero();
  mean_rotation.block<3, 3>(0, 3) = (Eigen::Vector3d::Ones() - share_b).asDiagonal();
  mean_rotation.block<3, 3>(0, 9) = share_b.asDiagonal();
  const Rows torque = cross_matrix(force) * mean_rotation;  // −θ_m·(e × f) = −e·(f × θ_m)
  PairMatrix K = -(e.transpose() * torque) - torque.transpose() * e;
  // ½ f·(θ × (θ × r)) = ½ ((θ·r)(θ·f) − (f·r) θ²)
  const auto raised = [&](const Eigen::Vector3d& r) -> Eigen::Matrix3d {
    return 0.5 * (r * force.transpose() + force * r.transpose()) - force.dot(r) * Eigen::Matrix3d::Identity();
  };
  K.block<3, 3>(9, 9) += raised(arm_b);
  K.block<3, 3>(3, 3) -= raised(arm_a);
  return K;
}

}  // namespace railtab
