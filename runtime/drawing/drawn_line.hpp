#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace railtab::drawing {

/// A line along the track, a deck's axis or a rail, that passes through recorded nodes. Between them it is drawn as a
/// natural cubic spline, at its ends at rest where it has some.
struct DrawnLine {
  std::vector<double> x;               ///< of its points, not decreasing [m]
  Eigen::MatrixXd weights;             ///< points × recorded nodes: motion of a point by those of the nodes
  std::vector<std::optional<int>> of;  ///< recorded node that a point is, none for what is drawn between
};

/// @param nodes positions of the recorded nodes, in any order, at one place perhaps several (the first counts) [m]
/// @param rests where the line is at rest, not recorded: supports, or where nothing is known [m]
/// @param spacing longest distance of its points [m]
[[nodiscard]] DrawnLine drawn_line(const std::vector<double>& nodes, const std::vector<double>& rests, double spacing);

}  // namespace railtab::drawing
