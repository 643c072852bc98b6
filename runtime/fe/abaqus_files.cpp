#include "railtab/runtime/fe/abaqus_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/fe/fe_matrix.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr const char* kind = "a matrix by *MATRIX OUTPUT of Abaqus (.mtx)";
constexpr double held_stiffness = 1e36;  // Abaqus's, on the diagonal of what a boundary condition holds
constexpr long nodes_apart = 1000;       // in a label, more than a node has degrees of freedom

/// A line: the names of row and column, and the value.
struct Entry {
  long row = 0, column = 0;
  double value = 0.0;
};

/// Name of a node's degree of freedom; Abaqus's own nodes (node < 0) may have more than six.
long label(const LineReader& reader, std::string_view node_word, std::string_view dof_word) {
  const int node = reader.number<int>(node_word, "the number of a node");
  const int dof = reader.number<int>(dof_word, "a degree of freedom");
  const long most = node < 0 ? nodes_apart - 1 : 6;
  if (node == 0 || dof < 1 || dof > most) {
    throw reader.error(fmt::format("node {}, degree of freedom {}", node, dof),
                       "1 to 6 of a node of the mesh: a structure has no other motions");
  }
  return node * nodes_apart + dof;
}

long node_of(long name) { return (name - (name % nodes_apart + nodes_apart) % nodes_apart) / nodes_apart; }

class EntryReader {
 public:
  EntryReader(const std::filesystem::path& file, bool numbered) : reader_(file, kind), numbered_(numbered) {}

  bool next(Entry& entry) {
    while (reader_.next()) {
      const std::string_view line = stripped(reader_.line());
      if (line.empty() || line.starts_with("**")) continue;
      std::array<std::string_view, 5> words;
      const std::size_t count = split(line, words, ",");
      if (count != (numbered_ ? 3U : 5U)) {
        throw reader_.error(fmt::format("'{}'", line.substr(0, 80)),
                            numbered_ ? "row, column, value of FORMAT=COORDINATE; for MATRIX INPUT no structure.dofs"
                                      : "node, degree of freedom, node, degree of freedom, value of FORMAT=MATRIX "
                                        "INPUT; for COORDINATE structure.dofs");
      }
      if (numbered_) {
        entry.row = reader_.number<int>(words[0], "a row number");
        entry.column = reader_.number<int>(words[1], "a column number");
      } else {
        entry.row = label(reader_, words[0], words[1]);
        entry.column = label(reader_, words[2], words[3]);
      }
      entry.value = reader_.number<double>(words[count - 1], "a finite number");
      any_ = true;
      return true;
    }
    if (!any_) throw reader_.file_error("no entry", kind);
    return false;
  }
  [[nodiscard]] const LineReader& reader() const noexcept { return reader_; }

 private:
  LineReader reader_;
  bool numbered_, any_ = false;
};

/// Free and held rows, as the lines of the stiffness name them.
AbaqusRows named_rows(const std::filesystem::path& stiffness) {
  AbaqusRows result;
  std::unordered_map<long, long> line_of;  // of the first mention
  EntryReader entries(stiffness, false);
  for (Entry entry; entries.next(entry);) {
    for (const long name : {entry.row, entry.column}) line_of.emplace(name, entries.reader().line_number());
    if (entry.row == entry.column && entry.value >= held_stiffness) result.place[entry.row] = -1;
  }
  using NamedRow = std::pair<long, FeRow>;
  std::vector<NamedRow> free;
  for (const auto& [name, line] : line_of) {
    if (result.place.contains(name)) continue;
    FeRow row;
    row.node = static_cast<int>(node_of(name));
    row.motion = static_cast<int>((name - node_of(name) * nodes_apart - 1) % 6);
    row.line = line;
    free.emplace_back(name, row);
  }
  const auto order = [](const NamedRow& row) {
    return std::tuple(row.second.node < 0, std::abs(row.second.node), row.first);
  };
  std::sort(free.begin(), free.end(), [&](const auto& a, const auto& b) { return order(a) < order(b); });
  for (const auto& [name, row] : free) {
    result.place[name] = static_cast<int>(result.rows.size());
    result.rows.push_back(row);
  }
  return result;
}

/// Those of a table, but for the held ones.
AbaqusRows numbered_rows(const std::filesystem::path& stiffness, const std::filesystem::path& dofs) {
  AbaqusRows result;
  result.numbered = true;
  const std::vector<FeRow> all = read_row_table(dofs);
  EntryReader entries(stiffness, true);
  for (Entry entry; entries.next(entry);) {
    if (entry.row == entry.column && entry.value >= held_stiffness) result.place[entry.row] = -1;
  }
  for (std::size_t r = 0; r < all.size(); ++r) {
    const bool held = !result.place.emplace(static_cast<long>(r) + 1, static_cast<int>(result.rows.size())).second;
    if (!held) result.rows.push_back(all[r]);
  }
  return result;
}

/// Both triangles of a matrix of which one is stored; entries on both sides of the diagonal must agree.
Sparse with_both_triangles(const std::filesystem::path& file, const Sparse& stored) {
  const Sparse transposed = stored.transpose();
  for (int column = 0; column < stored.outerSize(); ++column) {
    Sparse::InnerIterator mirrored(transposed, column);
    for (Sparse::InnerIterator entry(stored, column); entry; ++entry) {
      while (mirrored && mirrored.row() < entry.row()) ++mirrored;
      const bool both = mirrored && mirrored.row() == entry.row() && entry.row() != column;
      if (both) return symmetric_mean(file, stored, stored.rows());
    }
  }
  Sparse other = transposed;
  other.prune([](Eigen::Index row, Eigen::Index column, double) { return row != column; });
  return stored + other;
}

}  // namespace

AbaqusRows read_abaqus_rows(const std::filesystem::path& stiffness, const std::filesystem::path& dofs) {
  AbaqusRows result = dofs.empty() ? named_rows(stiffness) : numbered_rows(stiffness, dofs);
  if (result.rows.empty())
    throw input_error(stiffness.string(), "no free row", "rows that no boundary condition holds");
  return result;
}

Sparse read_abaqus_matrix(const std::filesystem::path& file, const AbaqusRows& rows) {
  EntryReader entries(file, rows.numbered);
  const auto place = [&](long name) {
    const auto found = rows.place.find(name);
    if (found != rows.place.end()) return found->second;
    const long node = node_of(name);
    throw entries.reader().error(rows.numbered
                                     ? fmt::format("row {}", name)
                                     : fmt::format("node {}, degree of freedom {}", node, name - node * nodes_apart),
                                 rows.numbered ? "a row of structure.dofs" : "a row of the stiffness");
  };
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(static_cast<std::size_t>(entries.reader().file_bytes() / 30));  // "1,1, 1,1,  1.000000000000000e+00"
  for (Entry entry; entries.next(entry);) {
    const int i = place(entry.row), j = place(entry.column);
    if (i >= 0 && j >= 0 && entry.value != 0.0) triplets.emplace_back(i, j, entry.value);
  }
  const auto n = static_cast<Eigen::Index>(rows.rows.size());
  Sparse stored(n, n);
  stored.setFromTriplets(triplets.begin(), triplets.end());
  return with_both_triangles(file, stored);
}

}  // namespace railtab
