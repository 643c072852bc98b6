#include "railtab/runtime/line/wind_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/linear_interpolation.hpp"

namespace railtab {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double strongest = 200.0;  // wind [m/s]

constexpr std::size_t most_points = 5000000;
constexpr double least_step = 1e-9;  // between the points of a history [s] or [m]

struct Line {
  double begin, rise;
};

/// Places 0 <= s < 1 between two points of a history at which its load is taken: equal parts, and where the yaw angle
/// is one of the table's.
std::vector<double> shares(const Aerodynamics& vehicle, const Wind& wind, const Line& train, const Line& gust,
                           double top_speed) {
  constexpr double pieces = 128.0;  // over a change as large as `top_speed`: (1/128)² of the load or less
  const double parts = std::max(1.0, std::ceil(pieces * (std::abs(gust.rise) + std::abs(train.rise)) / top_speed));
  std::vector<double> places;
  for (double k = 0.0; k < parts; ++k) places.push_back(k / parts);
  const double direction = std::abs(wind.direction);
  for (const double yaw : vehicle.yaw) {
    // U sin(direction − yaw) = V sin(yaw)
    const double across = std::sin(direction - yaw), ahead = std::sin(yaw);
    const double s = (ahead * train.begin - across * gust.begin) / (across * gust.rise - ahead * train.rise);
    if (s > 0.0 && s < 1.0) places.push_back(s);
  }
  std::sort(places.begin(), places.end());
  return places;
}

/// The yaw angle follows from the ratio of both speeds, which between two points of a history is monotonic: the largest
/// one is at a point.
void require_yaw_angles(const Aerodynamics& vehicle, const Wind& wind, const std::vector<double>& train,
                        const std::vector<double>& gust) {
  double widest = -1.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < train.size(); ++i) {
    const double yaw = std::abs(relative_wind(wind, train[i], gust[i]).yaw);
    if (!(yaw > widest)) continue;
    widest = yaw;
    at = i;
  }
  if (widest <= vehicle.yaw.back() * (1.0 + 1e-9)) return;
  throw input_error(
      vehicle.source, fmt::format("coefficients up to a yaw angle of {:.4g}°", vehicle.yaw.back() / degree),
      fmt::format("up to {:.4g}°, the largest angle of the run: the train runs at {:.4g} m/s in wind of {:.4g} m/s",
                  std::ceil(1e2 * widest / degree) / 1e2, train[at], gust[at]));
}

/// Mirrored at the track's vertical plane.
ForceAndMoment mirrored(ForceAndMoment load) {
  for (const Eigen::Index k : {1, 3, 5}) load[k] = -load[k];
  return load;
}

}  // namespace

ForceAndMoment Aerodynamics::at(double angle) const noexcept { return interpolate(yaw, coefficient, angle); }

Aerodynamics read_aerodynamics(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 6> names{"", "C_Fy", "C_Fz", "C_Mx", "C_My", "C_Mz"};
  constexpr double largest = 1e3;
  const std::vector<FileColumn> columns =
      read_columns(file, "yaw[deg],C_Fy[1],C_Fz[1],C_Mx[1],C_My[1],C_Mz[1]; columns that are 0 may be absent");
  const FileColumn& yaw = columns[0];
  if (yaw.name != "yaw") throw input_error(yaw.place(0), fmt::format("column '{}'", yaw.name), "yaw[deg] first");
  Aerodynamics vehicle;
  vehicle.source = file.string();
  const double to_radian = factor_to_si(yaw, {{"deg", degree}, {"rad", 1.0}});
  for (const double angle : yaw.values) vehicle.yaw.push_back(to_radian * angle);
  if (vehicle.yaw.front() != 0.0) {
    throw input_error(yaw.place(1), fmt::format("{} {}", yaw.values.front(), yaw.unit),
                      "0: wind from the left, from ahead to behind");
  }
  if (vehicle.yaw.back() > std::numbers::pi * (1.0 + 1e-6)) {
    throw input_error(yaw.place(yaw.values.size()), fmt::format("{} {}", yaw.values.back(), yaw.unit), "at most 180°");
  }
  vehicle.coefficient.assign(vehicle.yaw.size(), ForceAndMoment::Zero());
  std::array<bool, 6> taken{true};
  for (std::size_t c = 1; c < columns.size(); ++c) {
    const auto k = static_cast<std::size_t>(std::find(names.begin(), names.end(), columns[c].name) - names.begin());
    if (k == names.size() || taken[k]) {
      throw input_error(columns[c].place(0), fmt::format("column '{}'", columns[c].name),
                        "each of C_Fy, C_Fz, C_Mx, C_My, C_Mz at most once");
    }
    taken[k] = true;
    static_cast<void>(factor_to_si(columns[c], {{"1", 1.0}, {"-", 1.0}}));
    require_magnitude(columns[c], 1.0, largest);
    for (std::size_t i = 0; i < vehicle.yaw.size(); ++i) {
      vehicle.coefficient[i][static_cast<Eigen::Index>(k)] = columns[c].values[i];
    }
  }
  return vehicle;
}

