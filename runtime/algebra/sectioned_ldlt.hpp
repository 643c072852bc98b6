#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <string_view>
#include <vector>

#include "railtab/runtime/algebra/section_layout.hpp"
#include "railtab/runtime/algebra/sparse_ldlt.hpp"
#include "railtab/runtime/base/lane_numbers.hpp"

namespace railtab {

/// Factor of a long structure's matrix by substructuring: the sections of its layout are eliminated side by side, one
/// in each place of a vector register; what is left is the small system of the interface unknowns (their Schur
/// complement), factored as a whole.
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
  void add(const Path& path, const Vector& known, Vector& y) const override;
  void read(std::span<const int> few, const Vector& ordered, Vector& natural) const override;

  void forward(Vector& y) const override;
  void forward(Vector& y, const Path& path) const override;
  void backward(const Vector& y, Vector& x, const Path& path) const override;
  void backward_off(const Path& path, const Vector& y, Vector& x) const override;

 private:
  struct Numbers;  // while the factor is made
  [[nodiscard]] int rank(int slot) const noexcept { return rank_[static_cast<std::size_t>(slot)]; }
  void find_columns(const Eigen::SparseMatrix<double>& pattern);
  void eliminate(Numbers& numbers, std::string_view message);
  void factor_interfaces(const Numbers& numbers, std::string_view message);
  /// Where the interface unknowns stand once more, in the order of their factor.
  [[nodiscard]] Eigen::Index factor_begin() const noexcept {
    return layout_->interface_begin() + static_cast<Eigen::Index>(layout_->interfaces.size());
  }
  void set(std::span<const int> few, double weight, const Vector& natural, Vector& ordered) const;
  void forward_interfaces(Vector& y) const;
  void backward_interfaces(const Vector& y, Vector& x) const;

  std::shared_ptr<const SectionLayout> layout_;
  std::vector<int> rank_;         ///< of a slot in the order of elimination; border slots come last
  std::vector<int> begin_, row_;  ///< of the columns of L in that order; rows are slots, of ascending rank
  std::vector<Lanes> value_, inverse_D_;
  std::unique_ptr<SparseLdlt> interfaces_;  ///< null where there are none
};

}  // namespace railtab
