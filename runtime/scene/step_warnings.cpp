#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/scene/scene_case.hpp"
#include "railtab/runtime/scene/scene_wheels.hpp"

// Steps and records too far apart for what the scene describes.

namespace railtab::scene {
namespace {

/// The first natural period of the span that has the shortest, as a simply supported beam; 0: no span.
double shortest_first_period(const SceneCase& at) {
  double shortest = 0.0;
  for (const BridgeParameters& span : at.scene.spans) {
    const double period = 1.0 / first_frequency(span);
    shortest = shortest == 0.0 ? period : std::min(shortest, period);
  }
  return shortest;
}

/// The longest step that a part of the scene allows.
struct StepLimit {
  double longest;     ///< [s]
  std::string found;  ///< the step beside that part
};

struct CurvePoint {
  double value, slope;
};

/// What the rms slope of a curve loses, from 0 to 1, where only points one travel [m] apart are known of it: of a wave
/// of length L it leaves |sin(π travel/L)|/(π travel/L). The means are over places at multiples of the golden ratio,
/// modulo the stretch: they are nearly even and keep step with no wave. 0 where the stretch is shorter than the travel.
template <class Curve>
double lost_slope(const Curve& curve, const Interval& stretch, double travel) {
  constexpr int places = 4000;
  const double length = stretch.high - travel - stretch.low;
  if (!(travel > 0.0 && length > 0.0)) return 0.0;
  double slopes = 0.0, chords = 0.0;
  for (int i = 0; i < places; ++i) {
    const double x = stretch.low + length * std::fmod(i / std::numbers::phi, 1.0);
    const CurvePoint here = curve(x), next = curve(x + travel);
    const double chord = (next.value - here.value) / travel;
    slopes += here.slope * here.slope;
    chords += chord * chord;
  }
  return slopes > 0.0 ? 1.0 - std::sqrt(chords / slopes) : 0.0;
}

/// Those of all parts.
class StepLimits {
 public:
  explicit StepLimits(const SceneCase& at)
      : step_(at.scene.integration.time_step), speed_(highest_speed(at)), travel_(step_ * speed_) {}

  /// Travel within a share of a length.
  void add_length(double share, double length, std::string_view name) {
    limits_.push_back({share * length / speed_, fmt::format("{:.3g} m long, {} is {:.3g} m", travel_, name, length)});
  }
  void add_period(double share, double period, std::string_view name) {
    limits_.push_back({share * period, fmt::format("{:.3g} s long, {} is {:.3g} s", step_, name, period)});
  }
  /// Travel that loses little of the slope of a curve over the way of a wheel. A shorter step is found by halving.
  template <class Curve>
  void add_curve(const Curve& curve, const Interval& stretch, std::string_view name) {
    constexpr double most = 0.05;
    constexpr int halvings = 20;
    const double lost = lost_slope(curve, stretch, travel_);
    if (lost <= most) return;
    double step = 0.5 * step_;
    for (int i = 1; i < halvings && lost_slope(curve, stretch, step * speed_) > most; ++i) step *= 0.5;
    limits_.push_back({step, fmt::format("{:.3g} m long, points so far apart lose {:.0f} % of the rms slope of {}",
                                         travel_, 100.0 * lost, name)});
  }

  /// A warning of the part that needs the shortest step.
  void warn(Warnings& list) const {
    const auto least = std::min_element(limits_.begin(), limits_.end(),
                                        [](const StepLimit& a, const StepLimit& b) { return a.longest < b.longest; });
    constexpr double rounding = 1.0 + 1e-9;
    if (least == limits_.end() || step_ <= rounding * least->longest) return;
    const double digit = std::pow(10.0, std::floor(std::log10(least->longest)) - 1.0);  // the second one
    list.push_back(fmt::format(
        "integration.time_step = {:g} s: a step is {}: forces and accelerations of so short waves are wrong or "
        "missing; use at most {:.2g} s",
        step_, least->found, digit * std::floor(rounding * least->longest / digit)));
  }

