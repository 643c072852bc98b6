#pragma once

#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <span>
#include <vector>

#include "railtab/runtime/base/dof_range.hpp"
#include "railtab/runtime/base/lane_numbers.hpp"

namespace railtab {

/// Where the unknowns of a long structure stand.
struct UnknownPlaces {
  std::vector<double> x;  ///< along the structure, not decreasing [m]; empty: not known
  /// Unknowns of the same number are alike and follow each other along x, such as the vertical displacements of a
  /// rail's nodes; -1: alike to no other.
  std::vector<int> line;
};

/// Pairs of unknowns u, v that take part by (u + v)/√2, in the place of the first, and (u − v)/√2: of both rails, in
/// which a symmetric track falls apart into a vertical and a lateral system.
using MirrorPairs = std::vector<std::array<int, 2>>;
inline constexpr double root_half = 0.70710678118654752440;  ///< √½

/// The eight numbers of every slot in a vector of a SectionLayout, which Eigen aligns to 64 bytes.
[[nodiscard]] inline const Lanes* lanes(const Eigen::VectorXd& vector) noexcept {
  return reinterpret_cast<const Lanes*>(vector.data());  // NOLINT
}
[[nodiscard]] inline Lanes* lanes(Eigen::VectorXd& vector) noexcept {
  return reinterpret_cast<Lanes*>(vector.data());  // NOLINT
}

/// Calls visitor(i, j, value) for the entries of a matrix whose row and column lie in a range.
template <class Visitor>
void visit_entries(const Eigen::SparseMatrix<double>& matrix, const DofRange& range, Visitor&& visitor) {
  for (Eigen::Index j = range.begin; j < range.end(); ++j) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, j); entry; ++entry) {
      if (entry.row() >= range.begin && entry.row() < range.end()) visitor(entry.row(), j, entry.value());
    }
  }
}

/// TᵀAT with the orthogonal T of the pairs, without entries that are zero.
[[nodiscard]] Eigen::SparseMatrix<double> by_sums_and_differences(const Eigen::SparseMatrix<double>& matrix,
                                                                  const MirrorPairs& pairs);

/// A long structure cut across into sections whose unknowns correspond to each other, so that all sections can be
/// eliminated side by side: unknowns of equal number ("slot") have entries with the same slots, where a section lacks
/// an unknown or an entry there is a zero. Unknowns at a cut that both sides act upon are interface unknowns.
///
/// Vectors in this layout hold the slots one after the other, of each the sections side by side; then, in the same way,
/// the border slots, copies of the interface unknowns beside each section; then the interface unknowns themselves.
struct SectionLayout {
  static constexpr int sections = Lanes::count;

  struct Place {
    int section;  ///< -1: an interface unknown
    int number;   ///< slot, or of the interface unknown
  };
  struct Interface {
    int cut;                  ///< between sections cut - 1 and cut
    std::array<int, 2> slot;  ///< border slot in section cut - 1, and in section cut
    int unknown;
  };

  DofRange range;
  int slots = 0, borders = 0;
  std::vector<Place> place;           ///< of the unknowns in the range
  std::vector<Interface> interfaces;  ///< interface unknowns
  std::vector<int> border_of;         ///< of every border slot and section the interface unknown, -1: none
  /// Where an unknown stands in a vector of this layout: by itself, or as the sum and the difference of its pair.
  struct Standing {
    int sum, difference;  ///< sum: itself, difference: -1 without a pair
    int other;            ///< of the pair; -1: there is none
  };
  std::vector<Standing> standing;  ///< of the unknowns in the range
  std::vector<int> unknown;        ///< of every slot and section; -1: none
  /// The other slot of a pair, alike in all sections.
  struct Partner {
    int slot = -1;           ///< -1: there is none
    bool is_second = false;  ///< whether this slot has the second unknown of the pair
    bool operator==(const Partner&) const = default;
  };
  std::vector<Partner> partner;  ///< of every slot
  /// For each block of four slots and each section: the first of their four consecutive unknowns; -1: they are not
  /// consecutive.
  std::vector<int> consecutive;
  /// An unknown in no such column, or of an interface.
  struct Single {
    int entry, unknown;  ///< entry: where it stands in a vector of this layout
  };
  std::vector<Single> single;
  std::vector<std::array<int, 2>> interface_pair;  ///< where interface unknowns that are a pair stand
  /// Where the first entry of such a column, the next ones `sections` further each, stands in a vector of this layout.
  [[nodiscard]] static constexpr std::size_t column_begin(std::size_t column) noexcept {
    return column / sections * 4 * sections + column % sections;
  }

