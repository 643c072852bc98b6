#include "railtab/tables/creep_spline.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <type_traits>

#include "railtab/runtime/base/lane_numbers.hpp"
#include "railtab/runtime/base/lane_transpose.hpp"
#include "railtab/runtime/base/pack.hpp"
#include "railtab/tables/creep_coordinates.hpp"
#include "railtab/tables/cubic_spline_axis.hpp"

namespace railtab {

namespace {

using std::numbers::pi;
constexpr std::size_t components = 3;

/// Creepages beyond it are scaled down to it so that their squares do not overflow: complete sliding to rounding.
constexpr double largest_creepage = 1e100;
/// Below this angle to pure longitudinal creepage V_β/sin α is taken as V_αβ, which it is to relative order α²: both
/// are then right to 1e-10.
constexpr double pole_sine = 1e-5;

/// Applies a matrix along one axis of an array with `before` slower and `after` faster entries.
std::vector<double> along_axis(const std::vector<double>& in, std::size_t before, std::size_t after,
                               const Eigen::MatrixXd& matrix) {
  const auto rows = static_cast<std::size_t>(matrix.rows()), columns = static_cast<std::size_t>(matrix.cols());
  std::vector<double> out(before * rows * after, 0.0);
  using Plane = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto extent = [](std::size_t n) { return static_cast<Eigen::Index>(n); };
  for (std::size_t i = 0; i < before; ++i) {
    const Eigen::Map<const Plane> from(in.data() + i * columns * after, extent(columns), extent(after));
    Eigen::Map<Plane>(out.data() + i * rows * after, extent(rows), extent(after)).noalias() = matrix * from;
  }
  return out;
}

}  // namespace

namespace {

/// F_x, F_y and M_z, or what belongs to them: of one query in a pack, of queries side by side apart.
struct LaneComponents {
  WheelLanes of[3];

  friend LaneComponents operator+(LaneComponents a, const LaneComponents& b) noexcept {
    for (int i = 0; i < 3; ++i) a.of[i] += b.of[i];
    return a;
  }
  friend LaneComponents operator-(LaneComponents a, const LaneComponents& b) noexcept {
    for (int i = 0; i < 3; ++i) a.of[i] -= b.of[i];
    return a;
  }
  friend LaneComponents operator*(LaneComponents a, const LaneComponents& b) noexcept {
    for (int i = 0; i < 3; ++i) a.of[i] *= b.of[i];
    return a;
  }
  friend LaneComponents operator*(const WheelLanes& a, LaneComponents b) noexcept {
    for (WheelLanes& of : b.of) of *= a;
    return b;
  }
  friend LaneComponents operator*(const LaneComponents& a, const WheelLanes& b) noexcept { return b * a; }
  [[nodiscard]] const WheelLanes& operator[](std::size_t i) const noexcept { return of[i]; }
};
template <class V>
using Components = std::conditional_t<std::is_same_v<V, double>, Pack, LaneComponents>;

template <class V>
struct Jet {
  Components<V> value, t, alpha, beta, alpha_beta, ratio;

  /// @param jets of the queries; what is not wanted is not set
  template <CreepWanted wanted>
  void set(const std::array<CreepSplineJet, lanes_of<V>>& jets) noexcept {
    value = gathered(jets, &CreepSplineJet::value);
    if constexpr (wanted == CreepWanted::force) return;
    t = gathered(jets, &CreepSplineJet::t);
    alpha = gathered(jets, &CreepSplineJet::alpha);
    beta = gathered(jets, &CreepSplineJet::beta);
    alpha_beta = gathered(jets, &CreepSplineJet::alpha_beta);
    if constexpr (wanted == CreepWanted::by_ratio_too) ratio = gathered(jets, &CreepSplineJet::ratio);
  }

