#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <string_view>
#include <vector>

#include "railtab/runtime/algebra/section_layout.hpp"
#include "railtab/runtime/algebra/sparse_ldlt.hpp"
#include "railtab/runtime/base/lane_numbers.hpp"

namespace railtab {

struct EliminationTree;

/// Factor of a long structure's matrix by substructuring: the sections of its layout are eliminated side by side, one
/// in each place of a vector register; what is left is the small system of the interface unknowns (their Schur
/// complement), factored as a whole. Entries of L are floats, which halves what a substitution reads of it; it computes
/// with doubles. The matrix that it solves with is symmetric and differs from the given one off the diagonal alone, by
/// rounding of floats.
class SectionedLdlt final : public SubstitutionFactor {
 public:
  /// @param matrix symmetric, whole pattern @throws ComputationError with the message where it is not positive definite
  SectionedLdlt(const Eigen::SparseMatrix<double>& matrix, std::shared_ptr<const SectionLayout> layout,
                std::string_view message);

  [[nodiscard]] Eigen::Index room() const noexcept override;
  [[nodiscard]] std::size_t bytes() const noexcept override;
  [[nodiscard]] std::size_t stored_bytes() const noexcept override;

  void find_path(std::span<const int> unknowns, Path& path) const override;
  [[nodiscard]] bool covers(const Path& path, std::span<const int> unknowns) const override;
  void into(const Vector& natural, Vector& ordered) const override;
  void into(std::span<const int> few, double weight, const Vector& natural, Vector& ordered) const override;
  void out_of(const Vector& ordered, Vector& natural) const override;
  void load(const Path& path, std::span<const int> few, double weight, const Vector& natural,
            Vector& ordered) const override;
  void read(std::span<const int> few, const Vector& ordered, Vector& natural) const override;

  void forward(Vector& y) const override;
  void forward(Vector& y, const Path& path, const Vector& known) const override;
  void backward(const Vector& y, Vector& x, const Path& path) const override;
  void backward_off(const Path& path, const Vector& y, Vector& x) const override;

 private:
  /// Up to four neighbouring columns of L that share the rows below them: a block of the elimination tree, or a part.
  struct Strip {
    int columns, rows;  ///< rows below its triangle
    int parent;         ///< strip of the first of them; -1: none, or a border slot
    int first;          ///< column, in the order of elimination
    int slot, value;    ///< where its slots and its numbers begin
  };
  struct Numbers;  // while the factor is made
  void set_strips(const EliminationTree& tree);
  void eliminate(Numbers& numbers, std::string_view message) const;
  void factor_interfaces(const Numbers& numbers, std::string_view message);
  void store(const Numbers& numbers);
  /// Where the interface unknowns stand once more, in the order of their factor.
  [[nodiscard]] Eigen::Index factor_begin() const noexcept {
    return layout_->interface_begin() + static_cast<Eigen::Index>(layout_->interfaces.size());
  }
  [[nodiscard]] int range_begin() const noexcept { return static_cast<int>(layout_->range.begin); }
  /// Calls visitor(slot) for the columns of the path.
  template <class Visitor>
  void visit_slots(const Path& path, Visitor&& visitor) const;
  void set(std::span<const int> few, double weight, const Vector& natural, Vector& ordered) const;
  void forward_interfaces(Vector& y) const;
  void backward_interfaces(const Vector& y, Vector& x) const;
  void forward_strip(const Strip& strip, Lanes* y) const noexcept;
  void backward_strip(const Strip& strip, const Lanes* y, Lanes* x) const noexcept;

  std::shared_ptr<const SectionLayout> layout_;
  std::vector<Strip> strip_;                ///< each after all that hang on it
  std::vector<int> strip_of_;               ///< of the slots
  std::vector<int> slot_;                   ///< of each strip, of its columns, then of its rows
  std::vector<float> value_;                ///< of each strip, its triangle and then what is below, row by row
  std::vector<Lanes> inverse_D_;            ///< of the columns
  std::unique_ptr<SparseLdlt> interfaces_;  ///< null where there are none
};

}  // namespace railtab
