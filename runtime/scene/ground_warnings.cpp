#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/scene/scene_case.hpp"
#include "railtab/runtime/scene/scene_loads.hpp"

// Ground motion that moves nothing, or of which something is left out.

namespace railtab::scene {
namespace {

std::string place_of_motion(const SceneCase& at, std::size_t index) {
  return fmt::format("[[ground_motion]] {} of {}", index + 1, at.scene.ground_motion.size());
}

bool moves(const SceneCase& at, std::size_t index) {
  return at.scene.ground_motion[index].factor != 0.0 && !at.records[index].given_peak().isZero(0.0);
}

/// The stretch of x that a station's record has a share in.
Interval reach_of_station(const std::vector<GroundMotionParameters>& stations, std::size_t index) {
  return {index == 0 ? -INFINITY : stations[index - 1].x,
          index + 1 == stations.size() ? INFINITY : stations[index + 1].x};
}

/// Where the ground moves something: wheels, and supports of the structure.
Interval ground_way(const VsiModel& model, Interval way) {
  if (!model.structure) return way;
  for (const double x : model.structure->supports.x) way = {std::min(way.low, x), std::max(way.high, x)};
  return way;
}

std::optional<std::string> of_drift_correction(const GroundRecord& record, const std::string& place) {
  constexpr double noticeable = 0.1;  // of the peak: real records need a few per cent
  std::string parts;
  for (Eigen::Index k = 0; k < 2; ++k) {
    const double given = record.given_peak()[k], added = record.drift_correction()[k];
    if (added <= noticeable * given) continue;
    parts += fmt::format("{}{}: up to {:.3g} m/s² added to a peak of {:.3g} m/s², which is {:.3g} m/s² then ({:.0f} %)",
                         parts.empty() ? "" : "; ", k == 0 ? "y" : "z", added, given, record.peak()[k],
                         100.0 * record.peak()[k] / given);
  }
  if (parts.empty()) return std::nullopt;
  return fmt::format(
      "{}: the straight line that lets the ground end at rest where it began changes the record ({}); check that the "
      "record is complete, and an acceleration",
      place, parts);
}

/// Where the curve through displacements leaves the range of the points around, by a share of the record's range.
struct Swing {
  double time = 0.0, share = 0.0;  ///< [s], [-]
};

/// The largest of one column, at quarters of the intervals between its points. The range around an interval is that of
/// its ends and of the points before and after it.
Swing largest_swing(const GroundRecord& record, const std::vector<double>& t, const std::vector<double>& value,
                    double unit, Eigen::Index component) {
  const auto [lowest, highest] = std::minmax_element(value.begin(), value.end());
  const double range = *highest - *lowest;
  Swing largest;
  if (range == 0.0) return largest;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const auto first = value.begin() + static_cast<std::ptrdiff_t>(i == 0 ? 0 : i - 1);
    const auto last = value.begin() + static_cast<std::ptrdiff_t>(std::min(i + 3, value.size()));
    const auto [low, high] = std::minmax_element(first, last);
    for (const double quarter : {0.25, 0.5, 0.75}) {
      const double time = t[i] + quarter * (t[i + 1] - t[i]);
      const double v = value.front() + record.at(time).displacement[component] / unit;  // counted from the first point
      const double share = std::max(*low - v, v - *high) / range;
      if (share > largest.share) largest = {time, share};
    }
  }
  return largest;
}

}  // namespace

const Warning ground_at_rest{
    "the factor or the record is zero", [](const SceneCase& at, Warnings& list) {
      for (std::size_t i = 0; i < at.records.size(); ++i) {
        if (moves(at, i)) continue;
        const bool by_factor = at.scene.ground_motion[i].factor == 0.0;
        list.push_back(place_of_motion(at, i) +
                       (by_factor ? " is multiplied by ground_motion.factor = 0: the ground stays at rest"
                                  : " is zero throughout: the ground stays at rest"));
      }
    }};

const Warning ground_too_strong{
    "the peak is above 20 m/s² with the factor", [](const SceneCase& at, Warnings& list) {
      constexpr double strongest = 20.0;  // [m/s²]: no record of an earthquake has twice gravity
      for (std::size_t i = 0; i < at.records.size(); ++i) {
        const double factor = std::abs(at.scene.ground_motion[i].factor);
        const double peak = factor * at.records[i].given_peak().maxCoeff();
        if (peak <= strongest) continue;
        list.push_back(
            fmt::format("{} has a peak of {:.3g} m/s² with ground_motion.factor = {:g}: are file and factor in "
                        "these units?",
                        place_of_motion(at, i), peak, at.scene.ground_motion[i].factor));
      }
    }};

