#include "railtab/tablegen/loaded_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>
#include <optional>
#include <set>
#include <tuple>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/parallel_failure.hpp"

namespace railtab {

void LoadedSweepOptions::validate() const {
  const auto require = [](bool holds, const char* name, double found, const char* expected) {
    if (!holds) throw input_error(name, fmt::format("{}", found), expected);
  };
  require(lateral.low >= -0.1 && lateral.high <= 0.1, "--lateral", lateral.low, "within -0.1..0.1 m");
  require(lateral.low < lateral.high, "--lateral", lateral.high, "more than the lower end");
  require(roll.low >= -0.1 && roll.high <= 0.1 && roll.low < roll.high, "--roll", roll.low,
          "LO:HI within +-0.1 rad, LO below HI: moments are derivatives with respect to roll");
  const double farthest = std::max(std::abs(lateral.low), std::abs(lateral.high));
  const double largest_roll = std::max(std::abs(roll.low), std::abs(roll.high)) + climb * farthest;
  require(climb >= 0.0 && climb <= largest_climb && largest_roll <= 0.1, "--climb", climb,
          "0..2 rad/m, and |roll| + climb * |shift| at most 0.1 rad");
  require(yaw >= 0.0 && yaw <= 0.2, "--yaw", yaw, "0..0.2 rad");
  require(largest_load >= 1e3 && largest_load <= 1e7, "--largest-load", largest_load, "1e3..1e7 N");
  require(levels >= 5 && levels <= 1000, "--levels", levels, "5..1000");
  require(roll_spacing >= 1e-5 && roll_spacing <= 0.1, "--roll-spacing", roll_spacing, "1e-5..0.1 rad");
  require(yaw_nodes >= 2 && yaw_nodes <= static_cast<int>(LoadedTable::most_yaws), "--yaw-nodes", yaw_nodes, "2..9");
  require(force_error >= 1e-5 && force_error <= 0.1, "--force-error", force_error, "1e-5..0.1");
  require(light_error >= 1e-5 && light_error <= 0.1, "--light-error", light_error, "1e-5..0.1");
  require(least_interval >= 1e-8 && least_interval <= 1e-3, "loaded table: least interval", least_interval,
          "1e-8..1e-3 m");
  contact.validate();
}

namespace {

/// Equal distances, at most `spacing`, each divided into `parts`.
std::vector<double> roll_nodes(const Interval& roll, double spacing, int parts) {
  constexpr double rounding = 1e-9;
  const int intervals = parts * std::max(2, static_cast<int>(std::ceil((roll.high - roll.low) / spacing - rounding)));
  std::vector<double> nodes;
  for (int i = 0; i <= intervals; ++i) {
    const double share = static_cast<double>(i) / intervals;
    nodes.push_back((1.0 - share) * roll.low + share * roll.high);
  }
  return nodes;
}

constexpr double pressure_error = 0.04;  // of the interpolation

/// The largest pressure, whose squares are interpolated, against that of a solution.
bool pressure_agrees(double interpolated_square, double solved) {
  return std::abs(std::sqrt(interpolated_square) - solved) < pressure_error * solved;
}

/// Points of Chebyshev and Lobatto, ends included.
std::vector<double> chebyshev_nodes(double low, double high, int count) {
  std::vector<double> nodes;
  for (int i = 0; i < count; ++i) {
    nodes.push_back(0.5 * (low + high) - 0.5 * (high - low) * std::cos(std::numbers::pi * i / (count - 1)));
  }
  return nodes;
}

/// Of yaw²; the first stands for 0, at a yaw at which what is odd in yaw can be divided by it.
std::vector<double> yaw_squared_nodes(double yaw, int count) {
  if (yaw == 0.0) return {0.0};
  std::vector<double> nodes = chebyshev_nodes(0.0, yaw * yaw, count);
  nodes.front() = 1e-6 * yaw * yaw;
  return nodes;
}

/// A column of nodes over the energy.
struct ColumnPlace {
  double y0;
  std::size_t roll, yaw;
  friend bool operator<(const ColumnPlace& a, const ColumnPlace& b) noexcept {
    return std::tie(a.y0, a.roll, a.yaw) < std::tie(b.y0, b.roll, b.yaw);
  }
};

class LoadedSweep {
 public:
  LoadedSweep(const ContactSearch& search, const LoadedSweepOptions& options, LoadedColumnStore store,
              const Progress& progress)
      : search_(search), options_(options), progress_(progress), keep_(std::move(store.keep)) {
    for (LoadedSweepColumn& column : store.known) {
      const ColumnPlace place{column.y0, column.roll, column.yaw};
      solved_.emplace(place, std::move(column));
    }
    yaw_squared_ = yaw_squared_nodes(options.yaw, options.yaw_nodes);
    column_.contact = options.contact;
    column_.levels = options.levels;
    column_.climb = options.climb;
    const ContactAtLoad most = contact_at_load(search, {}, options.largest_load, options.contact);
    if (!most.converged) {
      throw ComputationError(
          fmt::format("loaded table: no solution under --largest-load {} N at y = 0", options.largest_load));
    }
    column_.largest_level = std::pow(most.contact.elastic_energy, 0.2);
    set_roll(2);
    if (pressures_agree_over_roll()) set_roll(1);
  }

