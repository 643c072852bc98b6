#pragma once

#include <cstddef>
#include <vector>

namespace railtab {

/// A contact force over the lowering of the wheel below first touch, through solutions, and the work that it does. The
/// spline is that of F^(2/3), which is linear for a Hertzian contact.
class ForceOverLowering {
 public:
  /// @param lowering of the solutions [m] @param force theirs [N]; both begin with 0 and rise, three values at least
  ForceOverLowering(std::vector<double> lowering, const std::vector<double>& force);

  [[nodiscard]] double force(double lowering) const;
  /// U = ∫ F dz up to solution i [J].
  [[nodiscard]] double work(std::size_t i) const { return work_[i]; }
  /// The lowering at which the work is done [m]; beyond the last solution the spline goes on. @pre work > 0
  [[nodiscard]] double lowering_at(double work) const;

 private:
  [[nodiscard]] double force_in(std::size_t interval, double from_begin) const;
  [[nodiscard]] double work_in(std::size_t interval, double from_begin) const;

  std::vector<double> lowering_, root_, slope_, work_;
};

}  // namespace railtab
