#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace railtab {

/// The model's units and axes against railtab's.
struct FeFrame {
  std::string units = "m-N-kg";  ///< one of fe_unit_systems(); all with seconds
  std::string axes = "x -y -z";  ///< the model's directions forward, right and down; right-handed
  /// The model's point that is at x = 0, in the track's centre, at the height of the rail-head tops [model's length].
  std::optional<std::array<double, 3>> origin{{0.0, 0.0, 0.0}};
  bool operator==(const FeFrame&) const = default;
};
/// "m-N-kg", "mm-N-t", "m-kN-t": units of length, force and mass that belong together with the second.
[[nodiscard]] std::vector<std::string> fe_unit_systems();

/// A model's units and axes against railtab's: q_railtab = S·q_model, S = ±(unit of length) for a translation and ±1
/// for a rotation.
class FrameConversion {
 public:
  /// @param section key of the scene that the frame belongs to, for messages
  /// @throws InputError naming section.units or section.axes
  FrameConversion(const FeFrame& frame, const std::string& section);

  /// Of a point of the model, in railtab's axes [m].
  [[nodiscard]] Eigen::Vector3d position(const Eigen::Vector3d& of_model) const;

  struct Row {
    int motion;       ///< 0..5 for railtab's x, y, z, roll, pitch, yaw
    double to_model;  ///< q_model per q_railtab, and half of the factor that turns the model's unit of energy into J
  };
  /// Of a row that is the motion 0..5 along or about the model's x, y, z: A becomes to_model·A·to_model.
  [[nodiscard]] Row row(int motion_of_model) const;
  /// The same factor for a degree of freedom that keeps its own unit.
  [[nodiscard]] double inner_to_model() const;

 private:
  double length_ = 1.0, force_ = 1.0;  // the model's units in m and N
  Eigen::Matrix3d P_;                  // rows: railtab's x, y, z in the model's axes
  Eigen::Vector3d origin_;
};

}  // namespace railtab
