#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "railtab/runtime/base/lane_transpose.hpp"
#include "railtab/runtime/base/pack.hpp"
#include "railtab/runtime/base/smooth_step.hpp"
#include "railtab/tables/hermite_basis.hpp"
#include "railtab/tables/loaded_table.hpp"
#include "railtab/tables/loaded_table_sums.hpp"

namespace railtab {

namespace {

// Asks the memory for what will be read soon.
void fetch(const void* from, std::size_t bytes) {
  constexpr std::size_t line = 64;
  for (std::size_t at = 0; at < bytes + line - 1; at += line) __builtin_prefetch(static_cast<const char*>(from) + at);
}

double& element(Eigen::Vector4d& of, std::size_t j) { return of[static_cast<Eigen::Index>(j)]; }
template <class V>
V& element(std::array<V, 4>& of, std::size_t j) {
  return of[j];
}
double& element(Eigen::Matrix4d& of, std::size_t i, std::size_t j) {
  return of(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
}
template <class V>
V& element(std::array<std::array<V, 4>, 4>& of, std::size_t i, std::size_t j) {
  return of[i][j];
}

void set_zero(Eigen::Matrix4d& of) { of.setZero(); }
template <class V>
void set_zero(std::array<std::array<V, 4>, 4>& of) {
  of = {};
}

/// From derivatives with respect to (y, z, r, yaw), r = roll + climb·y, to those with respect to (y, z, roll, yaw).
template <class V>
void add_climb(double climb, LoadedLookupOf<V>& result, LoadedSlopesOf<V>* derivatives) noexcept {
  element(result.force, 0) = element(result.force, 0) + climb * element(result.force, 2);
  if (derivatives == nullptr) return;
  const auto at = [derivatives](std::size_t i, std::size_t j) -> V& { return element(derivatives->stiffness, i, j); };
  for (std::size_t j = 0; j < 4; ++j) at(0, j) = at(0, j) + climb * at(2, j);
  for (std::size_t i = 0; i < 4; ++i) at(i, 0) = at(i, 0) + climb * at(i, 2);
  const std::size_t sloped = result.parts > 1 ? LoadedPart::quantities : LoadedPart::of_one;
  for (std::size_t p = 0; p < result.parts; ++p) {
    for (std::size_t q = 0; q < sloped; ++q) {
      std::array<V, 4>& slope = derivatives->part[p][q];
      slope[0] = slope[0] + climb * slope[2];
    }
  }
}

}  // namespace

template <bool slopes>
std::size_t LoadedTable::guess_cell(double y, const NodeSums<slopes>& sums) const noexcept {
  const double first = data_.lateral.front(), range = data_.lateral.back() - first;
  const auto cell_of = [&](double y0) {
    const double at = std::clamp((y0 - first) / range, 0.0, 1.0) * static_cast<double>(buckets);
    return static_cast<std::size_t>(bucket_[std::min(static_cast<std::size_t>(at), buckets - 1)]);
  };
  // The displacement changes little along y0 and with yaw: from the cell at y to that at y less its displacement at the
  // first node of yaw.
  const double* const displaced = &displaced_[cell_of(y) * data_.roll.size() + sums.first / sums.yaws];
  double by = 0.0;
  for (std::size_t i = 0; i < sums.rolls; ++i) by += sums.roll[0][i] * displaced[i];
  return cell_of(y - by);
}

template <bool slopes>
bool LoadedTable::find_cell(double y, const NodeSums<slopes>& sums, std::size_t& cell,
                            CellEnds<slopes>& ends) const noexcept {
  const std::size_t last = data_.lateral.size() - 2;
  const auto low = [&] { return ends[here][0]; };
  const auto high = [&] { return ends[here][2]; };
  sums.of_eight(ends_of(cell, sums.first), ends);
  while (cell > 0 && low() > y) sums.of_eight(ends_of(--cell, sums.first), ends);
  while (cell < last && high() <= y) sums.of_eight(ends_of(++cell, sums.first), ends);
  return y >= low() && y <= high();
}

int LoadedTable::guess_level(double above, std::size_t node, double t) const noexcept {
  const std::size_t levels = static_cast<std::size_t>(data_.levels);
  if (!(above > 0.0)) return 0;
  // By the rise of the middle column.
  const float *const rise_low = &rise_[node * levels], *const rise_high = rise_low + levels;
  const auto rise = [&](int level) {
    const auto k = static_cast<std::size_t>(level);
    return (1.0 - t) * static_cast<double>(rise_low[k]) + t * static_cast<double>(rise_high[k]);
  };
  const double share = std::sqrt(above / rise(data_.levels - 1));
  int level = std::clamp(static_cast<int>(std::min(share, 1.0) * (data_.levels - 1)), 0, data_.levels - 2);
  while (level > 0 && rise(level) > above) --level;
  while (level < data_.levels - 2 && rise(level + 1) <= above) ++level;
  return level;
}

/// The corners in the directions that are wanted.
template <bool slopes>
void LoadedTable::add_corners(std::size_t node, int level, const NodeSums<slopes>& sums, const CellEnds<slopes>& ends,
                              Corners& corners) const noexcept {
  const std::size_t columns = data_.columns(), levels = static_cast<std::size_t>(data_.levels);
  for (std::size_t lateral = 0; lateral < 2; ++lateral) {
    for (std::size_t above = 0; above < 2; ++above) {
      const std::size_t at = (node + lateral) * levels + static_cast<std::size_t>(level) + above;
      typename NodeSums<slopes>::template Sums<Pack> sum;
      sums.of_four(&data_.height[4 * (at * columns + sums.first)], sum);
      for (std::size_t d = 0; d < sum.size(); ++d) {
        sum[d][0] += ends[d][static_cast<int>(4 + lateral)];
        corners.of[2 * lateral + above][d] = sum[d];
      }
    }
  }
}

void LoadedTable::fetch_ends(std::size_t cell, std::size_t first, std::size_t count) const noexcept {
  fetch(ends_of(cell, first), count * sizeof(Lanes));
}

void LoadedTable::fetch_rise(std::size_t node) const noexcept {
  const auto levels = static_cast<std::size_t>(data_.levels);
  fetch(&rise_[node * levels], 2 * levels * sizeof(float));
}

void LoadedTable::fetch_corners(std::size_t node, int level, std::size_t first, std::size_t count) const noexcept {
  const std::size_t columns = data_.columns(), levels = static_cast<std::size_t>(data_.levels);
  for (const std::size_t lateral : {node, node + 1}) {
    const std::size_t at = lateral * levels + static_cast<std::size_t>(level);
    const float* const height = &data_.height[4 * (at * columns + first)];
    fetch(height, 4 * count * sizeof(float));
    fetch(height + 4 * columns, 4 * count * sizeof(float));
  }
}

void LoadedTable::fetch_parts(const PartPlace& place) const noexcept {
  const std::size_t columns = data_.columns(), yaws = data_.yaw_squared.size();
  const PartPlace::Linear &r = place.r, &s = place.s;
  for (const std::size_t corner : place.node) {
    const float* part = weighted_part_.data() + part_at_[corner] + (r.low * yaws + s.low) * LoadedPart::quantities;
    for (std::uint32_t pressed = data_.pressed[corner]; pressed != 0; pressed &= pressed - 1) {
      for (std::size_t i = 0; i < 2; ++i) {
        fetch(part + i * yaws * LoadedPart::quantities, 2 * LoadedPart::quantities * sizeof(float));
      }
      part += columns * LoadedPart::quantities;
    }
  }
}

template <bool slopes>
bool LoadedTable::sum_part(const PartPlace& place, std::size_t part, PartSums& sums) const noexcept {
  constexpr std::size_t kinds = slopes ? std::size_t{PartSums::by_yaw_node} : 1, lanes = 3;
  const std::size_t columns = data_.columns(), yaws = data_.yaw_squared.size();
  const PartPlace::Linear &r = place.r, &s = place.s;
  const std::array<double, 2> ft{1.0 - place.t, place.t}, fu{1.0 - place.u, place.u}, fr{1.0 - r.part, r.part};
  const std::array<double, 2> t_rate{-1.0 / place.width, 1.0 / place.width},
      u_rate{-1.0 / level_step_, 1.0 / level_step_}, r_rate{-r.rate, r.rate};
  Lanes sum[kinds][lanes]{};  // of the lower node of yaw², then of the upper one
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const std::uint32_t pressed = data_.pressed[place.node[corner]];
    if ((pressed >> part & 1U) == 0) continue;
    const auto before = static_cast<std::size_t>(std::popcount(pressed & ((1U << part) - 1U)));
    const float* stored = &weighted_part_[part_at_[place.node[corner]] +
                                          (before * columns + r.low * yaws + s.low) * LoadedPart::quantities];
    const std::size_t t = corner & 1U, u = corner >> 1U;
    for (std::size_t i = 0; i < 2; ++i, stored += yaws * LoadedPart::quantities) {
      for (std::size_t m = 0; m < lanes; ++m) {
        Lanes values;
        widen(stored + Lanes::count * m, values);
        sum[PartSums::value][m] += (ft[t] * fu[u] * fr[i]) * values;
        if constexpr (slopes) {
          sum[PartSums::by_lateral][m] += (t_rate[t] * fu[u] * fr[i]) * values;
          sum[PartSums::by_level][m] += (ft[t] * u_rate[u] * fr[i]) * values;
          sum[PartSums::by_roll_node][m] += (ft[t] * fu[u] * r_rate[i]) * values;
        }
      }
    }
  }
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    Pack node[2][PartSums::packs];
    std::memcpy(node, sum[kind], sizeof node);
    for (std::size_t q = 0; q < PartSums::packs; ++q) {
      sums.sum[kind][q] = (1.0 - s.part) * node[0][q] + s.part * node[1][q];
      if constexpr (slopes) {
        if (kind == PartSums::value) sums.sum[PartSums::by_yaw_node][q] = s.rate * (node[1][q] - node[0][q]);
      }
    }
  }
  return sums.sum[PartSums::value][0][0] > 0.0;
}

