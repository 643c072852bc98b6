#include "railtab/fmi/driven_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/printable_text.hpp"
#include "railtab/runtime/base/version.hpp"

namespace railtab::fmi {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are stored as they are in memory");

std::string mark() { return fmt::format("railtab track {}\n", version()); }

class Writer {
 public:
  explicit Writer(std::string& bytes) : bytes_(bytes) {}
  template <class Number>
  void values(Number* data, std::size_t count) {
    bytes_.append(reinterpret_cast<const char*>(data), count * sizeof(Number));
  }
  template <class List>
  void size(List& list) {
    std::uint64_t count = list.size();
    values(&count, 1);
  }

 private:
  std::string& bytes_;
};

class Reader {
 public:
  Reader(std::string_view bytes, std::string_view place) : bytes_(bytes), place_(place) {}
  template <class Number>
  void values(Number* data, std::size_t count) {
    require(count, sizeof(Number));
    if (count > 0) std::memcpy(data, bytes_.data(), count * sizeof(Number));
    bytes_.remove_prefix(count * sizeof(Number));
  }
  /// @throws InputError where so many entries of `bytes` each are more than what is left
  void require(std::uint64_t count, std::size_t bytes) const {
    if (count > bytes_.size() / bytes) fail();
  }
  /// Every entry of a list takes a byte or more.
  template <class List>
  void size(List& list) {
    std::uint64_t count = 0;
    values(&count, 1);
    require(count, 1);
    list.resize(count);
  }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }
  [[noreturn]] void fail() const {
    throw input_error(place_, "a file that has been changed", "resources/track as vsi fmu writes it");
  }

 private:
  std::string_view bytes_, place_;
};

template <class Archive, class Number>
void exchange_list(Archive& archive, std::vector<Number>& list) {
  archive.size(list);
  archive.values(list.data(), list.size());
}

template <class Archive>
void exchange_text(Archive& archive, std::string& text) {
  archive.size(text);
  archive.values(text.data(), text.size());
}

// By columns, or by rows.
template <class Matrix>
void exchange_matrix(Writer& archive, Matrix& matrix) {
  matrix.makeCompressed();
  std::int64_t extent[3] = {matrix.rows(), matrix.cols(), matrix.nonZeros()};
  archive.values(extent, 3);
  archive.values(matrix.outerIndexPtr(), static_cast<std::size_t>(matrix.outerSize() + 1));
  archive.values(matrix.innerIndexPtr(), static_cast<std::size_t>(matrix.nonZeros()));
  archive.values(matrix.valuePtr(), static_cast<std::size_t>(matrix.nonZeros()));
}

// Whether rows increase within every column; or columns within every row.
bool are_columns(const std::vector<int>& begin, const std::vector<int>& row, std::int64_t rows) {
  if (begin.front() != 0 || begin.back() != static_cast<int>(row.size())) return false;
  for (std::size_t j = 0; j + 1 < begin.size(); ++j) {
    if (begin[j + 1] < begin[j]) return false;
  }
  for (std::size_t j = 0; j + 1 < begin.size(); ++j) {
    int before = -1;
    for (auto p = static_cast<std::size_t>(begin[j]); p < static_cast<std::size_t>(begin[j + 1]); ++p) {
      if (row[p] <= before || row[p] >= rows) return false;
      before = row[p];
    }
  }
  return true;
}

template <class Matrix>
void exchange_matrix(Reader& archive, Matrix& matrix) {
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  std::int64_t extent[3] = {};
  archive.values(extent, 3);
  const auto [rows, columns, nonzeros] = extent;
  if (rows < 0 || columns < 0 || nonzeros < 0 || rows > most || columns > most) archive.fail();
  const std::int64_t lists = Matrix::IsRowMajor ? rows : columns;
  archive.require(static_cast<std::uint64_t>(lists) + 1, sizeof(int));
  archive.require(static_cast<std::uint64_t>(nonzeros), sizeof(double));
  std::vector<int> begin(static_cast<std::size_t>(lists + 1)), row(static_cast<std::size_t>(nonzeros));
  std::vector<double> value(static_cast<std::size_t>(nonzeros));
  archive.values(begin.data(), begin.size());
  archive.values(row.data(), row.size());
  archive.values(value.data(), value.size());
  if (!are_columns(begin, row, Matrix::IsRowMajor ? columns : rows)) archive.fail();
  matrix = Eigen::Map<const Matrix>(rows, columns, nonzeros, begin.data(), row.data(), value.data());
}

