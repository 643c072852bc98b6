#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace railtab {

/// Smallest and largest value of each of many series, and the number of the sample, from 0; of equal ones the first.
class RunningExtremes {
 public:
  explicit RunningExtremes(std::size_t series);
  void add(long sample, std::span<const double> values);

  [[nodiscard]] std::size_t size() const noexcept { return smallest_.size(); }
  [[nodiscard]] bool empty() const noexcept { return samples_ == 0.0; }
  [[nodiscard]] const std::vector<double>& smallest() const noexcept { return smallest_; }
  [[nodiscard]] const std::vector<double>& largest() const noexcept { return largest_; }
  [[nodiscard]] const std::vector<double>& smallest_at() const noexcept { return smallest_at_; }  ///< samples
  [[nodiscard]] const std::vector<double>& largest_at() const noexcept { return largest_at_; }    ///< samples

  /// For checkpoints, as of LowPassBank.
  void pack(std::vector<double>& numbers) const;
  void unpack(std::span<const double>& numbers);

 private:
  double samples_ = 0.0;
  std::vector<double> smallest_, largest_, smallest_at_, largest_at_;
};

}  // namespace railtab