  LoadedTableData table() {
    std::vector<double> nodes = lateral_nodes();
    std::vector<ColumnPlace> wanted;
    for (const double y0 : nodes)
      for (std::size_t r = 0; r < roll_.size(); ++r)
        for (std::size_t s = 0; s < yaw_squared_.size(); ++s) wanted.push_back({y0, r, s});
    solve(wanted, true);
    return assembled(nodes);
  }

 private:
  [[nodiscard]] WheelsetPose pose_at(double y, std::size_t roll, double yaw) const {
    return {.y = y, .roll = roll_[roll] - options_.climb * y, .yaw = yaw};
  }

  [[nodiscard]] double reference_roll() const {
    return 0.0 >= roll_.front() && 0.0 <= roll_.back() ? 0.0 : roll_.front();
  }

  void set_roll(int parts) {
    roll_ = roll_nodes(options_.roll, options_.roll_spacing, parts);
    warp_.clear();
    jumps_.clear();
    column_.cut.clear();
    set_warps();
  }

  void set_warps() {
    // Jumps enter the range from beside it: they move by 0.4 to 0.8 m per rad, places without one by the radius.
    const double beside = 0.4 * std::max(roll_.back() - reference_roll(), reference_roll() - roll_.front());
    const Interval wide{options_.lateral.low - beside, options_.lateral.high + beside};
    std::vector<ContactJump> reference = contact_jumps(search_, wide, reference_roll(), 0.0, options_.climb);
    std::vector<std::vector<std::optional<double>>> moved;
    for (const double roll : roll_) {
      for (const double squared : yaw_squared_) {
        const double reach = 1.2e-3 + 1.5 * std::abs(roll - reference_roll());  // some 0.5 to 0.8 m per rad
        const std::vector<ContactJump> jumps =
            contact_jumps(search_, {wide.low - reach, wide.high + reach}, roll, std::sqrt(squared), options_.climb);
        moved.push_back(same_jumps(reference, jumps));
      }
    }
    std::vector<double> y0;
    std::vector<std::vector<double>> through(moved.size());
    for (std::size_t j = 0; j < reference.size(); ++j) {
      const bool everywhere =
          std::all_of(moved.begin(), moved.end(), [&](const auto& places) { return places[j].has_value(); });
      if (!everywhere) continue;
      y0.push_back(reference[j].y);
      for (std::size_t k = 0; k < moved.size(); ++k) through[k].push_back(*moved[k][j]);
      jumps_.push_back(reference[j]);
    }
    for (std::size_t k = 0; k < moved.size(); ++k) {
      const double roll = roll_[k / yaw_squared_.size()] - reference_roll();
      // Without jumps, roll turns the wheel about the height of its centre above the rail.
      const double radius = search_.pair().nominal_radius();
      warp_.emplace_back(y0, through[k], radius * roll / (1.0 + radius * options_.climb));
    }
    set_cuts();
  }

