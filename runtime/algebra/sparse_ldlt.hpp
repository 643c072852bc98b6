#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <string_view>
#include <vector>

#include "railtab/runtime/algebra/elimination_order.hpp"
#include "railtab/runtime/algebra/substitution_factor.hpp"

namespace railtab {

struct EliminatedBlock;
struct EliminationTree;
struct NarrowBlock;

/// Factor L D Lᵀ of a symmetric positive definite matrix in supernodes: neighbouring columns of equal
/// structure are stored as one dense block with one list of rows, so that a substitution reads little more than the
/// factor's numbers and works on vectors [Davis2006, Sect. 4.8]. Where a system is long and narrow, paths are short.
/// Narrow blocks of equal shape of which none waits for another are substituted in by eights and fours side by side; in
/// the factor's order their columns stand in turn. A path reads whole groups of them, and sets what is on it alone.
class SparseLdlt final : public SubstitutionFactor {
 public:
  static constexpr std::string_view not_positive_definite = "the matrix of a linear system is not positive definite";

  /// @param matrix both triangles; @throws ComputationError where it is not positive definite
  explicit SparseLdlt(const Eigen::SparseMatrix<double>& matrix, std::string_view message = not_positive_definite)
      : SparseLdlt(matrix, {0, matrix.rows()}, message) {}
  /// The rows and columns in `range` alone: all other unknowns are held. Unknowns keep their numbers.
  /// @param order, node as of elimination_order()
  SparseLdlt(const Eigen::SparseMatrix<double>& matrix, const DofRange& range,
             std::string_view message = not_positive_definite,
             EliminationOrder order = EliminationOrder::minimum_degree, std::span<const int> node = {});

  /// Counted without making the factor.
  struct Memory {
    std::size_t stored = 0;   ///< stored_bytes()
    std::size_t made = 0;     ///< most that there is besides while it is made [bytes]
    std::size_t entries = 0;  ///< of L below the diagonal
  };
  [[nodiscard]] static Memory memory(const Eigen::SparseMatrix<double>& matrix, const DofRange& range,
                                     EliminationOrder order, std::span<const int> node = {});

  [[nodiscard]] Eigen::Index size() const noexcept { return inverse_D_.size(); }
  /// Length of vectors in the factor's order: one more, a 0 that stands for rows which fill up a block's last four, and
  /// what the substitution of a wide block works on.
  [[nodiscard]] Eigen::Index room() const noexcept override { return size() + 1 + most_height_; }
  [[nodiscard]] std::size_t bytes() const noexcept override;
  [[nodiscard]] std::size_t stored_bytes() const noexcept override;

  /// Of an unknown in the factor's order.
  [[nodiscard]] int position(int unknown) const noexcept {
    return position_[static_cast<std::size_t>(unknown - first_)];
  }
  void find_path(std::span<const int> unknowns, Path& path) const override;
  [[nodiscard]] bool covers(const Path& path, std::span<const int> unknowns) const override;
  void into(const Vector& natural, Vector& ordered) const override;
  void into(std::span<const int> few, double weight, const Vector& natural, Vector& ordered) const override;
  void out_of(const Vector& ordered, Vector& natural) const override;
  void load(const Path& path, std::span<const int> few, double weight, const Vector& natural,
            Vector& ordered) const override;
  void read(std::span<const int> few, const Vector& ordered, Vector& natural) const override;

  /// Full solutions under every column of loads, some at a time: the factor is read once for all of them.
  [[nodiscard]] Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& loads) const;

  void forward(Vector& y) const override { forward(y.data()); }
  /// The same of room() numbers.
  void forward(double* y) const;
  /// x <- L⁻ᵀ D⁻¹ x, of room() numbers.
  void backward(double* x) const;
  void forward(Vector& y, const Path& path, const Vector& known) const override;
  void backward(const Vector& y, Vector& x, const Path& path) const override;
  void backward_off(const Path& path, const Vector& y, Vector& x) const override;

 private:
  struct Block {
    int first, columns;  // first column's place in the factor's order, and number of columns
    int below, rows;     // rows below the triangle: number, and place of the first in rows_
    std::size_t value;   // place of its first number in values_, see there
    int parent;          // block of the first row below; -1: a root
    int together;        // blocks side by side: what is theirs stands in turn, a block's own this far apart

    [[nodiscard]] int column(int j) const noexcept { return first + together * j; }
    [[nodiscard]] int lane() const noexcept { return first % together; }  // among those side by side
  };
  [[nodiscard]] std::size_t first_of_group(int block) const noexcept {
    const auto b = static_cast<std::size_t>(block);
    return b - static_cast<std::size_t>(blocks_[b].lane());
  }
  /// Call visitor(first) for every group: blocks side by side, or one by itself.
  template <class Visitor>
  void visit_groups(Visitor&& visitor) const {
    for (std::size_t b = 0; b < blocks_.size(); b += static_cast<std::size_t>(blocks_[b].together)) visitor(b);
  }
  template <class Visitor>
  void visit_groups_from_last(Visitor&& visitor) const {
    for (std::size_t end = blocks_.size(); end > 0;) {
      end -= static_cast<std::size_t>(blocks_[end - 1].together);
      visitor(end);
    }
  }
  [[nodiscard]] NarrowBlock narrow_block(const Block& block) const noexcept;
  std::vector<int> place(const EliminationTree& tree);
  void store(const Block& block, const EliminatedBlock& from);
  [[nodiscard]] double* work_space(double* ordered) const noexcept { return ordered + size() + 1; }
  void forward(double* y, const Block& block) const;
  /// @param y may be x
  void backward(const double* y, double* x, const Block& block) const;
  /// The same of a group. @param first of its blocks @param which of them are meant, by bits
  void forward_group(double* y, std::size_t first, unsigned which) const;
  void backward_group(const double* y, double* x, std::size_t first, unsigned which) const;
  /// Of a whole group, for columns of y and x.
  void forward(Eigen::MatrixXd& y, std::size_t first, Eigen::MatrixXd& scratch) const;
  void backward(Eigen::MatrixXd& x, std::size_t first, Eigen::MatrixXd& scratch) const;
  /// T⁻¹ and below it B T⁻¹, of a block that is not narrow.
  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> wide(const Block& block) const;

  std::vector<Block> blocks_;
  std::vector<int> rows_;
  /// Of every block with triangle T and rows B below it: T⁻¹ and B T⁻¹, in the order in which they are read.
  Vector values_;
  std::vector<int> block_of_;  // of a column
  std::vector<int> position_;  // of an unknown in the factor's order
  Vector inverse_D_;
  int first_ = 0;  // the unknown that the range begins with
  int most_height_ = 0;
};

}  // namespace railtab