template <class V>
V LoadedTable::margin_share(const V& roll, const V& yaw) const noexcept {
  const double margin = border * (data_.roll.back() - data_.roll.front());
  const V share = smooth_step(at_most(roll - data_.roll.front(), data_.roll.back() - roll) * (1.0 / margin));
  const double largest = data_.yaw_squared.back();
  const V squared = yaw * yaw;
  if (data_.yaw_squared.size() == 1) return select(squared > broadcast<V>(largest), V{}, share);
  return share * smooth_step((largest - squared) * (1.0 / (border * largest)));
}

/// A look-up in its steps: lateral cell, level, energy and forces, stiffness, parts.
template <bool slopes, class V>
class LoadedTable::LookUp {
 public:
  LookUp(const LoadedTable& table, const LoadedPoseOf<V>& pose, LoadedLookupOf<V>& result,
         LoadedSlopesOf<V>* derivatives) noexcept
      : table_(table),
        data_(table.data_),
        pose_(pose),
        result_(result),
        derivatives_(derivatives),
        weights_(table, pose.roll, pose.yaw) {}

  /// @param inside share of the table by roll and yaw
  void run(const V& inside) noexcept {
    inside_ = inside;
    find_laterals();
    find_levels();
    if (!any(found_ > 0.5)) {
      result_.table_share = inside_;
      return;
    }
    find_energy();
    if (!any(found_ > 0.5)) return;
    if constexpr (slopes) set_stiffness();
    set_parts();
  }

