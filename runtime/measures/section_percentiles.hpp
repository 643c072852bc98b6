#pragma once

#include <vector>

namespace railtab {

/// Percentiles of a quantity over one section of track: 0.15 and 99.85 % [EN14363].
struct SectionRange {
  double from = 0.0, to = 0.0;  ///< the section [m]
  double low = 0.0, high = 0.0;
  /// The one of larger amount.
  [[nodiscard]] double extreme() const noexcept { return -low > high ? low : high; }
};

/// Percentiles of a quantity along the track, section by section: of its values at even places, from the line through
/// the samples. Memory is that of one section's values.
class SectionPercentiles {
 public:
  /// @param begin of the first section [m] @param length of a section [m], 0: one section, as far as samples go
  /// @param step between the places [m], > 0
  SectionPercentiles(double begin, double length, double step);
  /// @pre positions rise
  void add(double position, double value);
  /// Sections that are full; without a length the one section, where it has two values at least.
  [[nodiscard]] std::vector<SectionRange> sections() const;

 private:
  void take(double value);

  double begin_, step_;
  long place_ = 0, per_section_ = 0;  // of the next value; values of a full section, 0: no end
  bool any_ = false;
  double last_position_ = 0.0, last_value_ = 0.0;
  std::vector<double> values_;
  std::vector<SectionRange> full_;
};

}  // namespace railtab
