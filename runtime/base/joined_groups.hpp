#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "railtab/runtime/base/index.hpp"

namespace railtab {

/// The numbers 0 to n − 1 in groups, each alone until two of them are joined.
class JoinedGroups {
 public:
  explicit JoinedGroups(std::size_t n) : above_(n) { std::iota(above_.begin(), above_.end(), 0); }

  /// The least number of the group that i is in.
  [[nodiscard]] int first(int i) {
    while (above_[index(i)] != i) i = above_[index(i)] = above_[index(above_[index(i)])];
    return i;
  }
  /// Makes the groups of a and b one.
  void join(int a, int b) {
    const auto [lesser, greater] = std::minmax({first(a), first(b)});
    above_[index(greater)] = lesser;
  }

 private:
  std::vector<int> above_;  // a lesser number of the group; of the least one itself
};

}  // namespace railtab