 private:
  static constexpr int places = lanes_of<V>;
  static constexpr double root = 1e-8;  ///< of rounding: Newton's next correction is less than its square
  using Four = std::array<V, 4>;

  /// What the corners leave at the places across: along w the height of the wheelset and its derivatives, value and
  /// slope at the lower level, then at the upper one.
  enum Line : std::size_t {
    height,
    over_y0,
    over_roll,
    over_yaw,
    over_y0_y0,
    over_roll_roll,
    over_roll_yaw,
    over_yaw_yaw,
    over_y0_roll,
    over_y0_yaw,
    lines
  };
  static constexpr std::size_t lines_used = slopes ? lines : over_yaw + 1;

  static void each(auto&& visit) {
    for (int i = 0; i < places; ++i) visit(i, static_cast<std::size_t>(i));
  }
  static V sum(const Four& basis, const Four& of) { return HermiteBasisOf<V>::sum(basis, of); }
  static std::array<double, 4> at(const Four& of, int i) {
    return {lane(of[0], i), lane(of[1], i), lane(of[2], i), lane(of[3], i)};
  }
  /// Four numbers of every pose.
  using OfPoses = std::array<Pack, places>;
  /// y and its derivatives, and z, at the places found.
  [[nodiscard]] V Y(const Four& basis, Direction d) const { return sum(basis, y_[d]); }
  [[nodiscard]] V Z(const Four& basis, std::size_t line) const { return sum(basis, z_[line]); }

