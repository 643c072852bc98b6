#include "railtab/runtime/line/ground_motion.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

GroundMotion::GroundMotion(GroundRecord record) { stations_.push_back({0.0, std::move(record)}); }

GroundMotion::GroundMotion(GroundRecord record, double wave_speed, double origin) : GroundMotion(std::move(record)) {
  slowness_ = 1.0 / wave_speed;
  origin_ = origin;
}

GroundMotion::GroundMotion(std::vector<Station> stations) : stations_(std::move(stations)) {
  if (stations_.empty()) throw input_error("ground motion", "no station", "at least 1");
  for (std::size_t i = 1; i < stations_.size(); ++i) {
    if (stations_[i].x > stations_[i - 1].x) continue;
    throw input_error(fmt::format("ground motion, station {}", i + 1), fmt::format("x = {} m", stations_[i].x),
                      fmt::format("more than {} m of the station before", stations_[i - 1].x));
  }
}

GroundPoint GroundMotion::at(double x, double time) const noexcept {
  const auto after =
      std::upper_bound(stations_.begin(), stations_.end(), x, [](double a, const Station& s) { return a < s.x; });
  if (stations_.size() == 1 || after == stations_.begin() || after == stations_.end()) {
    const Station& nearest = after == stations_.begin() ? stations_.front() : stations_.back();
    GroundPoint point{nearest.record.at(time - slowness_ * (x - origin_))};
    point.slope = -slowness_ * point.velocity;
    point.slope_rate = -slowness_ * point.acceleration;
    point.curvature = slowness_ * slowness_ * point.acceleration;
    return point;
  }
  const Station& right = *after;
  const Station& left = *(after - 1);
  const double length = right.x - left.x, part = (x - left.x) / length;
  const GroundState a = left.record.at(time), b = right.record.at(time);
  GroundPoint point;
  point.displacement = (1.0 - part) * a.displacement + part * b.displacement;
  point.velocity = (1.0 - part) * a.velocity + part * b.velocity;
  point.acceleration = (1.0 - part) * a.acceleration + part * b.acceleration;
  point.slope = (b.displacement - a.displacement) / length;
  point.slope_rate = (b.velocity - a.velocity) / length;
  return point;
}

GroundVector GroundMotion::peak() const noexcept {
  GroundVector largest = GroundVector::Zero();
  for (const Station& station : stations_) largest = largest.cwiseMax(station.record.peak());
  return largest;
}

std::vector<double> GroundMotion::places() const {
  std::vector<double> x;
  if (slowness_ != 0.0) return x;
  for (const Station& station : stations_) x.push_back(station.x);
  return x;
}

Eigen::VectorXd GroundMotion::shares(double x) const {
  Eigen::VectorXd share = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(stations_.size()));
  std::size_t after = 0;
  while (after < stations_.size() && stations_[after].x <= x) ++after;
  if (after == 0 || after == stations_.size()) {
    share[after == 0 ? 0 : share.size() - 1] = 1.0;
    return share;
  }
  const double part = (x - stations_[after - 1].x) / (stations_[after].x - stations_[after - 1].x);
  share[static_cast<Eigen::Index>(after)] = part;
  share[static_cast<Eigen::Index>(after) - 1] = 1.0 - part;
  return share;
}

}  // namespace railtab
