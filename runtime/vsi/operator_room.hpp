#pragma once

#include <algorithm>

namespace railtab {

/// Operators of steps of different sizes that exist at once: of the whole step and of two divided ones, and of more, up
/// to `most`, as long as all of them take no more than `kept_bytes`.
struct OperatorRoom {
  static constexpr int least = 3, most = 8;
  static constexpr double kept_bytes = 256.0 * 1024.0 * 1024.0;

  int count = 0;
  double all = 0.0, largest = 0.0;  // bytes

  void add(double bytes) noexcept {
    ++count;
    all += bytes;
    largest = std::max(largest, bytes);
  }
  /// Whether there is room for one more that takes as much as the largest of these.
  [[nodiscard]] bool for_another() const noexcept {
    return count < least || (count < most && all + largest <= kept_bytes);
  }
  /// What those besides one take at most [bytes]. @param one of each, at most
  [[nodiscard]] static double of_others(double one) noexcept {
    return std::max((least - 1) * one, std::min((most - 1) * one, kept_bytes - one));
  }
};

}  // namespace railtab