  /// Where a contact reaches a strip of greater curvature its largest pressure begins to rise, at a lateral shift that
  /// moves with the roll otherwise than the nodes do. Between every other node of roll, the largest pressure under one
  /// load is interpolated as the table does that of a part at one energy.
  [[nodiscard]] bool pressures_agree_over_roll() const {
    constexpr double load = 10e3;  // N; under greater ones the pressure rises less steeply
    constexpr double spacing = 2e-4;
    const int places = 1 + static_cast<int>((options_.lateral.high - options_.lateral.low) / spacing);
    LoadedContactOptions contact = options_.contact;
    contact.load_tolerance = 1e-3;
    ParallelFailure failure;
    std::atomic<bool> agree = true;
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < places; ++i) {
      failure.guard([&] {
        const double y0 = options_.lateral.low + (i + 0.5) / places * (options_.lateral.high - options_.lateral.low);
        std::vector<double> pressure;
        for (std::size_t r = 0; r < roll_.size(); ++r) pressure.push_back(largest_pressure(y0, r, load, contact));
        for (std::size_t r = 1; r < roll_.size(); r += 2) {
          const double low = pressure[r - 1], middle = pressure[r], high = pressure[r + 1];
          const bool known = std::isfinite(low + middle + high);
          if (known && !pressure_agrees(0.5 * (low * low + high * high), middle)) agree = false;
        }
      });
    }
    failure.rethrow();
    return agree;
  }

  /// Without yaw; not a number where no solution is found.
  [[nodiscard]] double largest_pressure(double y0, std::size_t roll, double load,
                                        const LoadedContactOptions& options) const {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const WheelsetPose pose = pose_at(warp_[roll * yaw_squared_.size()].at(y0).y, roll, 0.0);
    if (!std::isfinite(search_.first_touch(pose.y, pose.roll, pose.yaw).z_touch)) return unknown;
    try {
      const ContactAtLoad found = contact_at_load(search_, pose, load, options);
      return found.converged ? found.contact.largest_pressure : unknown;
    } catch (const TooManyElements&) {
      return unknown;
    }
  }

  void set_cuts() {
    std::vector<ContactJump> largest = jumps_;
    std::sort(largest.begin(), largest.end(), [](const ContactJump& p, const ContactJump& q) {
      return std::abs(p.s_above - p.s_below) > std::abs(q.s_above - q.s_below);
    });
    for (const ContactJump& jump : largest) {
      if (column_.cut.size() + 1 == LoadedLookup::capacity) break;
      const double s = widest_gap(search_, jump, reference_roll() - options_.climb * jump.y);
      const bool near =
          std::any_of(column_.cut.begin(), column_.cut.end(), [&](double other) { return std::abs(other - s) < 1e-3; });
      if (!near) column_.cut.push_back(s);
    }
    std::sort(column_.cut.begin(), column_.cut.end());
  }

  void solve(const std::vector<ColumnPlace>& wanted, bool last) {
    std::set<ColumnPlace> places;  // neighbouring intervals ask for the node between them twice
    for (const ColumnPlace& place : wanted)
      if (!solved_.contains(place)) places.insert(place);
    const std::vector<ColumnPlace> missing(places.begin(), places.end());
    std::vector<LoadedSweepColumn> found(missing.size());
    ParallelFailure failure;
    std::mutex one_at_a_time;
    std::size_t done = 0;
#pragma omp parallel for schedule(dynamic)
    for (std::size_t i = 0; i < missing.size(); ++i) {
      failure.guard([&] {
        const ColumnPlace& p = missing[i];
        found[i].y0 = p.y0;
        found[i].roll = p.roll;
        found[i].yaw = p.yaw;
        found[i].shift = warp_[p.roll * yaw_squared_.size() + p.yaw].at(p.y0);
        found[i].solution =
            loaded_column(search_, pose_at(found[i].shift.y, p.roll, std::sqrt(yaw_squared_[p.yaw])), column_);
        const std::scoped_lock lock(one_at_a_time);
        ++done;
        if (keep_) keep_(found[i]);
        if (progress_ && last) progress_(static_cast<double>(done) / static_cast<double>(missing.size()));
      });
    }
    failure.rethrow();
    for (std::size_t i = 0; i < missing.size(); ++i) solved_.emplace(missing[i], std::move(found[i]));
  }

