#include "railtab/runtime/line/speed_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

constexpr double slowest = 0.0, fastest = 200.0;  // m/s
constexpr double hardest = 100.0;                 // m/s²: more than any brake, less than a slip of the pen

/// First point of the line that holds `value`, for columns that increase.
std::size_t line_at(const std::vector<double>& points, double value) {
  const auto after = std::upper_bound(points.begin() + 1, points.end() - 1, value);
  return static_cast<std::size_t>(after - points.begin()) - 1;
}

/// @param place name of a point for messages
template <class Place>
void check_speeds(const std::vector<double>& time, const std::vector<double>& speed, const Place& place) {
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (!(speed[i] >= slowest && speed[i] <= fastest)) {
      throw input_error(place(i), fmt::format("{} m/s", speed[i]), fmt::format("{} to {} m/s", slowest, fastest));
    }
    if (i == 0) continue;
    if (!(time[i] > time[i - 1]) || !std::isfinite(time[i])) {
      throw input_error(place(i), fmt::format("t = {} s", time[i]),
                        fmt::format("more than {} s of the point before", time[i - 1]));
    }
    const double rate = (speed[i] - speed[i - 1]) / (time[i] - time[i - 1]);
    if (!(std::abs(rate) <= hardest)) {
      throw input_error(place(i), fmt::format("{:.4g} m/s2 since the one before", rate),
                        fmt::format("at most {} m/s2", hardest));
    }
  }
}

}  // namespace

SpeedProfile::SpeedProfile(std::vector<double> time, std::vector<double> speed)
    : time_(std::move(time)), speed_(std::move(speed)) {
  if (time_.size() < 2 || speed_.size() != time_.size()) {
    throw input_error("speed profile", fmt::format("{} times and {} speeds", time_.size(), speed_.size()),
                      "as many of both, at least 2");
  }
  check_speeds(time_, speed_, [](std::size_t i) { return fmt::format("speed profile, point {}", i + 1); });
  travel_.assign(time_.size(), 0.0);
  for (std::size_t i = 1; i < time_.size(); ++i) {
    travel_[i] = travel_[i - 1] + 0.5 * (speed_[i - 1] + speed_[i]) * (time_[i] - time_[i - 1]);
  }
  origin_ = travel(0.0);
}

double SpeedProfile::lowest() const noexcept { return *std::min_element(speed_.begin(), speed_.end()); }

double SpeedProfile::acceleration(double time) const noexcept {
  if (time < time_.front() || time >= time_.back()) return 0.0;
  const std::size_t i = line_at(time_, time);
  return (speed_[i + 1] - speed_[i]) / (time_[i + 1] - time_[i]);
}

double SpeedProfile::speed(double time) const noexcept {
  if (time <= time_.front()) return speed_.front();
  if (time >= time_.back()) return speed_.back();
  return speed_[line_at(time_, time)] + acceleration(time) * (time - time_[line_at(time_, time)]);
}

double SpeedProfile::travel(double time) const noexcept {
  if (time <= time_.front()) return speed_.front() * (time - time_.front());
  if (time >= time_.back()) return travel_.back() + speed_.back() * (time - time_.back());
  const std::size_t i = line_at(time_, time);
  return travel_[i] + 0.5 * (speed_[i] + speed(time)) * (time - time_[i]);
}

double SpeedProfile::distance(double time) const noexcept { return travel(time) - origin_; }

double SpeedProfile::time_at(double distance) const noexcept {
  const double s = distance + origin_;
  constexpr double never = std::numeric_limits<double>::infinity();
  if (s < 0.0) return speed_.front() > 0.0 ? time_.front() + s / speed_.front() : -never;
  if (s >= travel_.back()) {
    if (speed_.back() > 0.0) return time_.back() + (s - travel_.back()) / speed_.back();
    return s > travel_.back() ? never : time_.back();
  }
  const std::size_t i = line_at(travel_, s);
  // V τ + a τ²/2 = Δs, in the form that a = 0 does not divide by
  const double V = speed_[i], a = acceleration(time_[i]), ds = s - travel_[i];
  if (ds == 0.0) return time_[i];
  return time_[i] + 2.0 * ds / (V + std::sqrt(std::max(0.0, V * V + 2.0 * a * ds)));
}

SpeedProfile read_speed_profile(const std::filesystem::path& file) {
  std::vector<FileColumn> columns = read_columns(file);
  if (columns.size() != 2 || columns[0].name != "t" || columns[1].name != "V") {
    throw input_error(columns[0].place(0), names_of(columns), "t[s], V[m/s] or V[km/h]");
  }
  static_cast<void>(factor_to_si(columns[0], {{"s", 1.0}}));
  require_argument(columns[0]);
  const double factor = factor_to_si(columns[1], {{"m/s", 1.0}, {"km/h", 1.0 / 3.6}});
  for (double& v : columns[1].values) v *= factor;
  check_speeds(columns[0].values, columns[1].values, [&](std::size_t i) { return columns[1].place(i + 1); });
  return {std::move(columns[0].values), std::move(columns[1].values)};
}

}  // namespace railtab