  // The lateral node below, and the place t between it and the next: y(y0) is nearly linear.
  void find_laterals() {
    const V zero{}, one = broadcast<V>(1.0);
    OfPoses ends;
    ends.fill(Pack{0.0, 1.0, 1.0, 1.0});
    V from{};
    width_ = one;
    each([&](int i, std::size_t k) {
      if (!(lane(inside_, i) > 0.0)) return;
      sums_[k].set(weights_, i);
      lateral_[k] = table_.guess_cell(lane(pose_.y, i), sums_[k]);
      table_.fetch_ends(lateral_[k], sums_[k].first, sums_[k].rolls * sums_[k].yaws);
    });
    each([&](int i, std::size_t k) {
      if (!(lane(inside_, i) > 0.0)) return;
      if (!table_.find_cell(lane(pose_.y, i), sums_[k], lateral_[k], ends_[k])) return;
      lane(found_, i) = 1.0;
      std::memcpy(&ends[k], &ends_[k][here], sizeof ends[k]);
      lane(from, i) = data_.lateral[lateral_[k]];
      lane(width_, i) = data_.lateral[lateral_[k] + 1] - data_.lateral[lateral_[k]];
      table_.fetch_rise(lateral_[k]);
    });
    Four corner;
    set_side_by_side(ends, corner.data());
    using std::abs;
    t_ = (pose_.y - corner[0]) / (corner[2] - corner[0]);
    for (int iteration = 0; iteration < 20; ++iteration) {  // two suffice
      const HermiteBasisOf<V> basis(t_, width_);
      const V change = (sum(basis.value, corner) - pose_.y) / (sum(basis.first, corner) * width_);
      t_ = t_ - change;
      if (all((abs(change) < broadcast<V>(root)) | (found_ < 0.5))) break;
    }
    t_ = select(t_ > zero, at_most(t_, one), zero);
    across_ = HermiteBasisOf<V>(t_, width_);
    const V y0 = from + t_ * width_;
    const double range = data_.lateral.back() - data_.lateral.front();
    inside_ = inside_ *
              smooth_step(at_most(y0 - data_.lateral.front(), data_.lateral.back() - y0) * (1.0 / (border * range)));
    inside_ = select(found_ > 0.5, inside_, zero);
  }

