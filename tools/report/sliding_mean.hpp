#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace railtab::report {

/// Mean of what was recorded over the last metres of way, as running-safety quantities are averaged.
class SlidingMean {
 public:
  /// @param length of the way averaged over [m]
  explicit SlidingMean(double length) : length_(length) {}

  /// The mean of the records between `position` − length and `position` [m]; empty until so much way has been recorded.
  /// @pre positions do not decrease
  [[nodiscard]] std::optional<double> add(double position, double value) {
    if (position_.empty()) first_ = position;
    position_.push_back(position);
    value_.push_back(value);
    while (position_[begin_] < position - length_) ++begin_;
    drop_passed();
    if (position - first_ < length_) return std::nullopt;
    return sum() / static_cast<double>(value_.size() - begin_);
  }

 private:
  // In an order that does not depend on where the numbers lie in memory.
  [[nodiscard]] double sum() const {
    using Eight = Eigen::Array<double, 8, 1>;
    Eight sums = Eight::Zero();
    std::size_t i = begin_;
    for (; i + 8 <= value_.size(); i += 8) sums += Eight::Map(&value_[i]);
    double sum = sums.sum();
    for (; i < value_.size(); ++i) sum += value_[i];
    return sum;
  }

  // Once they are the most.
  void drop_passed() {
    if (2 * begin_ <= position_.size()) return;
    for (std::vector<double>* numbers : {&position_, &value_}) {
      numbers->erase(numbers->begin(), numbers->begin() + static_cast<std::ptrdiff_t>(begin_));
    }
    begin_ = 0;
  }

  double length_, first_ = 0.0;
  std::vector<double> position_, value_;  // of records, those before `begin_` passed
  std::size_t begin_ = 0;
};

}  // namespace railtab::report
