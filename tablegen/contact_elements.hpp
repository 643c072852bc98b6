#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <vector>

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/tablegen/undeformed_distance.hpp"

namespace railtab {

/// A connected region in which the undeformed surfaces overlap.
struct SurfaceOverlap {
  /// Between two saddles of the overlap along s: what elements must resolve by itself.
  struct Part {
    double length;  ///< largest along x at one s [m]
    double width;   ///< of an ellipse's overlap that is spread along s like this one, at most its extent [m]
    double volume;  ///< integral of the overlap [m³]
  };
  double s_low, s_high;  ///< arc lengths on the rail profile [m]
  double x_low, x_high;  ///< relative to the wheelset centre [m]
  double depth;          ///< largest overlap [m]
  std::vector<Part> parts;
};

/// Overlap regions of a wheel and its rail, in increasing s. Every region has a deepest point, which is a contact patch
/// of the search: from each patch the overlap is followed to both sides along the rail profile.
/// @param search of the pair of `distance`, at whose pose it is asked
/// @throws ComputationError where a patch of the search has no undeformed distance
[[nodiscard]] std::vector<SurfaceOverlap> surface_overlaps(const ContactSearch& search, const WheelsetPose& pose,
                                                           const UndeformedDistance& distance);

/// How the overlap is divided.
struct ContactElementOptions {
  int across_narrowest = 40;  ///< elements along and across the narrowest part that counts in full, 4..1000
  int most = 60000;           ///< elements altogether, 64..4000000, ordinarily less than a second's work
  /// A part with a smaller share of the overlap's volume than this counts less: as many elements as the square root
  /// of its share in this one, so that a part that begins changes the elements' size continuously; 1e-6..1.
  double full_share = 0.1;

  /// @throws InputError
  void validate() const;
};

/// ContactElementOptions::most where two narrow contacts lie in a wide box: some seconds each.
inline constexpr int most_elements = 500000;

/// The narrowest part needs more elements than allowed.
class TooManyElements : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Rectangles dx × ds of the developed rail surface over the bounding box of all overlap regions, ns rows of nx.
struct ContactElements {
  int nx = 0, ns = 0;
  double dx = 0.0, ds = 0.0;      ///< sides [m]
  std::vector<double> x;          ///< centres along the rail, relative to the wheelset centre [m]
  std::vector<SurfaceLine> line;  ///< of each row; of the rail alone where no wheel surface was found
  Eigen::VectorXd overlap;        ///< undeformed, at the centres [m]; negative: a gap
  std::vector<double> s_wheel;    ///< of the wheel's point at the centres [m]

  [[nodiscard]] double area() const noexcept { return dx * ds; }
  [[nodiscard]] int count() const noexcept { return nx * ns; }
};

/// @param regions not empty @throws TooManyElements
[[nodiscard]] ContactElements contact_elements(const UndeformedDistance& distance,
                                               const std::vector<SurfaceOverlap>& regions,
                                               const ContactElementOptions& options);

/// The same with given numbers of elements.
[[nodiscard]] ContactElements contact_elements(const UndeformedDistance& distance,
                                               const std::vector<SurfaceOverlap>& regions, int nx, int ns);

}  // namespace railtab