  // The level below, and what the corners of the cell leave across. All levels are guessed first: the memory then has
  // the corners of all poses to bring.
  void find_levels() {
    found_ = V{};
    each([&](int i, std::size_t k) {
      if (!(lane(inside_, i) > 0.0)) return;
      const double t = lane(t_, i), touch = (1.0 - t) * ends_[k][here][4] + t * ends_[k][here][5];
      level_[k] = table_.guess_level(lane(pose_.z, i) - touch, lateral_[k], t);
      lane(found_, i) = 1.0;  // unless z is above first touch, which the corners say
      table_.fetch_corners(lateral_[k], level_[k], sums_[k].first, sums_[k].rolls * sums_[k].yaws);
    });
    each([&](int i, std::size_t k) {
      if (lane(found_, i) == 0.0) return set_no_lines(k);
      const std::array<double, 4> value = at(across_.value, i);
      const double z = lane(pose_.z, i), yaw = lane(pose_.yaw, i);
      Corners corners;
      Pack& line = line_[height][k];
      for (int moved = 0;;) {
        table_.add_corners(lateral_[k], level_[k], sums_[k], ends_[k], corners);
        corners.across(value, here, line);
        if (z <= line[0] && level_[k] == 0) {
          lane(found_, i) = 0.0;
          return set_no_lines(k);
        }
        if (z < line[0] && moved <= 0) {
          moved = -1;
          --level_[k];
        } else if (z >= line[2] && moved >= 0) {
          if (level_[k] == data_.levels - 2) {
            lane(inside_, i) = lane(found_, i) = 0.0;
            return set_no_lines(k);
          }
          moved = 1;
          ++level_[k];
        } else {
          break;
        }
      }
      PartPlace& place = part_place_[k];
      place.node = PartPlace::nodes(lateral_[k], level_[k], data_.levels);
      place.t = lane(t_, i);
      place.width = lane(width_, i);
      place.r = PartPlace::Linear(data_.roll, lane(pose_.roll, i));
      place.s = PartPlace::Linear(data_.yaw_squared, yaw * yaw);
      table_.fetch_parts(place);
      lane(touches_, i) = 1.0;
      lane(level_number_, i) = level_[k];
      const std::array<double, 4> first = at(across_.first, i);
      corners.across(first, here, line_[over_y0][k]);
      corners.across(value, by_roll, line_[over_roll][k]);
      corners.across(value, by_yaw, line_[over_yaw][k]);
      if constexpr (slopes) {
        corners.across(at(across_.second, i), here, line_[over_y0_y0][k]);
        corners.across(value, by_roll_roll, line_[over_roll_roll][k]);
        corners.across(value, by_roll_yaw, line_[over_roll_yaw][k]);
        corners.across(value, by_yaw_yaw, line_[over_yaw_yaw][k]);
        corners.across(first, by_roll, line_[over_y0_roll][k]);
        corners.across(first, by_yaw, line_[over_y0_yaw][k]);
      }
    });
    for (std::size_t which = 0; which < lines_used; ++which) set_side_by_side(line_[which], z_[which].data());
    for (std::size_t d = 0; d < NodeSums<slopes>::wanted; ++d) {
      OfPoses y{};
      each([&](int i, std::size_t k) {
        if (lane(found_, i) > 0.0) std::memcpy(&y[k], &ends_[k][d], sizeof y[k]);
      });
      set_side_by_side(y, y_[d].data());
    }
  }

  void set_no_lines(std::size_t k) {
    for (OfPoses& line : line_) line[k] = Pack{};
  }

  // The place u between the levels: the root of a cubic that grows from z or less to z or more.
  void find_place() {
    using std::abs, std::sqrt;
    const Four& line = z_[height];
    const V zero{};
    V low{}, high = broadcast<V>(1.0);
    u_ = (pose_.z - line[0]) / (line[2] - line[0]);
    u_ = select(level_number_ < 0.5, sqrt(select(u_ > zero, u_, zero)), u_);
    constexpr double rounding = 1e-13;  // of a place
    for (int iteration = 0; iteration < 60; ++iteration) {
      const HermiteBasisOf<V> basis(u_, broadcast<V>(table_.level_step_));
      const V excess = sum(basis.value, line) - pose_.z, slope = sum(basis.first, line) * table_.level_step_;
      high = select(excess > zero, u_, high);
      low = select(excess > zero, low, u_);
      V next = u_ - excess / slope;
      const auto within = (next >= low) & (next <= high);
      next = select(within, next, 0.5 * (low + high));
      const V change = abs(next - u_);
      u_ = next;
      if (all((change < broadcast<V>(rounding)) | (within & (change < root * u_)) | (found_ < 0.5))) break;
    }
  }

