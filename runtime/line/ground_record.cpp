#include "railtab/runtime/line/ground_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

void check_record(const std::vector<double>& time, const std::vector<GroundVector>& values) {
  if (time.size() < 2 || values.size() != time.size()) {
    throw input_error("ground record", fmt::format("{} times and {} values", time.size(), values.size()),
                      "as many of both, at least 2");
  }
  for (std::size_t i = 0; i < time.size(); ++i) {
    const bool increasing = i == 0 || time[i] > time[i - 1];
    if (increasing && std::isfinite(time[i]) && values[i].allFinite()) continue;
    throw input_error(fmt::format("ground record, point {}", i + 1), "a value that is not finite or not increasing",
                      "finite values at increasing times");
  }
}

/// Second derivatives at the points of the cubic spline whose first derivative vanishes at both ends [Press2007, Sect.
/// 3.3].
std::vector<GroundVector> clamped_curvatures(const std::vector<double>& t, const std::vector<GroundVector>& value) {
  const std::size_t n = t.size();
  std::vector<double> upper(n, 0.0);
  std::vector<GroundVector> m(n);
  const auto slope = [&](std::size_t i) -> GroundVector { return (value[i + 1] - value[i]) / (t[i + 1] - t[i]); };
  upper[0] = 0.5;
  m[0] = 3.0 * slope(0) / (t[1] - t[0]);
  for (std::size_t i = 1; i < n; ++i) {
    const bool last = i + 1 == n;
    const double before = t[i] - t[i - 1];
    const double after = last ? 0.0 : t[i + 1] - t[i];
    const GroundVector slope_after = last ? GroundVector(GroundVector::Zero()) : slope(i);
    const double pivot = 2.0 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    m[i] = (6.0 * (slope_after - slope(i - 1)) - before * m[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 0;) m[i] -= upper[i] * m[i + 1];
  return m;
}

}  // namespace

GroundRecord::GroundRecord(std::vector<double> time, std::vector<GroundVector> acceleration)
    : time_(std::move(time)), acceleration_(std::move(acceleration)) {
  integrate();
  given_peak_ = peak();
}

GroundVector GroundRecord::peak() const noexcept {
  GroundVector largest = GroundVector::Zero();
  for (const GroundVector& a : acceleration_) largest = largest.cwiseMax(a.cwiseAbs());
  return largest;
}

GroundRecord::LongestInterval GroundRecord::longest_interval() const {
  std::vector<double> interval;
  for (std::size_t i = 0; i + 1 < time_.size(); ++i) interval.push_back(time_[i + 1] - time_[i]);
  const auto longest = std::max_element(interval.begin(), interval.end());
  const double begin = time_[static_cast<std::size_t>(longest - interval.begin())], length = *longest;
  const auto middle = interval.begin() + static_cast<std::ptrdiff_t>(interval.size() / 2);
  std::nth_element(interval.begin(), middle, interval.end());
  return {begin, length, *middle};
}

void GroundRecord::integrate() {
  velocity_.assign(time_.size(), GroundVector::Zero());
  displacement_ = velocity_;
  for (std::size_t i = 0; i + 1 < time_.size(); ++i) {
    const double h = time_[i + 1] - time_[i];
    velocity_[i + 1] = velocity_[i] + 0.5 * h * (acceleration_[i] + acceleration_[i + 1]);
    displacement_[i + 1] =
        displacement_[i] + h * velocity_[i] + h * h / 6.0 * (2.0 * acceleration_[i] + acceleration_[i + 1]);
  }
}

GroundRecord GroundRecord::from_acceleration(std::vector<double> time, std::vector<GroundVector> acceleration) {
  check_record(time, acceleration);
  GroundRecord record(std::move(time), std::move(acceleration));
  // c0 + c1 τ with ∫ = −v(T) and ∬ = −d(T)
  const double T = record.end() - record.begin();
  const GroundVector v = record.velocity_.back(), d = record.displacement_.back();
  const GroundVector c0 = (2.0 * v - 6.0 / T * d) / T;
  const GroundVector c1 = (12.0 / T * d - 6.0 * v) / (T * T);
  for (std::size_t i = 0; i < record.time_.size(); ++i) {
    record.acceleration_[i] += c0 + (record.time_[i] - record.begin()) * c1;
  }
  record.integrate();
  record.drift_correction_ = c0.cwiseAbs().cwiseMax((c0 + T * c1).cwiseAbs());
  return record;
}

GroundRecord GroundRecord::from_displacement(std::vector<double> time, const std::vector<GroundVector>& displacement) {
  check_record(time, displacement);
  std::vector<GroundVector> acceleration = clamped_curvatures(time, displacement);
  return {std::move(time), std::move(acceleration)};
}

GroundState GroundRecord::at(double time) const noexcept {
  if (time <= time_.front()) return {};
  if (time >= time_.back()) return {displacement_.back(), GroundVector::Zero(), GroundVector::Zero()};
  const auto i = static_cast<std::size_t>(std::upper_bound(time_.begin(), time_.end(), time) - time_.begin()) - 1;
  const double h = time_[i + 1] - time_[i], tau = time - time_[i];
  const GroundVector& a = acceleration_[i];
  const GroundVector jerk = (acceleration_[i + 1] - a) / h;
  return {displacement_[i] + tau * (velocity_[i] + tau * (0.5 * a + tau / 6.0 * jerk)),
          velocity_[i] + tau * (a + 0.5 * tau * jerk), a + tau * jerk};
}

void GroundRecord::shift(double time) noexcept {
  for (double& t : time_) t += time;
}

void GroundRecord::scale(double factor) noexcept {
  for (auto* column : {&acceleration_, &velocity_, &displacement_}) {
    for (GroundVector& value : *column) value *= factor;
  }
  drift_correction_ *= std::abs(factor);
  given_peak_ *= std::abs(factor);
}

GroundRecord read_ground_record(const std::filesystem::path& file) {
  constexpr double g = 9.80665;  // m/s², standard gravity
  const std::vector<FileColumn> columns = read_columns(file);
  if (columns[0].name != "t") {
    throw input_error(columns[0].place(0), fmt::format("column '{}'", columns[0].name), "t[s] first");
  }
  static_cast<void>(factor_to_si(columns[0], {{"s", 1.0}}));
  require_argument(columns[0]);
  std::vector<GroundVector> values(columns[0].values.size(), GroundVector::Zero());
  std::optional<bool> accelerations;
  std::array<bool, 2> taken{};
  for (std::size_t c = 1; c < columns.size(); ++c) {
    const FileColumn& column = columns[c];
    const std::size_t component = column.name == "y" ? 0 : column.name == "z" ? 1 : 2;
    if (component == 2 || taken[component]) {
      throw input_error(column.place(0), fmt::format("column '{}'", column.name), "y and z, each at most once");
    }
    taken[component] = true;
    const double factor = factor_to_si(column, {{"m/s2", 1.0}, {"g", g}, {"m", 1.0}, {"mm", 1e-3}});
    const bool acceleration = column.unit == "m/s2" || column.unit == "g";
    if (accelerations.value_or(acceleration) != acceleration) {
      throw input_error(column.place(0), "accelerations and displacements", "either of them");
    }
    accelerations = acceleration;
    constexpr double largest_acceleration = 100.0, largest_displacement = 20.0;  // [m/s²], [m]
    require_magnitude(column, factor, acceleration ? largest_acceleration : largest_displacement);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i][static_cast<Eigen::Index>(component)] = factor * column.values[i];
    }
  }
  if (!accelerations) throw input_error(columns[0].place(0), "no other column", "y, z or both");
  return *accelerations ? GroundRecord::from_acceleration(columns[0].values, std::move(values))
                        : GroundRecord::from_displacement(columns[0].values, values);
}

}  // namespace railtab
