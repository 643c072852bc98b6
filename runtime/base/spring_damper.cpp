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

}  // namespace railtab