  // y0(y, roll, yaw), then w(y, z, roll, yaw) from Z(w, y0(y, roll, yaw), roll, yaw) = z.
  void find_energy() {
    find_place();
    const V zero{}, w = (level_number_ + u_) * table_.level_step_;
    const double last = data_.levels - 1;
    const V below_last = smooth_step((last - (level_number_ + u_)) * (1.0 / (border * last)));
    inside_ = inside_ * select(found_ > 0.5, below_last, broadcast<V>(1.0));
    along_ = HermiteBasisOf<V>(u_, broadcast<V>(table_.level_step_));
    const V Z_w = Z(along_.first, height), Z_y = Z(along_.value, over_y0);
    found_ = select(Z_w > zero, found_, zero);
    by_Y_ = 1.0 / Y(across_.first, here);
    by_Z_ = 1.0 / Z_w;
    place_.w = w;
    place_.y0_1 = {by_Y_, zero, -(Y(across_.value, by_roll) * by_Y_), -(Y(across_.value, by_yaw) * by_Y_)};
    const Four Z_1{Z_y * place_.y0_1[0], broadcast<V>(-1.0), Z(along_.value, over_roll) + Z_y * place_.y0_1[2],
                   Z(along_.value, over_yaw) + Z_y * place_.y0_1[3]};
    const V w4 = w * w * w * w;
    for (std::size_t j = 0; j < 4; ++j) {
      place_.w_1[j] = -(Z_1[j] * by_Z_);
      element(result_.force, j) = select(found_ > 0.5, 5.0 * w4 * place_.w_1[j], zero);
    }
    // Without contact the share counts, and nothing else.
    result_.table_share = select((found_ > 0.5) | (touches_ < 0.5), inside_, zero);
    result_.energy = select(found_ > 0.5, w4 * w, zero);
  }

