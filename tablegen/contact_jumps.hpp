#pragma once

#include <optional>
#include <vector>

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"

namespace railtab {

/// A lateral shift at which first touch jumps between two places of the rail.
struct ContactJump {
  double y;                 ///< [m]
  double s_below, s_above;  ///< arc lengths on the rail just below and above y [m]
};

/// All jumps of first touch of more than 1 mm along the rail, in increasing y.
/// @param roll of the wheelset at y = 0 [rad] @param climb that it loses per y [rad/m]
[[nodiscard]] std::vector<ContactJump> contact_jumps(const ContactSearch& search, const Interval& lateral, double roll,
                                                     double yaw, double climb = 0.0);

/// Where the jumps of a reference are among those of a wheelset with other roll and yaw [m], as many as of the
/// reference: the same jump is that which shares most of its stretch of the rail. A wide jump is split in two where a
/// place of its stretch touches first; of the two the wider one goes on with it. None where a jump is absent.
[[nodiscard]] std::vector<std::optional<double>> same_jumps(const std::vector<ContactJump>& reference,
                                                            const std::vector<ContactJump>& moved);

/// Where between the two places of a jump the gap between wheel and rail is largest, without yaw [m].
[[nodiscard]] double widest_gap(const ContactSearch& search, const ContactJump& jump, double roll = 0.0);

/// The lateral shift y at which a wheelset with roll and yaw meets the rail as one without does at y0: through the
/// jumps of both, with a continuous slope between them and constant displacement beyond; without jumps by a
/// displacement that is given.
class LateralWarp {
 public:
  /// @param reference, moved jumps of the wheelset without and with roll and yaw, as many @param constant where there
  /// are none [m]
  LateralWarp(std::vector<double> reference, const std::vector<double>& moved, double constant);

  struct Place {
    double y, slope;  ///< [m], dy/dy0
  };
  [[nodiscard]] Place at(double y0) const noexcept;

 private:
  std::vector<double> y0_, displacement_, slope_;
  double constant_;
};

}  // namespace railtab
