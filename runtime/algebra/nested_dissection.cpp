#include "railtab/runtime/algebra/nested_dissection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "railtab/runtime/base/index.hpp"

namespace railtab {

namespace {

constexpr std::size_t leaf_size = 48;  // unknowns that are not cut further

// An unknown with this many times the neighbours of the mean is a hub: the node of a long beam element, which all
// sleepers on the element hang on. Through hubs everything is near everything, and no level would cut: they are
// eliminated last, and the cuts are those of the rest.
constexpr std::size_t hub = 20;

class Dissection {
 public:
  Dissection(std::span<const int> begin, std::span<const int> row)
      : begin_(begin), row_(row), part_(begin.size() - 1, 0), level_(begin.size() - 1, 0) {
    order_.reserve(part_.size());
    std::vector<int> all, hubs;
    all.reserve(part_.size());
    for (std::size_t i = 0; i < part_.size(); ++i) {
      const auto neighbours = static_cast<std::size_t>(begin_[i + 1] - begin_[i]);
      const bool is_hub = neighbours * part_.size() > hub * row_.size();
      if (is_hub) part_[i] = no_part;
      (is_hub ? hubs : all).push_back(static_cast<int>(i));
    }
    eliminate(all);
    order_.insert(order_.end(), hubs.begin(), hubs.end());
  }
  [[nodiscard]] std::vector<int> order() && { return std::move(order_); }

 private:
  static constexpr int no_part = -1;

  // The vertices of `part` that can be reached from `start`, level by level.
  std::vector<int> search(int start, int part) {
    const int seen = ++last_part_;
    std::vector<int> reached{start};
    part_[index(start)] = seen;
    level_[index(start)] = 0;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      const int v = reached[i];
      for (int p = begin_[index(v)]; p < begin_[index(v) + 1]; ++p) {
        const int w = row_[index(p)];
        if (part_[index(w)] != part) continue;
        part_[index(w)] = seen;
        level_[index(w)] = level_[index(v)] + 1;
        reached.push_back(w);
      }
    }
    return reached;
  }

  // Appends an order of `vertices`, which need not hang together.
  void eliminate(const std::vector<int>& vertices) {
    const int part = ++last_part_;
    for (int v : vertices) part_[index(v)] = part;
    for (int v : vertices) {
      if (part_[index(v)] != part) continue;
      const std::vector<int> there = search(v, part);
      // From the far end back again: the levels of a long structure are then its cross-sections.
      dissect(search(there.back(), part_[index(v)]));
    }
  }

  [[nodiscard]] bool touches_level(int v, int level) const {
    for (int p = begin_[index(v)]; p < begin_[index(v) + 1]; ++p) {
      const auto w = index(row_[index(p)]);
      if (part_[w] == part_[index(v)] && level_[w] == level) return true;
    }
    return false;
  }

  // `reached`: connected vertices in the order of their levels.
  void dissect(const std::vector<int>& reached) {
    const int levels = level_[index(reached.back())] + 1;
    if (reached.size() <= leaf_size || levels < 3) {
      order_.insert(order_.end(), reached.begin(), reached.end());
      return;
    }
    std::vector<std::size_t> first(index(levels) + 1, reached.size());  // of each level in `reached`
    for (std::size_t i = reached.size(); i-- > 0;) first[index(level_[index(reached[i])])] = i;
    // The smallest of the levels that leave at least a third on either side; else the one nearest the middle.
    int cut = 1;
    double best = INFINITY;
    for (int l = 1; l + 1 < levels; ++l) {
      const auto size = static_cast<double>(reached.size());
      const double below = static_cast<double>(first[index(l)]) / size;
      const double above = 1.0 - static_cast<double>(first[index(l) + 1]) / size;
      const double width = static_cast<double>(first[index(l) + 1] - first[index(l)]) / size;
      const double score = std::min(below, above) > 0.3 ? width : 1.0 + std::abs(below - above);
      if (score < best) {
        best = score;
        cut = l;
      }
    }
    const auto at = [&](std::size_t i) { return reached.begin() + static_cast<std::ptrdiff_t>(i); };
    std::vector<int> below(reached.begin(), at(first[index(cut)]));
    const std::vector<int> above(at(first[index(cut) + 1]), reached.end());
    // What has no neighbour above need not be cut: inner unknowns of solid elements are two thirds of a level.
    std::vector<int> middle;
    for (std::size_t i = first[index(cut)]; i < first[index(cut) + 1]; ++i) {
      (touches_level(reached[i], cut + 1) ? middle : below).push_back(reached[i]);
    }
    eliminate(below);
    eliminate(above);
    order_.insert(order_.end(), middle.begin(), middle.end());
  }

  std::span<const int> begin_, row_;
  std::vector<int> part_, level_, order_;
  int last_part_ = 0;
};

}  // namespace

std::vector<int> nested_dissection(std::span<const int> begin, std::span<const int> row) {
  return begin.size() > 1 ? Dissection(begin, row).order() : std::vector<int>();
}

}  // namespace railtab