 private:
  static Components<V> gathered(const std::array<CreepSplineJet, lanes_of<V>>& jets,
                                Pack CreepSplineJet::*member) noexcept {
    if constexpr (std::is_same_v<V, double>) {
      return jets[0].*member;
    } else {
      std::array<Pack, lanes_of<V>> of_query;
      for (std::size_t i = 0; i < jets.size(); ++i) of_query[i] = jets[i].*member;
      std::array<V, 4> numbers;
      set_side_by_side(of_query, numbers.data());
      return {numbers[0], numbers[1], numbers[2]};
    }
  }
};

template <class V>
std::array<V, 8> side_by_side(const V& x, const auto& functions) noexcept {
  std::array<Pack, lanes_of<V>> first, second;
  for (int i = 0; i < lanes_of<V>; ++i) {
    const std::array<double, 8> of = functions(lane(x, i));
    std::memcpy(&first[static_cast<std::size_t>(i)], of.data(), sizeof(Pack));
    std::memcpy(&second[static_cast<std::size_t>(i)], of.data() + 4, sizeof(Pack));
  }
  std::array<V, 8> result;
  set_side_by_side(first, result.data());
  set_side_by_side(second, result.data() + 4);
  return result;
}

template <class V>
V sign_of(const V& x) noexcept {
  if constexpr (std::is_same_v<V, double>) {
    return std::copysign(1.0, x);
  } else {
    return select(x < 0.0, broadcast<V>(-1.0), broadcast<V>(1.0));
  }
}

}  // namespace

/// Scaled creepages u, folded by the symmetries into u_x >= 0, u_spin >= 0, in polar coordinates.
template <class V>
struct CreepSpline::Direction {
  V turn_x, turn;        ///< signs of x and F_x; of (y, spin) and (F_y, M_z)
  V x, y, spin;          ///< u
  V rho, across;         ///< |u|, |(u_y, u_spin)|
  V cosine, sine;        ///< of the angle to pure longitudinal creepage
  V cos_beta, sin_beta;  ///< around it; (1, 0) on it