  /// Where the interpolation between two nodes is held against a solution: (roll, yaw).
  [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> trials() const {
    const std::size_t r = roll_.size() - 1, s = yaw_squared_.size() - 1;
    return {{roll_.size() / 2, 0}, {0, s}, {r, s}};
  }

  std::vector<double> lateral_nodes() {
    constexpr double widest = 1e-3;
    std::vector<double> nodes{options_.lateral.low, options_.lateral.high};
    for (const ContactJump& jump : jumps_) {
      if (jump.y > options_.lateral.low && jump.y < options_.lateral.high) nodes.push_back(jump.y);
    }
    std::sort(nodes.begin(), nodes.end());
    std::vector<double> all;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const int parts = static_cast<int>(std::ceil((nodes[i + 1] - nodes[i]) / widest));
      for (int k = 0; k < parts; ++k) all.push_back(nodes[i] + (nodes[i + 1] - nodes[i]) * k / parts);
    }
    all.push_back(nodes.back());
    std::vector<std::pair<double, double>> open;
    for (std::size_t i = 0; i + 1 < all.size(); ++i) open.emplace_back(all[i], all[i + 1]);
    while (!open.empty()) {
      std::vector<ColumnPlace> wanted;
      for (const auto& [low, high] : open)
        for (const double y0 : {low, 0.5 * (low + high), high})
          for (const auto& [r, s] : trials()) wanted.push_back({y0, r, s});
      solve(wanted, false);
      std::vector<std::pair<double, double>> next;
      for (const auto& [low, high] : open) {
        if (high - low <= options_.least_interval || agrees(low, high)) continue;
        const double middle = 0.5 * (low + high);
        all.push_back(middle);
        next.insert(next.end(), {{low, middle}, {middle, high}});
      }
      open = std::move(next);
    }
    std::sort(all.begin(), all.end());
    return all;
  }

  [[nodiscard]] bool agrees(double low, double high) const {
    const auto trial = trials();
    return std::all_of(trial.begin(), trial.end(), [&](const auto& place) {
      const auto& [r, s] = place;
      return agrees(solved_.at({low, r, s}), solved_.at({0.5 * (low + high), r, s}), solved_.at({high, r, s}),
                    high - low);
    });
  }

  [[nodiscard]] bool agrees(const LoadedSweepColumn& low, const LoadedSweepColumn& middle,
                            const LoadedSweepColumn& high, double width) const {
    const std::vector<double> low_mixed = mixed(low), high_mixed = mixed(high);
    for (std::size_t k = 1; k < middle.solution.level.size(); ++k) {
      const LoadedNode &p = low.solution.level[k], &m = middle.solution.level[k], &q = high.solution.level[k];
      if (m.force < 1e3) continue;
      const double eighth = width / 8.0;
      const double z = 0.5 * (p.z + q.z) + eighth * (p.z_y * low.shift.slope - q.z_y * high.shift.slope);
      const double z_w = 0.5 * (p.z_w + q.z_w) + eighth * (low_mixed[k] - high_mixed[k]);
      const double z_y = (1.5 * (q.z - p.z) / width - 0.25 * (p.z_y * low.shift.slope + q.z_y * high.shift.slope)) /
                         middle.shift.slope;
      const double lowering = m.z - middle.solution.level.front().z;
      const double force = m.z_w / z_w * (1.0 - 1.5 * (z - m.z) / lowering);
      const double normal = std::hypot(1.0, m.z_y);
      const double error = std::max(std::abs(force - 1.0), 0.5 * std::abs(z_y - m.z_y) / normal);
      if (!(error < (m.force > 5e3 ? options_.force_error : options_.light_error))) return false;
      if (m.force > 5e3 && !parts_agree(p, m, q)) return false;
    }
    return true;
  }

  /// Parts are interpolated linearly, weighted by their shares, the squares of pressures without weights. On a ridge,
  /// rows of elements leave each of the three pressures uncertain by 1 %: a bound of 2 % halves intervals for nothing.
  [[nodiscard]] bool parts_agree(const LoadedNode& p, const LoadedNode& m, const LoadedNode& q) const {
    constexpr double share = 0.02, place = 0.1, length = 0.03;
    double largest = 0.0, square = 0.0;
    for (std::size_t i = 0; i < m.part.size(); ++i) {
      const LoadedPart &a = p.part[i], &b = m.part[i], &c = q.part[i];
      const double sum = a.share + c.share;
      if (std::abs(0.5 * sum - b.share) > share) return false;
      largest = std::max(largest, b.pressure);
      square = std::max(square, 0.5 * (a.pressure * a.pressure + c.pressure * c.pressure));
      if (sum <= 0.0 || b.share < 0.05) continue;
      const double s = (a.share * a.s_rail + c.share * c.s_rail) / sum, width = (a.share * a.b + c.share * c.b) / sum;
      const double length_x = (a.share * a.a + c.share * c.a) / sum;
      if (std::abs(width / b.b - 1.0) > length || std::abs(length_x / b.a - 1.0) > length) return false;
      if (std::abs(s - b.s_rail) > place * b.b * level_of(m)) return false;
    }
    return pressure_agrees(square, largest);
  }
  [[nodiscard]] static double level_of(const LoadedNode& node) { return std::pow(node.z_w * node.force / 5.0, 0.25); }

