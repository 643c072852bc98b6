#include "railtab/tables/geometry_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "railtab/tables/input_error.hpp"

namespace railtab {

namespace {

constexpr int quantities = 6;  // z, z', s_w, s_w', s_r, s_r'

std::size_t nodes_in(const GeometryBranch& b) {
  return static_cast<std::size_t>(b.size[0]) * static_cast<std::size_t>(b.size[1]) *
         static_cast<std::size_t>(b.size[2]);
}

std::array<const std::vector<double>*, quantities> columns(const GeometryBranch& b) {
  return {&b.z_touch, &b.z_touch_dy, &b.s_wheel, &b.s_wheel_dy, &b.s_rail, &b.s_rail_dy};
}

/// Box inside the grid, arrays of the box's size, and each node either wholly finite or wholly NaN.
void check_branch(const GeometryBranch& b, std::size_t number, const std::array<int, 3>& grid) {
  const std::string place = fmt::format("branch {}", number);
  for (int a = 0; a < 3; ++a) {
    if (b.first[a] < 0 || b.size[a] < 1 || b.first[a] + b.size[a] > grid[a]) {
      throw input_error(place, fmt::format("nodes {}..{} along axis {}", b.first[a], b.first[a] + b.size[a] - 1, a),
                        fmt::format("nodes in 0..{}", grid[a] - 1));
    }
  }
  const auto column = columns(b);
  for (const std::vector<double>* values : column) {
    if (values->size() != nodes_in(b)) {
      throw input_error(place, fmt::format("an array of {} values", values->size()),
                        fmt::format("{}, one per node of its box", nodes_in(b)));
    }
  }
  for (std::size_t n = 0; n < nodes_in(b); ++n) {
    const bool exists = !std::isnan(b.z_touch[n]);
    for (const std::vector<double>* values : column) {
      if (exists ? !std::isfinite((*values)[n]) : !std::isnan((*values)[n])) {
        throw input_error(fmt::format("{}, node {}", place, n), fmt::format("{}", (*values)[n]),
                          exists ? "a finite number" : "NaN, as in its z_touch");
      }
    }
  }
}

/// In the order of their cells, each a stretch, no two of a cell in touch.
void check_windows(const GeometryTableData& data) {
  if (!(data.searched_lowering >= 0 && std::isfinite(data.searched_lowering))) {
    throw input_error("searched_lowering", fmt::format("{}", data.searched_lowering), "a height");
  }
  for (std::size_t n = 0; n < data.windows.size(); ++n) {
    const SearchWindow& w = data.windows[n];
    const std::string place = fmt::format("search window {}", n);
    if (w.cell < 0 || w.cell >= static_cast<std::int64_t>(data.trusted_lowering.size())) {
      throw input_error(place, fmt::format("cell {}", w.cell),
                        fmt::format("a cell in 0..{}", data.trusted_lowering.size() - 1));
    }
    if (!(std::isfinite(w.s_low) && std::isfinite(w.s_high) && w.s_low < w.s_high)) {
      throw input_error(place, fmt::format("s from {} to {}", w.s_low, w.s_high), "a stretch of the wheel profile");
    }
    if (n == 0) continue;
    const SearchWindow& before = data.windows[n - 1];
    if (w.cell < before.cell || (w.cell == before.cell && w.s_low <= before.s_high)) {
      throw input_error(
          place, fmt::format("cell {}, s from {} after cell {}, s to {}", w.cell, w.s_low, before.cell, before.s_high),
          "windows in the order of their cells, apart from each other");
    }
  }
}

/// Slope at x[i] of the parabola through the node and its existing neighbours: two to the sides, else the two next on
/// the existing side, else the straight line, else 0. `value(k)` is NaN where there is none; n nodes.
template <typename Value>
double finite_difference_slope(const std::vector<double>& x, int x_first, int n, int i, const Value& value) {
  const auto exists = [&](int k) { return k >= 0 && k < n && !std::isnan(value(k)); };
  const auto chord = [&](int a, int b) { return (value(b) - value(a)) / (x[x_first + b] - x[x_first + a]); };
  const bool left = exists(i - 1);
  const bool right = exists(i + 1);
  if (!left && !right) return 0.0;
  int a = i - 1;
  int b = i + 1;
  if (!left) {
    if (!exists(i + 2)) return chord(i, i + 1);
    a = i + 2;
  } else if (!right) {
    if (!exists(i - 2)) return chord(i - 1, i);
    b = i - 2;
  }
  // Newton's divided differences of the parabola through i, a, b, differentiated at i.
  const double first = chord(i, a);
  const double second = (chord(i, b) - first) / (x[x_first + b] - x[x_first + a]);
  return first + second * (x[x_first + i] - x[x_first + a]);
}

}  // namespace

GeometryTable::GeometryTable(GeometryTableData data)
    : data_(std::move(data)),
      lateral_("lateral", data_.lateral),
      yaw_squared_("yaw squared", data_.yaw_squared),
      roll_("roll", data_.roll) {
  const std::size_t cells = static_cast<std::size_t>(lateral_.cells()) *
                            static_cast<std::size_t>(yaw_squared_.cells()) * static_cast<std::size_t>(roll_.cells());
  if (lateral_.size() < 2) throw input_error("axis lateral", "1 node", "at least 2");
  if (yaw_squared_.nodes().front() < 0) throw input_error("axis yaw squared", "a negative node", "squares");
  if (data_.trusted_lowering.size() != cells) {
    throw input_error("trusted_lowering", fmt::format("{} values", data_.trusted_lowering.size()),
                      fmt::format("{}, one per cell", cells));
  }
  for (std::size_t c = 0; c < cells; ++c) {
    if (!(data_.trusted_lowering[c] >= 0)) {
      throw input_error(fmt::format("trusted_lowering, cell {}", c), fmt::format("{}", data_.trusted_lowering[c]),
                        "a height or infinity");
    }
  }
  const std::array<int, 3> grid{lateral_.size(), yaw_squared_.size(), roll_.size()};
  for (std::size_t n = 0; n < data_.branches.size(); ++n) check_branch(data_.branches[n], n, grid);
  check_windows(data_);
  pack_branches();
  index_cells();
  index_windows();
}

/// Puts the six quantities of a node side by side, together with their slopes across yaw² and roll.
void GeometryTable::pack_branches() {
  const bool yaw_axis = yaw_squared_.size() > 1;
  const bool roll_axis = roll_.size() > 1;
  slopes_ = (yaw_axis ? 2 : 1) * (roll_axis ? 2 : 1);
  const std::size_t width = static_cast<std::size_t>(quantities * slopes_);
  for (const GeometryBranch& b : data_.branches) {
    const std::size_t start = packed_.size();
    branch_offset_.push_back(start);
    packed_.resize(start + nodes_in(b) * width);
    const auto column = columns(b);
    const auto at = [&](int i, int j, int k, int combination, int q) -> double& {
      const std::size_t node = static_cast<std::size_t>((k * b.size[1] + j) * b.size[0] + i);
      return packed_[start + node * width + static_cast<std::size_t>(combination * quantities + q)];
    };
    const auto for_each = [&](const auto& action) {
      for (int k = 0; k < b.size[2]; ++k)
        for (int j = 0; j < b.size[1]; ++j)
          for (int i = 0; i < b.size[0]; ++i)
            for (int q = 0; q < quantities; ++q) action(i, j, k, q);
    };
    for_each([&](int i, int j, int k, int q) {
      at(i, j, k, 0, q) =
          (*column[static_cast<std::size_t>(q)])[static_cast<std::size_t>((k * b.size[1] + j) * b.size[0] + i)];
    });
    if (yaw_axis) {
      for_each([&](int i, int j, int k, int q) {
        at(i, j, k, 1, q) = finite_difference_slope(yaw_squared_.nodes(), b.first[1], b.size[1], j,
                                                    [&](int m) { return at(i, m, k, 0, q); });
      });
    }
    if (roll_axis) {
      const int source_combinations = yaw_axis ? 2 : 1;
      for (int c = 0; c < source_combinations; ++c) {
        for_each([&](int i, int j, int k, int q) {
          // The value tells whether the node exists; its yaw slope is 0, not NaN, where the branch is one node wide.
          at(i, j, k, source_combinations + c, q) =
              finite_difference_slope(roll_.nodes(), b.first[2], b.size[2], k, [&](int m) {
                return std::isnan(at(i, j, m, 0, q)) ? std::numeric_limits<double>::quiet_NaN() : at(i, j, m, c, q);
              });
        });
      }
    }
  }
}

namespace {

/// Corner nodes of a cell of a grid with these sizes: offset bits along lateral, yaw², roll where the axis has cells.
std::vector<std::array<int, 3>> cell_corners(const std::array<int, 3>& grid) {
  std::vector<std::array<int, 3>> corners;
  for (int k = 0; k < (grid[2] > 1 ? 2 : 1); ++k)
    for (int j = 0; j < (grid[1] > 1 ? 2 : 1); ++j)
      for (int i = 0; i < 2; ++i) corners.push_back({i, j, k});
  return corners;
}

/// z_touch of a branch at a node of the grid; NaN where the branch does not exist.
double touch_at(const GeometryBranch& b, int i, int j, int k) {
  const std::array<int, 3> n{i - b.first[0], j - b.first[1], k - b.first[2]};
  for (std::size_t a = 0; a < 3; ++a) {
    if (n[a] < 0 || n[a] >= b.size[a]) return std::numeric_limits<double>::quiet_NaN();
  }
  return b.z_touch[static_cast<std::size_t>((n[2] * b.size[1] + n[1]) * b.size[0] + n[0])];
}

struct CornerCount {
  int present = 0;
  double lowest = std::numeric_limits<double>::infinity();  ///< z_touch [m]
};

CornerCount count_corners(const GeometryBranch& b, const std::vector<std::array<int, 3>>& corners, int i, int j,
                          int k) {
  CornerCount count;
  for (const std::array<int, 3>& corner : corners) {
    const double z = touch_at(b, i + corner[0], j + corner[1], k + corner[2]);
    if (std::isnan(z)) continue;
    ++count.present;
    count.lowest = std::min(count.lowest, z);
  }
  return count;
}

}  // namespace

/// Lists, cell by cell, the branches that exist at all corners.
void GeometryTable::index_cells() {
  const std::array<int, 3> grid{lateral_.size(), yaw_squared_.size(), roll_.size()};
  const std::array<int, 3> cells{lateral_.cells(), yaw_squared_.cells(), roll_.cells()};
  const std::vector<std::array<int, 3>> corners = cell_corners(grid);
  const std::size_t width = static_cast<std::size_t>(quantities * slopes_);
  struct Found {
    BranchCell cell;
    double lowest;
  };
  std::vector<std::vector<Found>> found(data_.trusted_lowering.size());
  for (std::size_t n = 0; n < data_.branches.size(); ++n) {
    const GeometryBranch& b = data_.branches[n];
    const std::size_t row = static_cast<std::size_t>(b.size[0]) * width;
    const auto first_cell = [&](std::size_t a) { return std::max(0, b.first[a] - 1); };
    const auto end_cell = [&](std::size_t a) { return std::min(cells[a], b.first[a] + b.size[a]); };
    for (int k = first_cell(2); k < end_cell(2); ++k)
      for (int j = first_cell(1); j < end_cell(1); ++j)
        for (int i = first_cell(0); i < end_cell(0); ++i) {
          const CornerCount count = count_corners(b, corners, i, j, k);
          const std::size_t c = static_cast<std::size_t>((k * cells[1] + j) * cells[0] + i);
          if (count.present == static_cast<int>(corners.size())) {
            const std::size_t node =
                static_cast<std::size_t>(((k - b.first[2]) * b.size[1] + j - b.first[1]) * b.size[0] + i - b.first[0]);
            found[c].push_back({{branch_offset_[n] + node * width, static_cast<std::uint32_t>(row),
                                 static_cast<std::uint32_t>(row * static_cast<std::size_t>(b.size[1]))},
                                count.lowest});
          } else if (count.present > 0 && std::isinf(data_.trusted_lowering[c])) {
            throw input_error(fmt::format("cell ({}, {}, {})", i, j, k),
                              fmt::format("branch {} at {} corners and no limit of trust", n, count.present),
                              "a finite trusted_lowering");
          }
        }
  }
  cell_.reserve(found.size());
  for (std::size_t c = 0; c < found.size(); ++c) {
    std::sort(found[c].begin(), found[c].end(), [](const Found& a, const Found& b) { return a.lowest < b.lowest; });
    double trusted = data_.trusted_lowering[c];
    const bool overflow = found[c].size() > max_branches;
    if (overflow) {
      // Which of the branches left out comes first is known at the corners only, so the cell is not trusted at all.
      trusted = 0.0;
      found[c].resize(max_branches);
    }
    cell_.push_back({static_cast<std::uint32_t>(cell_branch_.size()), static_cast<std::uint32_t>(found[c].size()), 0, 0,
                     overflow, trusted});
    for (const Found& f : found[c]) cell_branch_.push_back(f.cell);
  }
}

/// A cell whose branches are cut off at max_branches keeps no window: only the whole search can answer there.
void GeometryTable::index_windows() {
  for (std::size_t n = 0; n < data_.windows.size(); ++n) {
    CellEntry& entry = cell_[static_cast<std::size_t>(data_.windows[n].cell)];
    if (entry.overflow) continue;
    if (entry.windows == 0) entry.first_window = static_cast<std::uint32_t>(n);
    ++entry.windows;
  }
}

namespace {

/// Cubic Hermite weights on a cell: of the values (w0, w1) and of the slopes times 1 (d0, d1), and for d/dx.
struct Hermite {
  double w0, d0, w1, d1;
};

Hermite hermite(double t, double width) noexcept {
  const double t2 = t * t;
  const double t3 = t2 * t;
  return {2 * t3 - 3 * t2 + 1, width * (t3 - 2 * t2 + t), 3 * t2 - 2 * t3, width * (t3 - t2)};
}

Hermite hermite_derivative(double t, double width) noexcept {
  const double t2 = t * t;
  return {6 * (t2 - t) / width, 3 * t2 - 4 * t + 1, 6 * (t - t2) / width, 3 * t2 - 2 * t};
}

}  // namespace

GeometryTable::Lookup GeometryTable::lookup(double y, double yaw, double roll) const noexcept {
  Lookup result;
  const GridAxis::Cell lateral = lateral_.locate(y - data_.nominal_radius * roll);
  const GridAxis::Cell roll_cell = roll_.locate(roll);
  GridAxis::Cell yaw_cell = yaw_squared_.locate(yaw * yaw);
  // On a single node it is the yaw, not its square, that has to agree.
  if (yaw_squared_.size() == 1) {
    yaw_cell.inside = std::abs(std::abs(yaw) - std::sqrt(yaw_squared_.nodes().front())) <= 1e-12;
  }
  if (!lateral.inside || !yaw_cell.inside || !roll_cell.inside) return result;
  result.status = Status::inside;

  const CellEntry& entry = cell_[static_cast<std::size_t>(
      (roll_cell.index * yaw_squared_.cells() + yaw_cell.index) * lateral_.cells() + lateral.index)];
  result.trusted_lowering = entry.trusted_lowering;
  result.count = static_cast<int>(entry.count);
  result.windows = std::span(data_.windows).subspan(entry.first_window, entry.windows);

  // Weights of the corners and derivative combinations across yaw² and roll, in the order of the packed values.
  const bool yaw_axis = yaw_squared_.size() > 1;
  const bool roll_axis = roll_.size() > 1;
  const Hermite across_yaw = yaw_axis ? hermite(yaw_cell.fraction, yaw_cell.width) : Hermite{1, 0, 0, 0};
  const Hermite across_roll = roll_axis ? hermite(roll_cell.fraction, roll_cell.width) : Hermite{1, 0, 0, 0};
  const std::array<std::array<double, 2>, 2> yaw_weight{
      {{across_yaw.w0, across_yaw.d0}, {across_yaw.w1, across_yaw.d1}}};
  const std::array<std::array<double, 2>, 2> roll_weight{
      {{across_roll.w0, across_roll.d0}, {across_roll.w1, across_roll.d1}}};
  const int yaw_corners = yaw_axis ? 2 : 1;
  const int roll_corners = roll_axis ? 2 : 1;
  const Hermite value = hermite(lateral.fraction, lateral.width);
  const Hermite slope = hermite_derivative(lateral.fraction, lateral.width);
  const std::size_t width = static_cast<std::size_t>(quantities * slopes_);

  for (int n = 0; n < result.count; ++n) {
    const BranchCell& cell = cell_branch_[entry.first + static_cast<std::uint32_t>(n)];
    std::array<double, 2 * quantities> sum{};
    for (int k = 0; k < roll_corners; ++k) {
      for (int j = 0; j < yaw_corners; ++j) {
        const double* left = packed_.data() + cell.offset + static_cast<std::size_t>(j) * cell.yaw_stride +
                             static_cast<std::size_t>(k) * cell.roll_stride;
        const double* right = left + width;
        for (int c = 0; c < slopes_; ++c) {
          const double weight = yaw_weight[static_cast<std::size_t>(j)][static_cast<std::size_t>(c % yaw_corners)] *
                                roll_weight[static_cast<std::size_t>(k)][static_cast<std::size_t>(c / yaw_corners)];
          for (std::size_t q = 0; q < quantities; ++q) {
            sum[q] += weight * left[static_cast<std::size_t>(c) * quantities + q];
            sum[quantities + q] += weight * right[static_cast<std::size_t>(c) * quantities + q];
          }
        }
      }
    }
    const auto along = [&](const Hermite& h, std::size_t q) {
      return h.w0 * sum[q] + h.d0 * sum[q + 1] + h.w1 * sum[quantities + q] + h.d1 * sum[quantities + q + 1];
    };
    result.branch[static_cast<std::size_t>(n)] = {along(value, 0), along(slope, 0), along(value, 2),
                                                  along(slope, 2), along(value, 4), along(slope, 4)};
  }
  return result;
}

std::size_t GeometryTable::bytes() const noexcept {
  return packed_.size() * sizeof(double) + cell_.size() * sizeof(CellEntry) + cell_branch_.size() * sizeof(BranchCell);
}

}  // namespace railtab
