#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace railtab {

/// Nodes on the paths from given nodes of an elimination tree up to its roots: what a substitution with a load on these
/// nodes alone, or for a solution at them alone, visits [Davis2006, Sect. 3.2].
class TreePath {
 public:
  void clear(std::size_t nodes_of_tree) {
    mark_.resize(nodes_of_tree, 0);
    nodes_.clear();
    ++collection_;
  }
  /// Adds the path from `node`. @param parent  parent(node), -1 for a root
  template <class Parent>
  void add(int node, Parent&& parent) {
    for (int n = node; n >= 0 && !contains(n); n = parent(n)) {
      mark_[static_cast<std::size_t>(n)] = collection_;
      nodes_.push_back(n);
    }
  }
  /// After the last add(): nodes() are ascending from here on.
  void sort() {
    // Many nodes are found faster by their marks than sorted.
    constexpr std::size_t comparisons = 8;
    if (comparisons * nodes_.size() < mark_.size()) {
      std::sort(nodes_.begin(), nodes_.end());
      return;
    }
    nodes_.clear();
    for (std::size_t node = 0; node < mark_.size(); ++node) {
      if (mark_[node] == collection_) nodes_.push_back(static_cast<int>(node));
    }
  }

  [[nodiscard]] const std::vector<int>& nodes() const noexcept { return nodes_; }
  [[nodiscard]] bool contains(int node) const noexcept { return mark_[static_cast<std::size_t>(node)] == collection_; }

 private:
  std::vector<int> nodes_;
  std::vector<long> mark_;  // of every node: the collection that met it last
  long collection_ = 0;
};

}  // namespace railtab