RelativeWind relative_wind(const Wind& wind, double train_speed, double wind_speed) noexcept {
  const double ahead = train_speed + wind_speed * std::cos(wind.direction);
  const double across = wind_speed * std::sin(wind.direction);
  return {std::atan2(across, ahead), std::hypot(across, ahead)};
}

ForceAndMoment wind_load(const Aerodynamics& vehicle, const Wind& wind, double train_speed, double wind_speed,
                         double height) noexcept {
  const RelativeWind met = relative_wind(wind, train_speed, wind_speed);
  const ForceAndMoment c = vehicle.at(std::abs(met.yaw));
  const double pressure = 0.5 * wind.density * met.speed * met.speed;
  ForceAndMoment load = pressure * vehicle.area * c;
  load.tail<3>() *= vehicle.length;
  // M about the point: M + r × F with r = (0, 0, height) from it down to the rail-head tops
  load[3] -= height * load[1];
  load[4] += height * load[0];
  return met.yaw < 0.0 ? mirrored(load) : load;
}

WindHistory read_wind_history(const std::filesystem::path& file, double start) {
  const std::vector<FileColumn> columns = read_columns(file, "t[s],U[m/s]");
  const bool over_time = columns[0].name == "t";
  if (columns.size() != 2 || (!over_time && columns[0].name != "x") || columns[1].name != "U") {
    throw input_error(columns[0].place(0), names_of(columns), "t[s] or x[m], and U[m/s], the speed of the wind");
  }
  static_cast<void>(factor_to_si(columns[0], {{over_time ? "s" : "m", 1.0}}));
  require_argument(columns[0]);
  WindHistory history{over_time ? LoadArgument::time : LoadArgument::position, columns[0].values, columns[1].values};
  const double factor = factor_to_si(columns[1], {{"m/s", 1.0}, {"km/h", 1.0 / 3.6}});
  require_magnitude(columns[1], factor, strongest);
  for (std::size_t i = 0; i < history.points.size(); ++i) {
    history.points[i] += start;
    history.speed[i] *= factor;
    if (history.speed[i] < 0.0) {
      throw input_error(columns[1].place(i + 1), fmt::format("{} {}", columns[1].values[i], columns[1].unit),
                        "a speed of the wind, at least 0; load.wind_direction says from where");
    }
  }
  return history;
}

WindHistory with_points(WindHistory history, const std::vector<double>& at) {
  const std::vector<double> points = history.points, speed = history.speed;
  history.points.clear();
  std::set_union(points.begin(), points.end(), at.begin(), at.end(), std::back_inserter(history.points));
  history.speed.clear();
  for (const double point : history.points) history.speed.push_back(interpolate(points, speed, point));
  return history;
}

WindHistory wind_gust(double peak, double start, double duration) {
  GustShape gust = one_minus_cosine(start, duration);
  for (double& share : gust.share) share *= peak;
  return {LoadArgument::time, std::move(gust.points), std::move(gust.share)};
}

LoadHistory wind_load_history(const Aerodynamics& vehicle, const Wind& wind, const WindHistory& history,
                              const std::function<double(double)>& train_speed, double height) {
  std::vector<double> train;
  for (const double point : history.points) train.push_back(train_speed(point));
  const double top_speed = std::max({1e-9, *std::max_element(train.begin(), train.end()),
                                     *std::max_element(history.speed.begin(), history.speed.end())});
  require_yaw_angles(vehicle, wind, train, history.speed);
  std::vector<double> points;
  std::vector<ForceAndMoment> loads;
  const auto add = [&](double point, double train_at, double wind_at) {
    if (!points.empty() && point - points.back() < least_step) return;
    if (points.size() == most_points) {
      throw input_error(vehicle.source, fmt::format("a wind of {} rows that rises and falls", history.points.size()),
                        fmt::format("a load of at most {} points: fewer rows", most_points));
    }
    points.push_back(point);
    loads.push_back(wind_load(vehicle, wind, train_at, wind_at, height));
  };
  for (std::size_t i = 0; i + 1 < history.points.size(); ++i) {
    const double length = history.points[i + 1] - history.points[i];
    const double rise = history.speed[i + 1] - history.speed[i], gained = train[i + 1] - train[i];
    for (const double s : shares(vehicle, wind, {train[i], gained}, {history.speed[i], rise}, top_speed)) {
      add(history.points[i] + s * length, train[i] + s * gained, history.speed[i] + s * rise);
    }
  }
  add(history.points.back(), train.back(), history.speed.back());
  return {history.argument, std::move(points), std::move(loads)};
}

}  // namespace railtab
