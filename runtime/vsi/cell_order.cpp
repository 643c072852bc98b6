#include "railtab/runtime/vsi/cell_order.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cmath>

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

class CellDissection {
 public:
  CellDissection(const Sparse& full, std::span<const double> x, std::span<const double> ends)
      : full_(full), cell_(x.size()), joint_(x.size(), no_joint), local_(x.size(), -1) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      cell_[i] = static_cast<int>(std::upper_bound(ends.begin(), ends.end(), x[i]) - ends.begin());
    }
    const int cells = static_cast<int>(ends.size()) + 1;
    member_.resize(static_cast<std::size_t>(cells));
    joints_.resize(static_cast<std::size_t>(cells));
    for (std::size_t i = 0; i < x.size(); ++i) member_[static_cast<std::size_t>(cell_[i])].push_back(static_cast<int>(i));
    dissect(0, cells);
  }
  [[nodiscard]] std::vector<int> order() && { return std::move(order_); }

 private:
  static constexpr int no_joint = -1;

  // Cells [first, last).
  void dissect(int first, int last) {
    if (last - first == 1) {
      eliminate_inside(first);
      return;
    }
    const int middle = (first + last) / 2;
    join(middle, last);
    dissect(first, middle);
    dissect(middle, last);
    const std::vector<int>& joint = joints_[static_cast<std::size_t>(middle)];
    order_.insert(order_.end(), joint.begin(), joint.end());
  }

  // Unknowns of the cell before `middle` that have neighbours from there on.
  void join(int middle, int last) {
    for (int i : member_[static_cast<std::size_t>(middle - 1)]) {
      if (joint_[static_cast<std::size_t>(i)] != no_joint) continue;
      for (Sparse::InnerIterator entry(full_, i); entry; ++entry) {
        const int other = cell_[static_cast<std::size_t>(entry.row())];
        if (other < middle || other >= last) continue;
        joint_[static_cast<std::size_t>(i)] = middle;
        joints_[static_cast<std::size_t>(middle)].push_back(i);
        break;
      }
    }
  }

  // Minimum degree on the cell's own graph.
  void eliminate_inside(int cell) {
    std::vector<int> inside;
    for (int i : member_[static_cast<std::size_t>(cell)]) {
      if (joint_[static_cast<std::size_t>(i)] != no_joint) continue;
      local_[static_cast<std::size_t>(i)] = static_cast<int>(inside.size());
      inside.push_back(i);
    }
    std::vector<Eigen::Triplet<double>> entries;
    for (int i : inside) {
      for (Sparse::InnerIterator entry(full_, i); entry; ++entry) {
        const auto row = static_cast<std::size_t>(entry.row());
        if (cell_[row] == cell && joint_[row] == no_joint) entries.emplace_back(local_[row], local_[static_cast<std::size_t>(i)], 1.0);
      }
    }
    const auto n = static_cast<Eigen::Index>(inside.size());
    Sparse graph(n, n);
    graph.setFromTriplets(entries.begin(), entries.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
    Eigen::AMDOrdering<int>()(graph, inverse);
    for (Eigen::Index k = 0; k < n; ++k) order_.push_back(inside[static_cast<std::size_t>(inverse.indices()[k])]);
  }

  const Sparse& full_;
  std::vector<int> cell_, joint_, local_;
  std::vector<std::vector<int>> member_, joints_;  // per cell; joints_[m] join the cells before m to those from m on
  std::vector<int> order_;
};

}  // namespace

std::vector<double> line_cells(std::span<const double> x, std::span<const std::array<double, 2>> spans, double length) {
  std::vector<double> ends;
  if (x.empty()) return ends;
  const auto cut = [&](double from, double to) {
    const auto pieces = static_cast<int>(std::max(1.0, std::floor((to - from) / length)));
    for (int k = 1; k < pieces; ++k) ends.push_back(from + (to - from) * k / pieces);
  };
  double from = x.front();
  for (const std::array<double, 2>& span : spans) {
    cut(from, span[0]);
    if (span[0] > from) ends.push_back(span[0]);
    ends.push_back(span[1]);
    from = span[1];
  }
  cut(from, x.back());
  return ends;
}

std::vector<int> cell_order(const Sparse& matrix, std::span<const double> x, std::span<const double> ends) {
  const Sparse full = matrix.selfadjointView<Eigen::Lower>();
  return CellDissection(full, x, ends).order();
}

}  // namespace railtab