 private:
  double step_, speed_, travel_;
  std::vector<StepLimit> limits_;
};

/// Of the wheels that an entry of [[wheel]] means [m].
double smallest_radius(const SceneCase& at, const WheelParameters& entry) {
  const std::vector<PlaceInTrain> places = wheelset_places(at.model);
  double smallest = INFINITY;
  for (int w = 0; w < at.model.wheelsets(); ++w) {
    const PlaceInTrain& place = places[static_cast<std::size_t>(w)];
    const bool meant =
        (entry.coach == 0 || entry.coach == place.coach) && (entry.wheelset == 0 || entry.wheelset == place.wheelset);
    if (meant) smallest = std::min(smallest, at.model.wheel_radius(w));
  }
  return smallest;
}

void add_wheels(const SceneCase& at, StepLimits& limits) {
  // steps are divided where a wheel with a profile lands behind a flat
  const double share_of_flat = at.model.normal_contact == NormalContact::rigid ? 0.25 : 0.5;
  for (std::size_t i = 0; i < at.scene.wheels.size(); ++i) {
    const WheelParameters& entry = at.scene.wheels[i];
    const std::string place = fmt::format("[[wheel]] {} of {}", i + 1, at.scene.wheels.size());
    const double radius = smallest_radius(at, entry), turn = 2.0 * std::numbers::pi * radius;
    if (entry.flat.length > 0.0) limits.add_length(share_of_flat, entry.flat.length, "the flat of " + place);
    if (entry.polygon.amplitude != 0.0) {
      limits.add_length(0.25, turn / entry.polygon.order, "a wave of the polygon of " + place);
    }
    if (entry.file.empty()) continue;
    const WheelDeviation wheel(radius, {}, {}, read_wheel_contour(entry.file));
    limits.add_curve(
        [&](double x) {
          const WheelRise rise = wheel.at(x / radius);
          return CurvePoint{rise.rise, rise.slope / radius};
        },
        {0.0, turn}, fmt::format("wheel.file {} of {}", entry.file.filename().string(), place));
  }
}

/// Of the columns of an irregularity file that move wheels, where these run.
void add_irregularity(const SceneCase& at, StepLimits& limits) {
  const Irregularity& track = at.model.irregularity;
  if (!at.scene.irregularity || track.empty()) return;
  const Interval stretch{std::max(track.begin(), at.wheels.low), std::min(track.end(), at.wheels.high)};
  const std::string file = "irregularity.file " + at.scene.irregularity->filename().string();
  if (at.model.normal_contact == NormalContact::rigid) {
    limits.add_curve(
        [&](double x) {
          const RailDeviation left = track.at(RailSide::left, x), right = track.at(RailSide::right, x);
          return CurvePoint{0.5 * (left.z + right.z), 0.5 * (left.dz_dx + right.dz_dx)};
        },
        stretch, file);
    return;
  }
  for (const RailSide side : {RailSide::left, RailSide::right}) {
    const std::string_view name = side == RailSide::left ? "left" : "right";
    const auto lateral = [&](double x) {
      const RailDeviation rail = track.at(side, x);
      return CurvePoint{rail.y, rail.dy_dx};
    };
    const auto vertical = [&](double x) {
      const RailDeviation rail = track.at(side, x);
      return CurvePoint{rail.z, rail.dz_dx};
    };
    limits.add_curve(lateral, stretch, fmt::format("y_{} in {}", name, file));
    limits.add_curve(vertical, stretch, fmt::format("z_{} in {}", name, file));
  }
}

}  // namespace

const Warning steps_too_long{
    "in a step the train travels more than half the distance between sleepers, a quarter of the shortest wave of a "
    "random track or of a polygon, or half a flat (a quarter with contact.normal = \"rigid\"); points one step apart "
    "lose more than 5 % of the rms slope of irregularity.file or wheel.file; the step is longer than a tenth of a "
    "span's "
    "first natural period",
    [](const SceneCase& at, Warnings& list) {
      StepLimits limits(at);
      if (at.scene.track_kind == TrackKind::flexible) {
        limits.add_length(0.5, at.scene.track.sleeper_spacing, "the distance between sleepers");
      }
      if (at.scene.spectrum) limits.add_length(0.25, at.scene.spectrum->shortest, "the shortest wave of the track");
      if (const double period = shortest_first_period(at); period > 0.0) {
        limits.add_period(0.1, period, "the first natural period of a span");
      }
      add_wheels(at, limits);
      add_irregularity(at, limits);
      limits.warn(list);
    }};

const Warning records_too_few{
    "records are further apart than an eighth of a span's first natural period, or than 0.05 s",
    [](const SceneCase& at, Warnings& list) {
      constexpr double longest = 0.05;  // [s] for car bodies, at some ten hertz
      const double interval = at.scene.output.every * at.scene.integration.time_step;
      const double period = shortest_first_period(at), limit = period > 0.0 ? std::min(period / 8.0, longest) : longest;
      if (interval <= limit) return;
      list.push_back(
          fmt::format("output.every: records are {:.3g} s apart, more than {:.3g} s: largest accelerations and "
                      "displacements of deck and car bodies lie between them and are missed",
                      interval, limit));
    }};

}  // namespace railtab::scene
