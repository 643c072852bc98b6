#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "railtab/runtime/algebra/section_layout.hpp"
#include "railtab/runtime/base/lane_numbers.hpp"

namespace railtab {

/// Products with stiffness and damping of a structure in sections, all sections side by side.
class SectionedProduct {
 public:
  /// @param stiffness, damping symmetric, whole pattern, by_sums_and_differences() of the layout's pairs
  SectionedProduct(const Eigen::SparseMatrix<double>& stiffness, const Eigen::SparseMatrix<double>& damping,
                   std::shared_ptr<const SectionLayout> layout);

  /// Displacement and velocity in the layout.
  struct Motion {
    Eigen::VectorXd u, v;
  };
  /// ordered <- ordered − K u − C v. @param motion its borders are set @param ordered room for the whole layout
  void subtract(Motion& motion, Eigen::VectorXd& ordered) const;

  [[nodiscard]] std::size_t bytes() const noexcept;
  [[nodiscard]] const std::shared_ptr<const SectionLayout>& layout() const noexcept { return layout_; }

 private:
  struct Pair {
    Lanes stiffness{}, damping{};
  };
  struct InterfaceEntry {
    int row, column;
    double stiffness, damping;
  };
  std::shared_ptr<const SectionLayout> layout_;
  /// Lower triangle with its diagonal, by slots, border slots included: entries that are alike in all sections but for
  /// rounding, one number for all, and the others.
  template <class Value>
  struct Entries {
    std::vector<int> begin, row;
    std::vector<Value> value;
  };
  Entries<std::array<double, 2>> alike_;
  Entries<Pair> other_;
  std::vector<InterfaceEntry> interface_;  ///< between interface unknowns, both triangles
};

}  // namespace railtab