  Direction(const V& u_x, const V& u_y, const V& u_spin) noexcept : turn_x(sign_of(u_x)), turn(sign_of(u_spin)) {
    using std::abs, std::sqrt;
    x = abs(u_x);
    y = turn * u_y;
    spin = abs(u_spin);
    const V across_squared = y * y + spin * spin, zero{}, one = broadcast<V>(1.0);
    across = sqrt(across_squared);
    rho = sqrt(across_squared + x * x);
    const V by_rho = 1.0 / rho, by_across = 1.0 / across;  // not used where they are infinite
    const auto moves = rho > zero, aside = across > zero;
    cosine = select(moves, x * by_rho, one);
    sine = select(moves, across * by_rho, zero);
    cos_beta = select(aside, y * by_across, one);
    sin_beta = select(aside, spin * by_across, zero);
  }
};

CreepSpline::CreepSpline(const CreepTableData& data)
    : ratio_first_(data.nodes[0].front()),
      ratio_last_(data.nodes[0].back()),
      radius_unit_(data.radius_unit),
      ratio_functions_([&data](double ratio) -> std::array<double, 8> {
        const double low = squeezed_ratio(data.nodes[0].front(), data.ratio_stretch);
        const double high = squeezed_ratio(data.nodes[0].back(), data.ratio_stretch);
        const double steps = (squeezed_ratio(ratio, data.ratio_stretch) - low) / (high - low) *
                             static_cast<double>(data.nodes[0].size() - 1);
        const CreepScale s = creep_scale(ratio);
        return {steps, s.x, s.y, s.spin, s.moment, s.alpha, s.beta, 0.0};
      }) {
  std::array<int, 4> n;
  for (std::size_t i = 0; i < 4; ++i) n[i] = static_cast<int>(data.nodes[i].size());
  last_cell_ = {n[0] - 2, n[1] - 2, n[2] - 2, n[3] - 1};
  inverse_step_ = {n[1] - 1.0, (n[2] - 1) / (0.5 * pi), n[3] / pi};
  set_coefficients(data);
}

void CreepSpline::set_coefficients(const CreepTableData& data) {
  std::array<int, 4> n;
  for (std::size_t i = 0; i < 4; ++i) n[i] = static_cast<int>(data.nodes[i].size());
  const Eigen::MatrixXd along_ratio = spline_coefficient_matrix(n[0], SplineEnd::free, SplineEnd::free);
  const Eigen::MatrixXd along_t = spline_coefficient_matrix(n[1], SplineEnd::free, SplineEnd::free);
  const std::array<std::size_t, 4> size{static_cast<std::size_t>(n[0]) + 2, static_cast<std::size_t>(n[1]) + 2,
                                        static_cast<std::size_t>(n[2]) + 2, static_cast<std::size_t>(n[3]) + 3};
  stride_ = {size[1] * size[2] * size[3] * components, size[2] * size[3] * components, size[3] * components};
  coefficient_.assign(size[0] * stride_[0], 0.0F);
  const std::size_t nodes = data.values.size() / 3;
  for (std::size_t c = 0; c < 3; ++c) {
    // Over α: F_x is even at pure longitudinal creepage and odd where υx = 0; F_y and M_z the other way round.
    const bool x = c == 0;
    const Eigen::MatrixXd along_alpha =
        spline_coefficient_matrix(n[2], x ? SplineEnd::even : SplineEnd::odd, x ? SplineEnd::odd : SplineEnd::even);
    const SplineEnd closed = x ? SplineEnd::periodic : SplineEnd::turned;
    const Eigen::MatrixXd along_beta = spline_coefficient_matrix(n[3], closed, closed);
    std::vector<double> v(nodes);
    for (std::size_t i = 0; i < nodes; ++i) v[i] = data.values[3 * i + c];
    v = along_axis(v, nodes / data.nodes[3].size(), 1, along_beta);
    v = along_axis(v, data.nodes[0].size() * data.nodes[1].size(), size[3], along_alpha);
    v = along_axis(v, data.nodes[0].size(), size[2] * size[3], along_t);
    v = along_axis(v, 1, size[1] * size[2] * size[3], along_ratio);
    for (std::size_t i = 0; i < v.size(); ++i) coefficient_[components * i + c] = static_cast<float>(v[i]);
  }
}

template <CreepWanted wanted>
void CreepSpline::evaluate(const std::array<double, 4>& steps, CreepSplineJet& jet) const noexcept {
  std::array<std::size_t, 4> cell;
  Pack fraction;
  for (std::size_t axis = 0; axis < 4; ++axis) {
    const int whole = std::clamp(static_cast<int>(steps[axis]), 0, last_cell_[axis]);
    cell[axis] = static_cast<std::size_t>(whole);
    fraction[axis] = steps[axis] - whole;
  }
  const float* corner =
      coefficient_.data() + cell[0] * stride_[0] + cell[1] * stride_[1] + cell[2] * stride_[2] + cell[3] * components;
  creep_spline_jet<wanted>(corner, stride_, CreepSplineWeights(fraction), jet);
}

template <CreepWanted wanted, class V>
CreepLookupOf<V> CreepSpline::found(const V& ratio, const std::array<V, 3>& creepage) const noexcept {
  CreepLookupOf<V> result;
  result.inside = true;
  const auto [ratio_steps, scale_x, scale_y, scale_spin, moment, alpha_spread, beta_spread, unused] =
      side_by_side(ratio, ratio_functions_);
  const Direction<V> d(scale_x * creepage[0], scale_y * creepage[1], scale_spin * creepage[2]);
  const V h = 1.0 / (d.rho + radius_unit_);  // t/ρ
  const V t = d.rho * h, zero{};
  const V spread_x = alpha_spread * d.x, spread_y = beta_spread * d.y;
  const std::array<V, 4> steps{ratio_steps, inverse_step_[0] * t,
                               inverse_step_[1] * arc_tangent_.angle(d.across, spread_x),
                               inverse_step_[2] * arc_tangent_.angle(d.spin, spread_y)};
  std::array<CreepSplineJet, lanes_of<V>> jets;
  for (int i = 0; i < lanes_of<V>; ++i) {
    evaluate<wanted>({lane(steps[0], i), lane(steps[1], i), lane(steps[2], i), lane(steps[3], i)},
                     jets[static_cast<std::size_t>(i)]);
  }
  Jet<V> v;
  v.template set<wanted>(jets);

  const Components<V> unit{d.turn_x, d.turn, d.turn * moment};
  const Components<V> force = unit * t * v.value;
  for (std::size_t i = 0; i < 3; ++i) result.force[i] = force[i];
  if constexpr (wanted == CreepWanted::force) return result;

  // F = t V; its gradient over u in the directions of growing ρ, α, β.
  // What a spread axis moves by when the angle itself moves: q/(q² cos² + sin²).
  const auto spread_rate = [](const V& q, const V& c, const V& s) { return q / (q * q * c * c + s * s); };
  const V alpha_rate = h * inverse_step_[1] * spread_rate(alpha_spread, d.cosine, d.sine);
  const V beta_rate = inverse_step_[2] * spread_rate(beta_spread, d.cos_beta, d.sin_beta);
  const V outward = radius_unit_ * h * h;
  const Components<V> by_rho = unit * outward * (v.value + (t * inverse_step_[0]) * v.t);
  const Components<V> by_alpha = unit * alpha_rate * v.alpha;
  const auto off_pole = d.sine > broadcast<V>(pole_sine);
  const Components<V> by_beta = unit * (select(off_pole, h * beta_rate / d.sine, zero) * v.beta +
                                        select(off_pole, zero, alpha_rate * beta_rate) * v.alpha_beta);
  const Components<V> by_across = d.sine * by_rho + d.cosine * by_alpha;
  const Components<V> by_x = (d.turn_x * scale_x) * (d.cosine * by_rho - d.sine * by_alpha);
  const Components<V> by_y = (d.turn * scale_y) * (d.cos_beta * by_across - d.sin_beta * by_beta);
  const Components<V> by_spin = (d.turn * scale_spin) * (d.sin_beta * by_across + d.cos_beta * by_beta);
  for (std::size_t i = 0; i < 3; ++i) result.derivative[i] = {by_x[i], by_y[i], by_spin[i]};
  if constexpr (wanted == CreepWanted::by_ratio_too) {
    const auto slopes = [this](double x) { return ratio_functions_.slope(x); };
    const auto [steps_1, x_1, y_1, spin_1, moment_1, alpha_1, beta_1, unused_1] = side_by_side(ratio, slopes);
    // What an angle's place moves by when its spread changes: d arctan(s/(q c))/dq.
    const auto turned = [](const V& q, const V& c, const V& s) { return -s * c / (q * q * c * c + s * s); };
    const Components<V> change =
        unit * t *
        (steps_1 * v.ratio + (alpha_1 * inverse_step_[1] * turned(alpha_spread, d.cosine, d.sine)) * v.alpha +
         (beta_1 * inverse_step_[2] * turned(beta_spread, d.cos_beta, d.sin_beta)) * v.beta);
    const Components<V> by_scale = (x_1 / scale_x * creepage[0]) * by_x + (y_1 / scale_y * creepage[1]) * by_y +
                                   (spin_1 / scale_spin * creepage[2]) * by_spin;
    for (std::size_t i = 0; i < 3; ++i) result.by_ratio[i] = change[i] + by_scale[i];
    result.by_ratio[2] = result.by_ratio[2] + moment_1 / moment * force[2];
  }
  return result;
}

template <CreepWanted wanted>
CreepLookup CreepSpline::found_if_inside(double ratio, const std::array<double, 3>& creepage) const noexcept {
  if (!(ratio >= ratio_first_ && ratio <= ratio_last_)) return {};
  if (!(std::abs(creepage[0]) <= largest_creepage && std::abs(creepage[1]) <= largest_creepage &&
        std::abs(creepage[2]) <= largest_creepage)) {
    return beyond(ratio, creepage);
  }
  return found<wanted>(ratio, creepage);
}

std::array<double, 3> CreepSpline::force(double ratio, const std::array<double, 3>& creepage) const noexcept {
  return found_if_inside<CreepWanted::force>(ratio, creepage).force;
}

std::array<WheelLanes, 3> CreepSpline::force(const WheelLanes& ratio,
                                             const std::array<WheelLanes, 3>& creepage) const noexcept {
  return found<CreepWanted::force>(ratio, creepage).force;
}

CreepLookup CreepSpline::lookup(double ratio, const std::array<double, 3>& creepage) const noexcept {
  return found_if_inside<CreepWanted::by_creepage>(ratio, creepage);
}

CreepLookup CreepSpline::jet(double ratio, const std::array<double, 3>& creepage) const noexcept {
  return found_if_inside<CreepWanted::by_ratio_too>(ratio, creepage);
}

CreepLookupOf<WheelLanes> CreepSpline::jet(const WheelLanes& ratio,
                                           const std::array<WheelLanes, 3>& creepage) const noexcept {
  return found<CreepWanted::by_ratio_too>(ratio, creepage);
}

CreepLookup CreepSpline::beyond(double ratio, const std::array<double, 3>& creepage) const noexcept {
  const double largest = std::max({std::abs(creepage[0]), std::abs(creepage[1]), std::abs(creepage[2])});
  const bool finite = std::isfinite(creepage[0]) && std::isfinite(creepage[1]) && std::isfinite(creepage[2]);
  if (finite) {
    const double down = largest_creepage / largest;
    CreepLookup scaled = jet(ratio, {down * creepage[0], down * creepage[1], down * creepage[2]});
    for (auto& row : scaled.derivative) row.fill(0.0);
    return scaled;
  }
  CreepLookup result;
  result.inside = true;
  result.force.fill(std::numeric_limits<double>::quiet_NaN());
  for (auto& row : result.derivative) row.fill(std::numeric_limits<double>::quiet_NaN());
  return result;
}

}  // namespace railtab
