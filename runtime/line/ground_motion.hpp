#pragma once

#include <vector>

#include "railtab/runtime/line/ground_record.hpp"

namespace railtab {

/// Motion of the ground at a place x and a time, with its derivatives along x.
struct GroundPoint : GroundState {
  GroundVector slope = GroundVector::Zero();       ///< ∂/∂x [-]
  GroundVector slope_rate = GroundVector::Zero();  ///< ∂²/∂x∂t [1/s]
  GroundVector curvature = GroundVector::Zero();   ///< ∂²/∂x² [1/m]
};

/// Ground that moves everywhere alike, as a wave that travels along the track, or by records of its own at several
/// stations.
class GroundMotion {
 public:
  struct Station {
    double x;  ///< along the track [m]
    GroundRecord record;
  };

  /// The same everywhere.
  explicit GroundMotion(GroundRecord record);
  /// A wave g(t − (x − origin)/c): it reaches `origin` at the record's own time and travels forward for c > 0, backward
  /// for c < 0. @pre c != 0 [m/s]
  GroundMotion(GroundRecord record, double wave_speed, double origin);
  /// Records at stations, x strictly increasing; straight lines between them, the nearest station's beyond.
  /// @throws InputError naming the station
  explicit GroundMotion(std::vector<Station> stations);

  [[nodiscard]] GroundPoint at(double x, double time) const noexcept;
  /// Places that the motion is given at, two components each: anywhere else it is shares(x) of theirs. A wave has none.
  [[nodiscard]] std::vector<double> places() const;
  [[nodiscard]] Eigen::VectorXd shares(double x) const;
  /// Largest accelerations of all records, y and z [m/s²].
  [[nodiscard]] GroundVector peak() const noexcept;
  [[nodiscard]] bool uniform() const noexcept { return stations_.size() == 1 && slowness_ == 0.0; }

 private:
  std::vector<Station> stations_;
  double slowness_ = 0.0;  // 1/c [s/m]
  double origin_ = 0.0;    // [m]
};

}  // namespace railtab