const Warning ground_with_gap{"two points lie more than twenty times as far apart as most",
                              [](const SceneCase& at, Warnings& list) {
                                constexpr double gap = 20.0;
                                for (std::size_t i = 0; i < at.records.size(); ++i) {
                                  const auto [begin, length, usual] = at.records[i].longest_interval();
                                  if (length <= gap * usual) continue;
                                  list.push_back(
                                      fmt::format("{} has no point from t = {:.6g} to {:.6g} s, where most are {:.3g} "
                                                  "s apart: the curve between is made up; is "
                                                  "the record complete?",
                                                  place_of_motion(at, i), begin, begin + length, usual));
                                }
                              }};

const Warning ground_with_swing{
    "the curve through displacements leaves the points around by more than a fifth of their range",
    [](const SceneCase& at, Warnings& list) {
      constexpr double noticeable = 0.2;  // evenly spaced points of a smooth motion, five per period: 0.07
      for (std::size_t i = 0; i < at.records.size(); ++i) {
        const std::vector<FileColumn> columns = read_columns(at.scene.ground_motion[i].file);
        for (std::size_t c = 1; c < columns.size(); ++c) {
          if (columns[c].unit != "m" && columns[c].unit != "mm") continue;  // accelerations have straight lines between
          const Swing swing =
              largest_swing(at.records[i], columns[0].values, columns[c].values,
                            factor_to_si(columns[c], {{"m", 1.0}, {"mm", 1e-3}}), columns[c].name == "y" ? 0 : 1);
          if (swing.share <= noticeable) continue;
          list.push_back(fmt::format(
              "{}: the curve through the displacements {} swings out of the points around t = {:.6g} s by {:.0f} % of "
              "their range; give points at even intervals, or accelerations",
              place_of_motion(at, i), columns[c].name, swing.time, 100.0 * swing.share));
        }
      }
    }};

const Warning ground_drift{"the drift correction changes a record by more than a tenth of its peak",
                           [](const SceneCase& at, Warnings& list) {
                             for (std::size_t i = 0; i < at.records.size(); ++i) {
                               if (!moves(at, i)) continue;
                               auto corrected = of_drift_correction(at.records[i], place_of_motion(at, i));
                               if (corrected) list.push_back(std::move(*corrected));
                             }
                           }};

const Warning ground_lateral_motion{
    "a record moves along y with contact.normal = \"rigid\"", [](const SceneCase& at, Warnings& list) {
      constexpr double rounding = 1e-12;  // of the correction of a constant
      if (vehicle_plane(at.scene) != MotionPlane::vertical) return;
      for (std::size_t i = 0; i < at.records.size(); ++i) {
        if (at.records[i].peak()[0] <= rounding * at.records[i].given_peak()[0]) continue;
        list.push_back(place_of_motion(at, i) +
                       (lateral_ground_is_left_out(at.scene)
                            ? " moves the ground along y too: nothing in a vertical scene follows it"
                            : " moves the ground along y: the structure follows it, the train, whose "
                              "wheels follow the rails vertically, does not"));
      }
    }};

const Warning ground_after_run{
    "the record begins after the run", [](const SceneCase& at, Warnings& list) {
      for (std::size_t i = 0; i < at.records.size(); ++i) {
        const double begin = at.records[i].begin() + at.scene.ground_motion[i].start;
        if (begin < at.duration) continue;
        list.push_back(fmt::format("{} begins at t = {:.6g} s, the run ends at {:.6g} s: the ground stays at rest",
                                   place_of_motion(at, i), begin, at.duration));
      }
    }};

const Warning ground_moves_nothing{
    "no wheel and no support is near the station", [](const SceneCase& at, Warnings& list) {
      const Interval moved = ground_way(at.model, at.wheels);
      if (at.records.size() < 2) return;
      for (std::size_t i = 0; i < at.records.size(); ++i) {
        if (reach_of_station(at.scene.ground_motion, i).meets(moved)) continue;
        list.push_back(fmt::format("{}, at x = {:.6g} m, moves nothing: wheels and supports are at {}",
                                   place_of_motion(at, i), at.scene.ground_motion[i].x, text(moved, "x", "m")));
      }
    }};

}  // namespace railtab::scene
