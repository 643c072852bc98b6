#pragma once

#include <Eigen/SparseCore>
#include <cstddef>

#include "railtab/runtime/algebra/paired_product.hpp"
#include "railtab/runtime/algebra/section_layout.hpp"
#include "railtab/runtime/structure/structure_model.hpp"
#include "railtab/runtime/vsi/hht.hpp"

namespace railtab {

/// What steps of every size need of a structure's matrices, made once for all of them.
class StepMatrices {
 public:
  using Sparse = Eigen::SparseMatrix<double>;

  /// @param all_active whether all unknowns take part in every step, rather than those of a window
  /// @throws InputError naming the matrix and the entry that is not finite
  StepMatrices(SharedStructure structure, bool all_active);

  [[nodiscard]] const SharedStructure& structure() const noexcept { return structure_; }
  [[nodiscard]] bool all_active() const noexcept { return all_active_; }
  /// Whether the unknowns have lines, by which the structure may be cut into sections.
  [[nodiscard]] bool divisible() const noexcept { return stiffness_.size() > 0; }
  /// Of the rails' unknowns; none where the matrices do not get sparser by them.
  [[nodiscard]] const MirrorPairs& pairs() const noexcept { return pairs_; }
  [[nodiscard]] const UnknownPlaces& places() const noexcept { return places_; }
  /// K and C by sums and differences of the pairs. @pre divisible()
  [[nodiscard]] const Sparse& stiffness() const noexcept { return stiffness_; }
  [[nodiscard]] const Sparse& damping() const noexcept { return damping_; }
  /// K̄ of the unknowns in a range, the others without entries; by sums and differences of the pairs. @pre divisible()
  [[nodiscard]] Sparse divided(const HhtScheme& scheme, const DofRange& range) const;
  /// Products with K and C as they are; empty where the structure is divisible.
  [[nodiscard]] const PairedProduct& product() const noexcept { return product_; }
  /// Whether a symmetric structure carries both rails, as far as its lines tell.
  [[nodiscard]] bool rails_mirror() const noexcept { return rails_mirror_; }
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  SharedStructure structure_;
  bool all_active_;
  MirrorPairs pairs_;
  UnknownPlaces places_;
  Sparse mass_, damping_, stiffness_;
  PairedProduct product_;
  bool rails_mirror_ = false;
};

/// K̄ of the unknowns in a range, the others without entries.
[[nodiscard]] StepMatrices::Sparse effective_matrix(const StructureModel& structure, const HhtScheme& scheme,
                                                    const DofRange& range);

/// @throws InputError naming the matrix and the entry that is not finite
void require_finite(const StructureModel& structure);

}  // namespace railtab
