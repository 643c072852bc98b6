#include "creep_spline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cubic_spline_axis.hpp"
#include "railtab/tables/creep_coordinates.hpp"

namespace railtab {

namespace {

using std::numbers::pi;
using Row = Eigen::Array<float, 16, 1>;  // the four places along β, four components each
using Value = Eigen::Array4f;

/// Creepages beyond it are scaled down to it so that their squares do not overflow: complete sliding to rounding.
constexpr double largest_creepage = 1e100;
/// Below this angle to pure longitudinal creepage V_β/sin α is taken as V_αβ, which it is to relative order α².
constexpr double pole_sine = 1e-2;

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

/// A query folded by the symmetries.
struct CreepSpline::Point {
  Eigen::Array3d sign;     ///< of (x, y, spin) and of (F_x, F_y, M_z) alike
  Eigen::Vector3d radial;  ///< unit vector of u after folding
  double rho, across;      ///< |u|, |(u_y, u_s)|
  Place t, alpha, beta;
};

/// V = F/t and its derivatives with respect to t, α, β, and α and β.
struct CreepSpline::Jet {
  Value value, t, alpha, beta, alpha_beta;
};

CreepSpline::Place CreepSpline::Axis::locate(double x) const noexcept {
  const double steps = (x - first) * inverse_step;
  const int cell = std::clamp(static_cast<int>(steps), 0, cells - 1);
  return {cell, steps - cell};
}

CreepSpline::CreepSpline(const CreepTableData& data)
    : ratio_first_(data.nodes[0].front()),
      ratio_last_(data.nodes[0].back()),
      inverse_stretch_(1.0 / data.ratio_stretch),
      radius_unit_(data.radius_unit) {
  std::array<int, 4> n;
  for (std::size_t i = 0; i < 4; ++i) n[i] = static_cast<int>(data.nodes[i].size());
  const double low = squeezed_ratio(ratio_first_, data.ratio_stretch);
  const double high = squeezed_ratio(ratio_last_, data.ratio_stretch);
  axis_[0] = {low, (n[0] - 1) / (high - low), n[0] - 1};
  axis_[1] = {0.0, n[1] - 1.0, n[1] - 1};
  axis_[2] = {0.0, (n[2] - 1) / (0.5 * pi), n[2] - 1};
  axis_[3] = {0.0, n[3] / pi, n[3]};

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

CreepSpline::Point CreepSpline::locate(const Eigen::Array3d& u) const noexcept {
  Point p;
  const double turn = u[2] < 0.0 ? -1.0 : 1.0;
  p.sign = {u[0] < 0.0 ? -1.0 : 1.0, turn, turn};
  Eigen::Vector3d folded = p.sign * u;
  const double largest = folded.cwiseAbs().maxCoeff();
  if (largest > largest_creepage) folded *= largest_creepage / largest;
  const double across_squared = folded[1] * folded[1] + folded[2] * folded[2];
  p.across = std::sqrt(across_squared);
  p.rho = std::sqrt(across_squared + folded[0] * folded[0]);
  p.radial = p.rho > 0.0 ? Eigen::Vector3d(folded / p.rho) : Eigen::Vector3d::UnitX();
  p.t = axis_[1].locate(p.rho / (p.rho + radius_unit_));
  p.alpha = axis_[2].locate(std::atan2(p.across, folded[0]));
  p.beta = axis_[3].locate(std::atan2(std::abs(folded[2]), folded[1]));
  return p;
}

CreepSpline::Jet CreepSpline::evaluate(const Place& ratio, const Point& p) const noexcept {
  const SplineWeights<float> k(static_cast<float>(ratio.fraction)), t(static_cast<float>(p.t.fraction));
  const SplineWeights<float> a(static_cast<float>(p.alpha.fraction)), b(static_cast<float>(p.beta.fraction));
  const float* corner = coefficient_.data() + static_cast<std::size_t>(ratio.cell) * stride_[0] +
                        static_cast<std::size_t>(p.t.cell) * stride_[1] +
                        static_cast<std::size_t>(p.alpha.cell) * stride_[2] +
                        static_cast<std::size_t>(p.beta.cell) * components;
  // Over a/b and t first: of the 256 places 16 are left for the rest.
  std::array<Row, 4> value, slope;
  for (std::size_t l = 0; l < 4; ++l) value[l] = slope[l] = Row::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const float* row = corner + i * stride_[0] + j * stride_[1];
      const float w = k.value[i] * t.value[j], w_t = k.value[i] * t.slope[j];
      for (std::size_t l = 0; l < 4; ++l) {
        const Row c = Eigen::Map<const Row>(row + l * stride_[2]);
        value[l] += w * c;
        slope[l] += w_t * c;
      }
    }
  }
  const Row v = a.value[0] * value[0] + a.value[1] * value[1] + a.value[2] * value[2] + a.value[3] * value[3];
  const Row v_a = a.slope[0] * value[0] + a.slope[1] * value[1] + a.slope[2] * value[2] + a.slope[3] * value[3];
  const Row v_t = a.value[0] * slope[0] + a.value[1] * slope[1] + a.value[2] * slope[2] + a.value[3] * slope[3];
  const auto over_beta = [](const Row& r, const std::array<float, 4>& w) -> Value {
    return w[0] * r.segment<4>(0) + w[1] * r.segment<4>(4) + w[2] * r.segment<4>(8) + w[3] * r.segment<4>(12);
  };
  const auto step = [this](std::size_t axis) { return static_cast<float>(axis_[axis].inverse_step); };
  return {over_beta(v, b.value), step(1) * over_beta(v_t, b.value), step(2) * over_beta(v_a, b.value),
          step(3) * over_beta(v, b.slope), step(2) * step(3) * over_beta(v_a, b.slope)};
}

CreepLookup CreepSpline::lookup(double ratio, const std::array<double, 3>& creepage) const noexcept {
  CreepLookup result;
  if (!(ratio >= ratio_first_ && ratio <= ratio_last_)) return result;
  const double x = std::log(ratio) * inverse_stretch_;
  const Place place = axis_[0].locate(x / std::sqrt(1.0 + x * x));
  const CreepScale scales = creep_scale(ratio);
  const Eigen::Array3d scale(scales.x, scales.y, scales.spin), size(1.0, 1.0, scales.moment);
  const Point p = locate(scale * Eigen::Array3d(creepage[0], creepage[1], creepage[2]));
  const Jet jet = evaluate(place, p);

  // F = t V; its gradient over u in the directions of growing ρ, α, β.
  const double h = 1.0 / (p.rho + radius_unit_);  // t/ρ
  const double t = p.rho * h;
  const double cosine = p.radial[0], sine = p.rho > 0.0 ? p.across / p.rho : 0.0;
  const double cos_beta = p.across > 0.0 ? p.radial[1] / sine : 1.0;
  const double sin_beta = p.across > 0.0 ? p.radial[2] / sine : 0.0;
  const Eigen::Vector3d along_alpha(-sine, cosine * cos_beta, cosine * sin_beta);
  const Eigen::Vector3d along_beta(0.0, -sin_beta, cos_beta);
  const Eigen::Array3d value = size * jet.value.head<3>().cast<double>();
  const Eigen::Array3d by_rho = radius_unit_ * h * h * (value + t * size * jet.t.head<3>().cast<double>());
  const Eigen::Array3d by_alpha = h * size * jet.alpha.head<3>().cast<double>();
  const Eigen::Array3d by_beta = sine > pole_sine
                                     ? Eigen::Array3d((h / sine) * size * jet.beta.head<3>().cast<double>())
                                     : Eigen::Array3d(h * size * jet.alpha_beta.head<3>().cast<double>());
  for (int i = 0; i < 3; ++i) {
    result.force[static_cast<std::size_t>(i)] = p.sign[i] * t * value[i];
    for (int j = 0; j < 3; ++j) {
      const double gradient = by_rho[i] * p.radial[j] + by_alpha[i] * along_alpha[j] + by_beta[i] * along_beta[j];
      result.derivative[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          p.sign[i] * p.sign[j] * scale[j] * gradient;
    }
  }
  result.inside = true;
  return result;
}

}  // namespace railtab
