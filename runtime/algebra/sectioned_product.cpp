#include "railtab/runtime/algebra/sectioned_product.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "railtab/runtime/base/index.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Stiffness and damping of an entry where these are the same in all sections that have both unknowns.
std::optional<std::array<double, 2>> common_value(const SectionLayout& l, int row, int column, const Lanes& stiffness,
                                                  const Lanes& damping) {
  constexpr double equal = 1e-12;  // of the same element at another place
  std::optional<std::array<double, 2>> common;
  for (int s = 0; s < SectionLayout::sections; ++s) {
    const auto has = [&](int slot) {
      return slot < l.slots
                 ? l.unknown[static_cast<std::size_t>(SectionLayout::sections * slot + s)] >= 0
                 : l.border_of[static_cast<std::size_t>(SectionLayout::sections * (slot - l.slots) + s)] >= 0;
    };
    if (!has(row) || !has(column)) continue;
    const std::array<double, 2> here{stiffness[s], damping[s]};
    if (!common) common = here;
    for (std::size_t k = 0; k < 2; ++k) {
      if (std::abs(here[k] - (*common)[k]) > equal * std::abs((*common)[k])) return std::nullopt;
    }
  }
  return common;
}

}  // namespace

SectionedProduct::SectionedProduct(const Sparse& stiffness, const Sparse& damping,
                                   std::shared_ptr<const SectionLayout> layout)
    : layout_(std::move(layout)) {
  const SectionLayout& l = *layout_;
  const SectionLayout::Entries entries = l.entries({&stiffness, &damping});
  std::map<std::pair<int, int>, std::array<double, 2>> between;
  for (const auto& e : entries.interfaces) {
    between[{e.row, e.column}][index(e.matrix)] = between[{e.column, e.row}][index(e.matrix)] = e.value;
  }
  for (const auto& [place, value] : between) {
    interface_.push_back({place.first, place.second, value[0], value[1]});
  }
  alike_.begin.assign(1, 0);
  other_.begin.assign(1, 0);
  for (int j = 0; j < l.slots; ++j) {
    entries.visit_rows(j, [&](int row, std::span<const SectionLayout::Entries::OfSection> of_sections) {
      Pair pair;
      for (const SectionLayout::Entries::OfSection& e : of_sections) {
        (e.matrix == 0 ? pair.stiffness : pair.damping)[e.section] = e.value;
      }
      if (const auto common = common_value(l, row, j, pair.stiffness, pair.damping)) {
        alike_.row.push_back(row);
        alike_.value.push_back(*common);
      } else {
        other_.row.push_back(row);
        other_.value.push_back(pair);
      }
    });
    alike_.begin.push_back(static_cast<int>(alike_.row.size()));
    other_.begin.push_back(static_cast<int>(other_.row.size()));
  }
}

void SectionedProduct::subtract(Motion& motion, Eigen::VectorXd& ordered) const {
  const SectionLayout& l = *layout_;
  l.spread_interfaces(motion.u);
  l.spread_interfaces(motion.v);
  const Lanes *const U = lanes(motion.u), *const V = lanes(motion.v);
  Lanes* const y = lanes(ordered);
  for (int j = 0; j < l.slots; ++j) {
    const auto column = static_cast<std::size_t>(j);
    const Lanes u_j = U[j], v_j = V[j];
    Lanes sum{};
    for (int p = alike_.begin[column]; p < alike_.begin[column + 1]; ++p) {
      const auto& [k, c] = alike_.value[static_cast<std::size_t>(p)];
      const int i = alike_.row[static_cast<std::size_t>(p)];
      sum += k * U[i] + c * V[i];
      if (i != j) y[i] -= k * u_j + c * v_j;
    }
    for (int p = other_.begin[column]; p < other_.begin[column + 1]; ++p) {
      const Pair& e = other_.value[static_cast<std::size_t>(p)];
      const int i = other_.row[static_cast<std::size_t>(p)];
      sum += e.stiffness * U[i] + e.damping * V[i];
      if (i != j) y[i] -= e.stiffness * u_j + e.damping * v_j;
    }
    y[j] -= sum;
  }
  const Eigen::Index first = l.interface_begin();
  for (const InterfaceEntry& e : interface_) {
    ordered[first + e.row] -= e.stiffness * motion.u[first + e.column] + e.damping * motion.v[first + e.column];
  }
}

std::size_t SectionedProduct::bytes() const noexcept {
  return alike_.value.size() * 2 * sizeof(double) + other_.value.size() * sizeof(Pair) +
         (alike_.row.size() + alike_.begin.size() + other_.row.size() + other_.begin.size()) * sizeof(int) +
         interface_.size() * sizeof(InterfaceEntry);
}

}  // namespace railtab