  [[nodiscard]] Eigen::Index border_begin() const noexcept { return Eigen::Index{sections} * slots; }
  [[nodiscard]] Eigen::Index interface_begin() const noexcept {
    return border_begin() + Eigen::Index{sections} * borders;
  }
  [[nodiscard]] Eigen::Index size() const noexcept {  ///< of a vector of this layout
    return interface_begin() + static_cast<Eigen::Index>(interfaces.size());
  }
  [[nodiscard]] bool contains(int u) const noexcept { return u >= range.begin && u < range.end(); }
  /// Of its lists [bytes].
  [[nodiscard]] std::size_t bytes() const noexcept;
  /// Position of an unknown in a vector of this layout.
  [[nodiscard]] Eigen::Index position(Eigen::Index u) const noexcept {
    const Place& p = place[static_cast<std::size_t>(u - range.begin)];
    return p.section < 0 ? interface_begin() + p.number : Eigen::Index{sections} * p.number + p.section;
  }

  /// Sets the slots and the interface unknowns.
  void into(const Eigen::VectorXd& natural, Eigen::VectorXd& ordered) const;
  void out_of(const Eigen::VectorXd& ordered, Eigen::VectorXd& natural) const;
  /// One unknown of a vector in this layout. @pre contains(u)
  [[nodiscard]] double value(const Eigen::VectorXd& ordered, int u) const noexcept {
    const auto [sum, difference, other] = standing[static_cast<std::size_t>(u - range.begin)];
    if (other < 0) return ordered[sum];
    return root_half * (ordered[sum] + (u < other ? ordered[difference] : -ordered[difference]));
  }
  /// Sets it, and leaves the other of its pair as it is. @pre contains(u)
  void set(int u, double value, Eigen::VectorXd& ordered) const noexcept;
  /// Copies interface unknowns to the borders beside the sections.
  void spread_interfaces(Eigen::VectorXd& ordered) const;
  /// Adds what stands at the borders to the interface unknowns.
  void fold_borders(Eigen::VectorXd& ordered) const;

  /// Lower triangles of symmetric matrices of the unknowns in the range, by slots.
  struct Entries {
    struct OfSection {
      int row, section, matrix;  ///< row: a slot, border slots counted on from the others
      double value;
    };
    struct OfInterfaces {
      int row, column, matrix;  ///< of interface unknowns, row >= column
      double value;
    };
    std::vector<int> begin;          ///< of each column, a slot, and the end; every row >= its column
    std::vector<OfSection> section;  ///< by columns, in each by rows
    std::vector<OfInterfaces> interfaces;

    /// Calls visitor(row, entries) for the rows of a column: what its matrices have there in all sections.
    template <class Visitor>
    void visit_rows(int column, Visitor&& visitor) const {
      const auto at = static_cast<std::size_t>(column);
      const auto end = section.begin() + begin[at + 1];
      for (auto first = section.begin() + begin[at]; first != end;) {
        const auto next = std::find_if(first, end, [row = first->row](const OfSection& e) { return e.row != row; });
        visitor(first->row, std::span(first, next));
        first = next;
      }
    }
  };
  /// @param matrices whole pattern, by_sums_and_differences() of the layout's pairs
  [[nodiscard]] Entries entries(std::initializer_list<const Eigen::SparseMatrix<double>*> matrices) const;
};

/// Cuts the unknowns in a range into sections, slots numbered along x. Cuts stand at nodes of the sparsest line that
/// goes all the way, where the sections' nodes coincide best.
/// @param matrix symmetric, whole pattern, by_sums_and_differences() of the pairs
/// @return nothing where an unknown is alike to no other, the structure is short or couples over more than a section,
///         or a division would not pay
[[nodiscard]] std::optional<SectionLayout> divide(const Eigen::SparseMatrix<double>& matrix,
                                                  const UnknownPlaces& places, const MirrorPairs& pairs,
                                                  const DofRange& range);

}  // namespace railtab