  /// ∂²z/∂w∂y0 at the nodes of a column, from differences of its slopes.
  [[nodiscard]] std::vector<double> mixed(const LoadedSweepColumn& column) const {
    const std::vector<LoadedNode>& level = column.solution.level;
    const double step = column_.largest_level / (options_.levels - 1);
    const std::size_t last = level.size() - 1;
    const auto slope = [&](std::size_t k) { return level[k].z_y * column.shift.slope; };
    std::vector<double> result(level.size());
    for (std::size_t k = 1; k < last; ++k) result[k] = 0.5 * (slope(k + 1) - slope(k - 1)) / step;
    result[0] = 0.0;  // z is even in w at first touch
    result[last] = 0.5 * (3.0 * slope(last) - 4.0 * slope(last - 1) + slope(last - 2)) / step;
    return result;
  }

  LoadedTableData assembled(const std::vector<double>& nodes) const {
    LoadedTableData data;
    data.lateral = nodes;
    data.roll = roll_;
    data.yaw_squared = yaw_squared_;
    data.levels = options_.levels;
    data.largest_level = column_.largest_level;
    data.climb = options_.climb;
    data.cut = column_.cut;
    data.contact_modulus = options_.contact.contact_modulus();
    const std::size_t columns = data.columns(), levels = static_cast<std::size_t>(data.levels);
    data.height.resize(4 * nodes.size() * levels * columns);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      std::vector<const LoadedSweepColumn*> of_node;
      for (std::size_t k = 0; k < columns; ++k) {
        const LoadedSweepColumn& column = solved_.at({nodes[i], k / yaw_squared_.size(), k % yaw_squared_.size()});
        of_node.push_back(&column);
        data.shift.insert(data.shift.end(), {column.shift.y, column.shift.slope});
        data.touch.push_back(column.solution.level.front().z);
        const std::vector<double> twist = mixed(column);
        for (std::size_t l = 0; l < levels; ++l) {
          const LoadedNode& n = column.solution.level[l];
          float* const height = &data.height[4 * ((i * levels + l) * columns + k)];
          height[0] = static_cast<float>(n.z - data.touch.back());
          height[1] = static_cast<float>(n.z_w);
          height[2] = static_cast<float>(n.z_y * column.shift.slope);
          height[3] = static_cast<float>(twist[l]);
        }
      }
      for (std::size_t l = 0; l < levels; ++l) add_parts(of_node, l, data);
    }
    long solutions = 0;
    for (const auto& [place, column] : solved_) solutions += column.solution.solutions;
    data.statistics = {{"solutions", static_cast<double>(solutions)},
                       {"force_error", options_.force_error},
                       {"light_error", options_.light_error},
                       {"elements", options_.contact.elements.across_narrowest},
                       {"largest_load", options_.largest_load}};
    return data;
  }

  static void add_parts(const std::vector<const LoadedSweepColumn*>& columns, std::size_t level,
                        LoadedTableData& data) {
    std::uint32_t pressed = 0;
    for (std::size_t p = 0; p < data.parts(); ++p) {
      const auto presses = [&](const LoadedSweepColumn* column) {
        return column->solution.level[level].part[p].share > 0.0;
      };
      if (std::none_of(columns.begin(), columns.end(), presses)) continue;
      pressed |= 1U << p;
      for (const LoadedSweepColumn* column : columns) {
        for (const double value : column->solution.level[level].part[p].values()) {
          data.part.push_back(static_cast<float>(value));
        }
      }
    }
    data.pressed.push_back(pressed);
  }

  const ContactSearch& search_;
  const LoadedSweepOptions& options_;
  const Progress& progress_;
  std::function<void(const LoadedSweepColumn&)> keep_;
  std::vector<double> roll_, yaw_squared_;
  LoadedColumnOptions column_;
  std::vector<ContactJump> jumps_;  ///< of the reference that all warps go through
  std::vector<LateralWarp> warp_;   ///< (roll, yaw²)
  std::map<ColumnPlace, LoadedSweepColumn> solved_;
};

}  // namespace

LoadedTableData sweep_loaded(const ContactSearch& search, const LoadedSweepOptions& options, LoadedColumnStore store,
                             const Progress& progress) {
  options.validate();
  return LoadedSweep(search, options, std::move(store), progress).table();
}

}  // namespace railtab
