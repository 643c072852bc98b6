#include "railtab/runtime/drawing/drawn_points.hpp"

#include <Eigen/Geometry>

#include "railtab/runtime/base/motion_names.hpp"

namespace railtab::drawing {
namespace {

void append(std::vector<float>& values, const Eigen::Vector3d& vector) {
  const Eigen::Vector3f as_float = vector.cast<float>();
  values.insert(values.end(), as_float.begin(), as_float.end());
}

}  // namespace

Motion::Motion(const MotionRecord& record) {
  using Six = Eigen::Matrix<double, 6, 1>;
  of = {Six::Map(record.displacement), Six::Map(record.velocity), Six::Map(record.acceleration)};
}

Motion& Motion::operator+=(const Motion& other) {
  for (std::size_t k = 0; k < of.size(); ++k) of[k] += other.of[k];
  return *this;
}

Motion Motion::times(double weight) const {
  Motion result = *this;
  for (auto& six : result.of) six *= weight;
  return result;
}

Motion Motion::at(const Eigen::Vector3d& arm) const {
  Motion result = *this;
  for (auto& six : result.of) six.head<3>() += six.tail<3>().cross(arm);
  return result;
}

Motion Motion::without_pitch() const {
  Motion result = *this;
  for (auto& six : result.of) six[pitch_dof] = 0.0;
  return result;
}

std::int64_t DrawnPoints::add(const Eigen::Vector3d& rest, const Motion& motion, bool recorded) {
  append(grid_.points, rest);
  for (std::size_t k = 0; k < motion.of.size(); ++k) append(values_[k], motion.of[k].head<3>());
  append(values_[3], motion.of[0].tail<3>());
  recorded_.push_back(recorded ? 1 : 0);
  return grid_.point_count() - 1;
}

void DrawnPoints::add_box(const Eigen::Vector3d& point, const Motion& motion, const Eigen::Vector3d& low,
                          const Eigen::Vector3d& high) {
  std::array<std::int64_t, 8> corners{};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const bool far_x = i == 1 || i == 2 || i == 5 || i == 6, far_y = i % 4 >= 2, far_z = i >= 4;  // VTK's order
    const Eigen::Vector3d arm(far_x ? high[0] : low[0], far_y ? high[1] : low[1], far_z ? high[2] : low[2]);
    corners[i] = add(point + arm, motion.at(arm), false);
  }
  grid_.add_cell(Cell::hexahedron, corners);
}

void DrawnPoints::write() {
  constexpr std::array<const char*, 4> names{"displacement", "velocity", "acceleration", "rotation"};
  for (std::size_t k = 0; k < names.size(); ++k) grid_.point_data.push_back({names[k], 3, std::move(values_[k])});
  grid_.point_data.push_back({"recorded", 1, std::move(recorded_)});
}

}  // namespace railtab::drawing