// All members in their order, into or out of an archive.
template <class Archive>
void exchange(Archive& archive, DrivenTrack& track) {
  exchange_text(archive, track.name);
  archive.values(&track.scheme.alpha, 1);
  archive.values(&track.scheme.time_step, 1);
  exchange_list(archive, track.wheelset_x);
  StructureModel& structure = track.structure;
  for (auto* matrix : {&structure.mass, &structure.damping, &structure.stiffness}) exchange_matrix(archive, *matrix);
  for (RailLine& rail : structure.rail) {
    exchange_list(archive, rail.x);
    exchange_list(archive, rail.dof);
    archive.values(&rail.head_height, 1);
    RailStiffness& of = rail.stiffness;
    for (double* stiffness : {&of.EIy, &of.EIz, &of.GJ, &of.warping_length}) archive.values(stiffness, 1);
    exchange_list(archive, rail.twist_rate);
  }
  archive.size(structure.nodes);
  for (StructureNode& node : structure.nodes) {
    exchange_text(archive, node.name);
    archive.values(&node.x, 1);
    archive.values(node.dof.data(), node.dof.size());
  }
  exchange_matrix(archive, structure.summed_nodes);
  exchange_list(archive, structure.dof_x);
  exchange_list(archive, structure.dof_line);
  exchange_list(archive, structure.dof_node);
}

bool are_dofs(std::span<const int> dofs, int count) {
  for (int dof : dofs) {
    if (dof != held && (dof < 0 || dof >= count)) return false;
  }
  return true;
}

bool are_nodes(const std::vector<int>& nodes, int count) {
  if (nodes.empty()) return true;
  return nodes.size() == static_cast<std::size_t>(count) &&
         std::all_of(nodes.begin(), nodes.end(), [=](int node) { return node >= 0 && node < count; });
}

bool increases(const std::vector<double>& x) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || (i > 0 && x[i] <= x[i - 1])) return false;
  }
  return true;
}

// Stiffness and twist rates are known both, or neither.
bool is_known_or_not(const RailLine& rail) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  const RailStiffness& of = rail.stiffness;
  if (of == RailStiffness{}) return rail.twist_rate.empty();
  return positive(of.EIy) && positive(of.EIz) && positive(of.GJ) && positive(of.warping_length) &&
         rail.twist_rate.size() == rail.x.size();
}

// Whether indices and counts of what was read fit each other, and it can be stepped.
bool is_consistent(const DrivenTrack& track) {
  const StructureModel& s = track.structure;
  const int n = s.dofs();
  constexpr double smallest_alpha = -1.0 / 3.0;
  const auto square = [n](const Eigen::SparseMatrix<double>& m) { return m.rows() == n && m.cols() == n; };
  const auto& sums = s.summed_nodes;
  const bool summed =
      sums.size() == 0 || (sums.rows() == static_cast<Eigen::Index>(6 * s.nodes.size()) && sums.cols() == n);
  bool fits = n > 0 && square(s.mass) && square(s.damping) && square(s.stiffness) && summed &&
              !track.wheelset_x.empty() && (s.dof_x.empty() || s.dof_x.size() == static_cast<std::size_t>(n)) &&
              s.dof_line.size() == s.dof_x.size() && are_nodes(s.dof_node, n) && track.scheme.time_step > 0.0 &&
              track.scheme.alpha >= smallest_alpha && track.scheme.alpha <= 0.0;
  for (const RailLine& rail : s.rail) {
    fits = fits && is_known_or_not(rail) && are_dofs(rail.twist_rate, n);
    fits = fits && rail.x.size() >= 2 && rail.dof.size() == rail.x.size() && increases(rail.x);
    for (const DofIndices& dofs : rail.dof) fits = fits && are_dofs(dofs, n);
  }
  for (const StructureNode& node : s.nodes) fits = fits && are_dofs(node.dof, n);
  return fits;
}

}  // namespace

std::string track_bytes(const DrivenTrack& track) {
  std::string bytes = mark();
  Writer writer(bytes);
  DrivenTrack written = track;  // exchange() is of both directions
  exchange(writer, written);
  return bytes;
}

DrivenTrack track_of_bytes(std::string_view bytes, std::string_view place) {
  const std::string expected = mark();
  if (!bytes.starts_with(expected)) {
    throw input_error(place, printable(bytes.substr(0, bytes.find('\n')), 60), expected.substr(0, expected.size() - 1));
  }
  Reader reader(bytes.substr(expected.size()), place);
  DrivenTrack track;
  exchange(reader, track);
  if (!reader.at_end() || !is_consistent(track)) reader.fail();
  return track;
}

std::string track_guid(std::string_view bytes) {
  const auto all = std::as_bytes(std::span(bytes));
  const std::uint64_t first = word_checksum(all);
  return fmt::format("{:016x}{:016x}", first, word_checksum(all, first ^ bytes.size()));
}

}  // namespace railtab::fmi
