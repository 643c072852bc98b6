#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "railtab/runtime/drawing/grid.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab::drawing {

/// Displacement, velocity and acceleration, each of x, y, z, roll, pitch, yaw [m, rad and per s, s²].
struct Motion {
  std::array<Eigen::Matrix<double, 6, 1>, 3> of{
      Eigen::Matrix<double, 6, 1>::Zero(), Eigen::Matrix<double, 6, 1>::Zero(), Eigen::Matrix<double, 6, 1>::Zero()};
  Motion() = default;
  explicit Motion(const MotionRecord& record);
  Motion& operator+=(const Motion& other);
  [[nodiscard]] Motion times(double weight) const;
  /// Of a point of the same rigid body, `arm` away [m]; rotations are small: u + θ × arm.
  [[nodiscard]] Motion at(const Eigen::Vector3d& arm) const;
  /// Without the rotation about y: a wheelset's turns with its wheels.
  [[nodiscard]] Motion without_pitch() const;
};

/// Points with their motions, gathered into a grid. In railtab's axes.
class DrawnPoints {
 public:
  explicit DrawnPoints(Grid& grid) : grid_(grid) {}
  /// @param rest where the point would be without its displacement [m]
  /// @param recorded whether the motion is that of the results, not of a drawing
  /// @return its number
  std::int64_t add(const Eigen::Vector3d& rest, const Motion& motion, bool recorded);
  /// Eight corners of a box about a point of a rigid body, and the box. @param low, high from that point [m]
  void add_box(const Eigen::Vector3d& point, const Motion& motion, const Eigen::Vector3d& low,
               const Eigen::Vector3d& high);
  /// Displacement, velocity, acceleration, rotation and `recorded`, which the grid has from then on.
  void write();

 private:
  Grid& grid_;
  std::array<std::vector<float>, 4> values_;
  std::vector<std::uint8_t> recorded_;
};

}  // namespace railtab::drawing
