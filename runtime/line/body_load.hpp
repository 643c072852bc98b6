#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace railtab {

/// Force and moment: Fx, Fy, Fz [N], Mx, My, Mz [N m] about the axes x forward, y right, z down.
using ForceAndMoment = Eigen::Matrix<double, 6, 1>;

/// What a load history counts along: time [s], or the position of the loaded body along the track [m] (a stretch
/// without wind screens, a gust that stands).
enum class LoadArgument { time, position };

/// Force and moment over time or position: straight lines between the points given, the first and the last value beyond
/// them.
class LoadHistory {
 public:
  /// @param points strictly increasing [s] or [m], at least 1; as many loads
  /// @throws InputError naming the point
  LoadHistory(LoadArgument argument, std::vector<double> points, std::vector<ForceAndMoment> loads);

  [[nodiscard]] LoadArgument argument() const noexcept { return argument_; }
  [[nodiscard]] ForceAndMoment at(double point) const noexcept;
  [[nodiscard]] double begin() const noexcept { return points_.front(); }  ///< first and last point
  [[nodiscard]] double end() const noexcept { return points_.back(); }
  /// Components that are not zero throughout.
  [[nodiscard]] Eigen::Array<bool, 6, 1> acting() const noexcept;

  /// A rise and a fall, or a fall and a rise, of a component: from where it leaves a level to where it is back, or
  /// turns again.
  struct Pulse {
    double begin = 0.0, end = 0.0;  ///< [s] or [m]
    int component = 0;              ///< 0..5: Fx to Mz
    double height = 0.0;            ///< the smaller of both changes [N] or [N m]
  };
  /// Those whose height is at least a tenth of the component's largest amount, by component and place.
  [[nodiscard]] std::vector<Pulse> pulses() const;

 private:
  LoadArgument argument_;
  std::vector<double> points_;
  std::vector<ForceAndMoment> loads_;
};

/// A one-minus-cosine gust over time: of its peak the share (1 − cos(2π(t − start)/duration))/2 within the duration,
/// zero outside; as straight lines that are nowhere farther off than 2e-5.
struct GustShape {
  std::vector<double> points, share;  ///< [s], 0 to 1
};
/// @pre duration > 0
[[nodiscard]] GustShape one_minus_cosine(double start, double duration);
/// A load that rises and falls with one_minus_cosine().
[[nodiscard]] LoadHistory gust_history(const ForceAndMoment& peak, double start, double duration);

/// Read a load history: first column t[s] or x[m], then any of Fx, Fy, Fz in [N] or [kN] and Mx, My, Mz in [N m] or
/// [kN m]; components without a column are zero (docs/file_formats/histories.md).
/// @param start added to the first column [s] or [m]
/// @throws InputError with file and line
[[nodiscard]] LoadHistory read_load_history(const std::filesystem::path& file, double start = 0.0);

/// A load at the centre of gravity of each of some bodies. Displacements being small, it keeps its direction and point.
struct BodyLoad {
  static constexpr int every_vehicle = -1;
  int vehicle = every_vehicle;  ///< of the train, front first
  std::vector<int> bodies;      ///< of the vehicle, front first; more than one in a train that is one vehicle
  LoadHistory history;
};

}  // namespace railtab
