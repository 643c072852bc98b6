#include "railtab/tablegen/slip_average.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

namespace {

constexpr int samples = 6;  ///< along each side of an element
/// 1 - cos of the angle to a neighbour's slip: no mean below the first, the mean in full above the second. Below, the
/// error of one sample is a hundredth of the element's traction; and slip that is nearly zero over many elements, as
/// at the onset of full sliding, does not turn, though its linear continuation would.
constexpr double small_turn = 0.03, large_turn = 0.25;

using Vector = Eigen::Vector2d;

/// Mean of the unit vectors of slip + x·by_x + y·by_y over x, y in -1/2..1/2.
Vector mean_direction(const Vector& slip, const Vector& by_x, const Vector& by_y) {
  Vector mean = Vector::Zero();
  for (int i = 0; i < samples; ++i) {
    for (int j = 0; j < samples; ++j) {
      const Vector s = slip + ((i + 0.5) / samples - 0.5) * by_x + ((j + 0.5) / samples - 0.5) * by_y;
      const double size = s.norm();
      if (size > 0.0) mean += s / size;
    }
  }
  return mean / (samples * samples);
}

/// Slip of the elements, and how it changes from one to the next.
class SlipField {
 public:
  SlipField(const RollingContactGrid& grid, const ElementField& traction, const ElementField& slip)
      : grid_(grid), slip_(slip), slips_(static_cast<std::size_t>(grid.count()), 0) {
    const int m = grid.count();
    for (const int k : grid.inside) {
      slips_[static_cast<std::size_t>(k)] = std::hypot(traction[k], traction[m + k]) > grid.bound[k] * (1.0 - 1e-9);
    }
  }

  [[nodiscard]] bool slips(int k) const { return slips_[static_cast<std::size_t>(k)] != 0; }
  /// Whether the element or one next to it adheres. There the slip grows from zero without turning.
  [[nodiscard]] bool borders_on_adhesion(int k) const {
    const int n = grid_.nx, i = k % n, j = k / n;
    const auto adheres = [this](int l) { return grid_.bound[l] > 0.0 && !slips(l); };
    return adheres(k) || (i > 0 && adheres(k - 1)) || (i + 1 < n && adheres(k + 1)) || (j > 0 && adheres(k - n)) ||
           (j + 1 < grid_.ny && adheres(k + n));
  }
  [[nodiscard]] Vector at(int k) const { return {slip_[k], slip_[grid_.count() + k]}; }

  /// Largest 1 - cos of the angle between the slip of the element and that of one next to it.
  [[nodiscard]] double turn(int k) const {
    const int n = grid_.nx, i = k % n, j = k / n;
    const Vector here = at(k).normalized();
    double largest = 0.0;
    const auto compare = [&](int l) {
      if (slips(l)) largest = std::max(largest, 1.0 - here.dot(at(l).normalized()));
    };
    if (i > 0) compare(k - 1);
    if (i + 1 < n) compare(k + 1);
    if (j > 0) compare(k - n);
    if (j + 1 < grid_.ny) compare(k + n);
    return largest;
  }

  /// Change over one element towards growing x (axis 0) or y (axis 1); `otherwise` where no neighbour slips.
  [[nodiscard]] Vector change(int k, int axis, const Vector& otherwise) const {
    const int place = axis == 0 ? k % grid_.nx : k / grid_.nx, stride = axis == 0 ? 1 : grid_.nx;
    Vector sum = Vector::Zero();
    int neighbours = 0;
    if (place + 1 < (axis == 0 ? grid_.nx : grid_.ny) && slips(k + stride)) {
      sum += at(k + stride) - at(k);
      ++neighbours;
    }
    if (place > 0 && slips(k - stride)) {
      sum += at(k) - at(k - stride);
      ++neighbours;
    }
    return neighbours > 0 ? Vector(sum / neighbours) : otherwise;
  }

 private:
  const RollingContactGrid& grid_;
  const ElementField& slip_;
  std::vector<char> slips_;
};

}  // namespace

CreepForce slip_average_correction(const RollingContactGrid& grid, const ElementField& traction,
                                   const ElementField& slip, double rigid_gradient) {
  const SlipField field(grid, traction, slip);
  const int n = grid.nx, m = grid.count();
  CreepForce correction;
  for (const int k : grid.inside) {
    if (field.borders_on_adhesion(k)) continue;
    const double share = std::clamp((field.turn(k) - small_turn) / (large_turn - small_turn), 0.0, 1.0);
    if (share == 0.0) continue;
    const Vector by_x = field.change(k, 0, {0.0, rigid_gradient * grid.dx});
    const Vector by_y = field.change(k, 1, {-rigid_gradient * grid.dy, 0.0});
    const Vector here = field.at(k);
    const Vector mean = -grid.bound[k] * mean_direction(here, by_x, by_y);
    const double px = share * (mean[0] - traction[k]), py = share * (mean[1] - traction[m + k]);
    correction.x += px * grid.area();
    correction.y += py * grid.area();
    correction.moment +=
        (grid.x[static_cast<std::size_t>(k % n)] * py - grid.y[static_cast<std::size_t>(k / n)] * px) * grid.area();
  }
  return correction;
}

}  // namespace railtab
