#pragma once

#include <cstddef>

namespace railtab {

/// An estimate with the bounds of its two-sided confidence interval.
struct ConfidenceInterval {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// Probability from `hits` of `count` independent trials with the score interval of [Wilson1927] at a level of
/// confidence such as 0.95; it holds for no hits and only hits too. @pre count > 0, hits <= count, 0 < confidence < 1
[[nodiscard]] ConfidenceInterval wilson_interval(std::size_t hits, std::size_t count, double confidence) noexcept;
/// The same of a share, the mean of `count` independent values between 0 and 1, whose variance is at most that of
/// trials. @pre count > 0, 0 <= share <= 1
[[nodiscard]] ConfidenceInterval wilson_interval_of_share(double share, std::size_t count, double confidence) noexcept;

/// A probability of this coefficient of variation, taken as lognormal about the value; 0 stays 0. @pre 0 < confidence <
/// 1
[[nodiscard]] ConfidenceInterval lognormal_interval(double value, double variation, double confidence) noexcept;

}  // namespace railtab