  void set_stiffness() {
    const V zero{}, &w = place_.w, w3 = w * w * w;
    const Four &w_1 = place_.w_1, &y0_1 = place_.y0_1;
    const V Y_yy = Y(across_.second, here), Z_yy = Z(along_.value, over_y0_y0), Z_y = Z(along_.value, over_y0);
    const V Z_wy = Z(along_.first, over_y0), Z_ww = Z(along_.second, height);
    const Four Y_y1{zero, zero, Y(across_.first, by_roll), Y(across_.first, by_yaw)};
    const Four Z_y1{zero, zero, Z(along_.value, over_y0_roll), Z(along_.value, over_y0_yaw)};
    const Four Z_w1{Z_wy * y0_1[0], zero, Z(along_.first, over_roll) + Z_wy * y0_1[2],
                    Z(along_.first, over_yaw) + Z_wy * y0_1[3]};
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t m = 0; m <= j; ++m) {
        V Y_2 = Y_y1[j] * y0_1[m] + y0_1[j] * Y_y1[m] + Y_yy * y0_1[j] * y0_1[m];
        V Z_2 = Z_y1[j] * y0_1[m] + y0_1[j] * Z_y1[m] + Z_yy * y0_1[j] * y0_1[m];
        if (m >= 2) {
          const std::size_t both = j + m - 4;  // 0: roll twice, 1: roll and yaw, 2: yaw twice
          Y_2 = Y_2 + Y(across_.value, static_cast<Direction>(by_roll_roll + both));
          Z_2 = Z_2 + Z(along_.value, over_roll_roll + both);
        }
        Z_2 = Z_2 - Z_y * Y_2 * by_Y_;
        const V w_2 = -((Z_2 + Z_w1[j] * w_1[m] + w_1[j] * Z_w1[m] + Z_ww * w_1[j] * w_1[m]) * by_Z_);
        element(derivatives_->stiffness, j, m) = element(derivatives_->stiffness, m, j) =
            5.0 * w3 * (4.0 * w_1[j] * w_1[m] + w * w_2);
      }
    }
  }

  // The parts of every pose, in their order; then those of equal number side by side.
  void set_parts() {
    std::array<std::array<PartSums, LoadedLookup::capacity>, places> sums;
    std::array<std::size_t, places> count{};
    each([&](int i, std::size_t k) {
      if (lane(found_, i) == 0.0) return;
      PartPlace& at = part_place_[k];
      at.u = lane(u_, i);
      std::uint32_t loaded = 0;
      for (const std::size_t node : at.node) loaded |= data_.pressed[node];
      for (; loaded != 0; loaded &= loaded - 1) {
        const auto part = static_cast<std::size_t>(std::countr_zero(loaded));
        if (table_.sum_part<slopes>(at, part, sums[k][count[k]])) ++count[k];
      }
      result_.parts = std::max(result_.parts, count[k]);
    });
    if (result_.parts > 1) {
      give_parts<LoadedPart::quantities>(sums, count);
    } else {
      give_parts<LoadedPart::of_one>(sums, count);
    }
  }

  // @param sloped quantities whose slopes are set
  template <std::size_t sloped>
  void give_parts(const std::array<std::array<PartSums, LoadedLookup::capacity>, places>& sums,
                  const std::array<std::size_t, places>& count) noexcept {
    constexpr std::size_t kinds = slopes ? std::size_t{PartSums::count} : 1;
    for (std::size_t p = 0; p < result_.parts; ++p) {
      std::array<V, PartSums::count * LoadedPart::quantities> numbers;
      V has{};
      each([&](int i, std::size_t k) { lane(has, i) = p < count[k] ? 1.0 : 0.0; });
      for (std::size_t kind = 0; kind < kinds; ++kind) {
        for (std::size_t q = 0; q < PartSums::packs; ++q) {
          if (kind != PartSums::value && 4 * q >= sloped) break;
          OfPoses of;
          of.fill(kind == PartSums::value ? 1.0 - Pack{} : Pack{});
          each([&](int, std::size_t k) {
            if (p < count[k]) of[k] = sums[k][p].sum[kind][q];
          });
          set_side_by_side(of, &numbers[kind * LoadedPart::quantities + 4 * q]);
        }
      }
      set_part<sloped>(numbers, p);
      result_.part[p].share = select(has > 0.5, result_.part[p].share, V{});
    }
  }

  // A part from its sums: from reduced quantities to lengths, densities and pressure.
  template <std::size_t sloped>
  void set_part(const std::array<V, PartSums::count * LoadedPart::quantities>& sums, std::size_t p) noexcept {
    constexpr std::size_t count = LoadedPart::quantities;
    enum Scale : std::size_t { none, of_yaw, of_w, of_ww };
    constexpr std::array<Scale, count> scale_of{none, of_yaw, none,  none, none, of_w,
                                                of_w, of_ww,  of_ww, none, none, of_w};
    const V one = broadcast<V>(1.0), &w = place_.w, zero{};
    const std::array<V, 4> scale{one, pose_.yaw, w, w * w};
    const V share = sums[0], inverse = 1.0 / share;
    std::array<V, count> mean;
    for (std::size_t q = 1; q < count; ++q) mean[q] = inverse * sums[q];
    mean[0] = share;
    using std::sqrt;
    // At yaw 0 squares are extrapolated by a millionth: the sum of very small ones may be below zero.
    const V square = sums[PartSums::pressure], least = broadcast<V>(1e-30);
    mean[PartSums::pressure] = sqrt(select(square > least, square, least));
    LoadedPartOf<V>& part = result_.part[p];
    for (std::size_t q = 0; q < count; ++q) part[q] = scale[scale_of[q]] * mean[q] + table_.reference_[q];
    if constexpr (slopes) {
      const std::array<V, 4> scale_w{zero, zero, one, 2.0 * w};
      const auto along = [&](PartSums::Along d, std::size_t q) {
        const V& of_share = sums[d * count];
        if (q == PartSums::pressure) return 0.5 / mean[q] * sums[d * count + q];
        return q == 0 ? of_share : inverse * (sums[d * count + q] - of_share * mean[q]);
      };
      LoadedPartOf<std::array<V, 4>>& part_1 = derivatives_->part[p];
      for (std::size_t q = 0; q < sloped; ++q) {
        const V &by_scale = scale[scale_of[q]], &by_scale_w = scale_w[scale_of[q]];
        const V by_y0 = by_scale * along(PartSums::by_lateral, q),
                by_w = by_scale * along(PartSums::by_level, q) + by_scale_w * mean[q];
        std::array<V, 4>& slope = part_1[q];
        for (std::size_t j = 0; j < 4; ++j) slope[j] = by_y0 * place_.y0_1[j] + by_w * place_.w_1[j];
        slope[2] = slope[2] + by_scale * along(PartSums::by_roll_node, q);
        slope[3] = slope[3] + 2.0 * pose_.yaw * by_scale * along(PartSums::by_yaw_node, q);
      }
      part_1.arm_x[3] = part_1.arm_x[3] + mean[1];
    }
  }

  /// The place along the energy and how it and y0 follow the pose (y, z, roll, yaw).
  struct {
    V w;
    Four w_1, y0_1;
  } place_;

  const LoadedTable& table_;
  const LoadedTableData& data_;
  const LoadedPoseOf<V>& pose_;
  LoadedLookupOf<V>& result_;
  LoadedSlopesOf<V>* derivatives_;
  Weights<V> weights_;
  std::array<NodeSums<slopes>, places> sums_;
  std::array<CellEnds<slopes>, places> ends_;
  std::array<PartPlace, places> part_place_;
  V inside_;
  V found_{}, touches_{};  ///< 1 where the search goes on; where there is contact
  std::array<std::size_t, places> lateral_{};
  std::array<int, places> level_{};
  V level_number_{}, width_, t_, u_;
  HermiteBasisOf<V> across_{V{}, broadcast<V>(1.0)}, along_{V{}, broadcast<V>(1.0)};
  std::array<OfPoses, lines_used> line_;  ///< find_levels() sets those of every pose
  std::array<Four, lines_used> z_;
  std::array<Four, NodeSums<slopes>::wanted> y_;  ///< y(y0): value and slope at the lower node, then at the upper one
  V by_Y_, by_Z_;                                 ///< 1/Y_y0, 1/Z_w
};

