#pragma once

#include <string>
#include <vector>

namespace railtab::report {

struct Tick {
  double value;
  std::string label;
};

/// An axis with ticks at round numbers (1, 2 or 5 times a power of ten).
struct Axis {
  double low, high;
  std::vector<Tick> ticks;

  /// Position of a value along the axis, 0 at `low`, 1 at `high`.
  [[nodiscard]] double fraction(double value) const noexcept { return (value - low) / (high - low); }
};

/// The axis ends at the outermost ticks: for values. About `count` ticks. Equal ends are widened.
[[nodiscard]] Axis rounded_axis(double low, double high, int count);
/// The axis ends where the data do, ticks inside: for distance and time.
[[nodiscard]] Axis tight_axis(double low, double high, int count);

}  // namespace railtab::report