template <bool slopes, class V>
void LoadedTable::find(const LoadedPoseOf<V>& pose, LoadedLookupOf<V>& result,
                       LoadedSlopesOf<V>* derivatives) const noexcept {
  result.table_share = result.energy = V{};
  for (std::size_t j = 0; j < 4; ++j) element(result.force, j) = V{};
  result.parts = 0;
  if constexpr (slopes) set_zero(derivatives->stiffness);
  LoadedPoseOf<V> reduced = pose;
  reduced.roll = pose.roll + data_.climb * pose.y;
  const V inside = margin_share(reduced.roll, pose.yaw);
  if (!any(inside > V{})) return;
  LookUp<slopes, V>(*this, reduced, result, derivatives).run(inside);
  if (data_.climb != 0.0) add_climb(data_.climb, result, slopes ? derivatives : nullptr);
}

template void LoadedTable::find<false, double>(const LoadedPoseOf<double>&, LoadedLookup&,
                                               LoadedSlopes*) const noexcept;
template void LoadedTable::find<true, double>(const LoadedPoseOf<double>&, LoadedLookup&, LoadedSlopes*) const noexcept;
template void LoadedTable::find<false, WheelLanes>(const LoadedPoseOf<WheelLanes>&, LoadedLookupOf<WheelLanes>&,
                                                   LoadedSlopesOf<WheelLanes>*) const noexcept;
template void LoadedTable::find<true, WheelLanes>(const LoadedPoseOf<WheelLanes>&, LoadedLookupOf<WheelLanes>&,
                                                  LoadedSlopesOf<WheelLanes>*) const noexcept;

}  // namespace railtab
