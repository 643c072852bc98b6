#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/scene/judged_stretch.hpp"
#include "railtab/runtime/scene/scene_case.hpp"

// Deviations of the rails and speeds over time that the run does not meet, or that begin or end abruptly.

namespace railtab::scene {
namespace {

std::string file_name(const std::filesystem::path& file) { return file.filename().string(); }

void speed_beyond_run(const SceneCase& at, Warnings& list) {
  if (!at.model.speed_profile) return;
  const Interval profile{at.model.speed_profile->begin(), at.model.speed_profile->end()}, run{0.0, at.duration};
  // beyond its points the speed is constant: one that only touches the run changes nothing
  if (profile.low < run.high && run.low < profile.high) return;
  list.push_back(fmt::format("train.speed_file {} is specified for {}, the run is at {}: its {} speed holds throughout",
                             file_name(at.scene.train.speed_file), text(profile, "t", "s"), text(run, "t", "s"),
                             profile.low >= run.high ? "first" : "last"));
}

void spans_beyond_run(const SceneCase& at, Warnings& list) {
  if (!at.scene.span_deviation || at.scene.span_deviation->amplitude == 0.0) return;
  const SpanDeviationParameters& deviation = *at.scene.span_deviation;
  const double spans = deviation.shape == SpanDeviationShape::bending ? 2.0 : 1.0;
  const Interval turning{deviation.start, deviation.start + spans * deviation.span};
  if (turning.meets(at.wheels)) return;
  list.push_back(fmt::format("the spans of [span_deviation] turn at {}, the wheels run at {}", text(turning, "x", "m"),
                             text(at.wheels, "x", "m")));
}

/// Why a record moves no wheel; empty: it moves some.
std::string ineffective(const SceneCase& at) {
  if (at.model.irregularity.largest() == 0.0) return "is zero throughout: the track is perfect";
  constexpr double rounding = 5e-13;  // [m]
  const bool follows_mean = at.model.normal_contact == NormalContact::rigid;
  if (!follows_mean || at.model.irregularity.largest_mean_height() > rounding) return {};
  return "has no effect: with contact.normal = \"rigid\" wheelsets follow the mean of z_left and z_right, which is "
         "zero throughout";
}

void track_beyond_run(const SceneCase& at, Warnings& list) {
  if (!at.scene.irregularity) return;
  const Interval measured{at.model.irregularity.begin(), at.model.irregularity.end()};
  if (measured.meets(at.wheels) || !ineffective(at).empty()) return;
  list.push_back(fmt::format("irregularity.file {} is measured at {}, the wheels run at {}: their track is perfect",
                             file_name(*at.scene.irregularity), text(measured, "x", "m"), text(at.wheels, "x", "m")));
}

/// Outside a record the track is perfect: where one ends off zero, wheels meet a step.
void steps_at_ends(const SceneCase& at, Warnings& list) {
  if (!at.scene.irregularity) return;
  const VsiModel& model = at.model;
  constexpr double noticeable = 1e-4;  // [m]
  std::string steps;
  const auto step_at = [&](double x, std::string_view verb) {
    if (x < at.wheels.low || x > at.wheels.high) return;
    const RailDeviation left = model.irregularity.at(RailSide::left, x),
                        right = model.irregularity.at(RailSide::right, x);
    std::pair<std::string_view, double> largest{"", 0.0};
    for (const auto& column : {std::pair<std::string_view, double>{"y_left", left.y},
                               {"z_left", left.z},
                               {"y_right", right.y},
                               {"z_right", right.z}}) {
      if (std::abs(column.second) > std::abs(largest.second)) largest = column;
    }
    if (std::abs(largest.second) <= noticeable) return;
    steps += fmt::format("{}{} at x = {:.6g} m with {} = {:.3g} mm", steps.empty() ? "" : " and ", verb, x,
                         largest.first, 1e3 * largest.second);
  };
  step_at(model.irregularity.begin(), "begins");
  step_at(model.irregularity.end(), "ends");
  if (steps.empty() || !ineffective(at).empty()) return;
  list.push_back(fmt::format(
      "irregularity.file {} {}, not with zero: {}; fade the record in and out, or let it reach beyond the run",
      file_name(*at.scene.irregularity), steps,
      model.normal_contact == NormalContact::rigid
          ? "wheels that follow the rails jump there, without the force that it would take"
          : "wheels meet a step there, whose force grows without bound as integration.time_step shrinks"));
}

/// What no track in service has, of one column of an irregularity file; empty where it may be of a track.
std::string implausible(const FileColumn& x, const FileColumn& column) {
  constexpr double largest = 0.1, largest_rms = 0.02, steepest = 0.2;  // [m], [m], [-]
  const std::vector<UnitFactor> lengths{{"m", 1.0}, {"mm", 1e-3}};
  const double unit = factor_to_si(column, lengths), along = factor_to_si(x, lengths);
  const std::vector<double>& v = column.values;
  std::size_t peak = 0, steep = 1;
  double sum = 0.0;
  const auto slope = [&](std::size_t i) {
    return unit * std::abs(v[i] - v[i - 1]) / (along * (x.values[i] - x.values[i - 1]));
  };
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (std::abs(v[i]) > std::abs(v[peak])) peak = i;
    if (i > 0 && slope(i) > slope(steep)) steep = i;
    sum += unit * unit * v[i] * v[i];
  }
  const double rms = std::sqrt(sum / static_cast<double>(v.size()));
  const std::string other = fmt::format("is the column in {}, not in {}", unit < 1.0 ? "um" : "mm", column.unit);
  if (unit * std::abs(v[peak]) > largest) {
    return fmt::format("{} is {:.4g} mm at x = {:.6g} m, tracks stay within {:g} mm: {}?", column.name,
                       1e3 * unit * v[peak], along * x.values[peak], 1e3 * largest, other);
  }
  if (rms > largest_rms) {
    return fmt::format(
        "{} has an rms of {:.3g} mm, its largest value is {:.4g} mm at x = {:.6g} m, tracks stay below "
        "an rms of {:g} mm: {}?",
        column.name, 1e3 * rms, 1e3 * unit * v[peak], along * x.values[peak], 1e3 * largest_rms, other);
  }
  if (slope(steep) > steepest) {
    return fmt::format("{} has a slope of {:.3g} at x = {:.6g} m, no wheel follows more than {:g}: {}, or x not in {}?",
                       column.name, slope(steep), along * x.values[steep], steepest, other, x.unit);
  }
  return {};
}

void too_large(const SceneCase& at, Warnings& list) {
  if (!at.scene.irregularity) return;
  const std::vector<FileColumn> columns = read_columns(*at.scene.irregularity);
  for (std::size_t c = 1; c < columns.size(); ++c) {
    const std::string fault = implausible(columns[0], columns[c]);
    if (fault.empty()) continue;
    list.push_back(fmt::format("irregularity.file {}: {}", file_name(*at.scene.irregularity), fault));
    return;  // a wrong unit is most likely that of all columns
  }
}

/// Whether the speed changes during the run.
bool changes_speed(const SceneCase& at) {
  constexpr double constant = 1e-3;  // of the speed
  if (!at.model.speed_profile) return false;
  const SpeedProfile& profile = *at.model.speed_profile;
  double lowest = profile.speed(0.0), highest = lowest;
  for (const double time : profile.points()) {  // between them the speed is linear
    const double speed = profile.speed(std::clamp(time, 0.0, at.duration));
    lowest = std::min(lowest, speed);
    highest = std::max(highest, speed);
  }
  return highest - lowest > constant * highest;
}

void without_brakes(const SceneCase& at, Warnings& list) {
  if (!changes_speed(at)) return;
  constexpr Eigen::Index about_axle = 4;
  const std::vector<int>& wheelsets = at.model.vehicle.wheelsets;
  bool on_wheelsets = false, on_others = false;
  for (const BodyLoad& load : at.model.loads) {
    if (!load.history.acting()[about_axle]) continue;
    for (const int body : load.bodies) {
      const bool wheelset = std::find(wheelsets.begin(), wheelsets.end(), body) != wheelsets.end();
      (wheelset ? on_wheelsets : on_others) = true;
    }
  }
  const std::string file = file_name(at.scene.train.speed_file);
  if (!on_wheelsets) {
    list.push_back(fmt::format(
        "train.speed_file {} changes the speed by forces on the car bodies at their centres of gravity, which load "
        "the rear of a train that brakes; brakes and traction are [[load]]s: My on every wheelset, positive for "
        "brakes, and on each bogie the opposite of the sum over its wheelsets",
        file));
  } else if (!on_others) {
    list.push_back(fmt::format(
        "train.speed_file {}: [[load]]s turn wheelsets by My and no other body: a brake or drive torque needs its "
        "reaction, the opposite My on the bogie that carries the brakes; without it the loads of a bogie's wheelsets "
        "change too little",
        file));
  }
}

void judged_beyond_run(const SceneCase& at, Warnings& list) {
  const std::vector<double> judged = judged_stretch(at.scene);
  if (judged.empty() || Interval{judged[0], judged[1]}.meets(at.wheels)) return;
  list.push_back(
      fmt::format("judging begins at x = {:.6g} m ({}), the wheels run at {}: no wheel and no car body is judged",
                  judged[0], at.scene.assessment.begin ? "assessment.begin" : "train.start + irregularity.fade_in",
                  text(at.wheels, "x", "m")));
}

}  // namespace

const Warning judging_outside_run{"no wheel runs where it is judged", judged_beyond_run};
const Warning speed_outside_run{"the speeds lie outside the run", speed_beyond_run};
const Warning speed_without_brakes{
    "the speed changes, and no My acts on wheelsets, or none acts on other bodies as its reaction", without_brakes};
const Warning deviation_zero{"it is 0", [](const SceneCase& at, Warnings& list) {
                               if (!at.scene.span_deviation || at.scene.span_deviation->amplitude != 0.0) return;
                               list.emplace_back("span_deviation.amplitude is 0: no span turns");
                             }};
const Warning deviation_outside_run{"no wheel runs over the spans that turn", spans_beyond_run};
const Warning irregularity_zero{
    "the record is zero throughout; with contact.normal = \"rigid\", the mean of z_left and z_right is zero throughout",
    [](const SceneCase& at, Warnings& list) {
      if (!at.scene.irregularity) return;
      const std::string why = ineffective(at);
      if (!why.empty()) list.push_back(fmt::format("irregularity.file {} {}", file_name(*at.scene.irregularity), why));
    }};
const Warning irregularity_outside_run{"no wheel runs over the record", track_beyond_run};
const Warning irregularity_with_step{"the record begins or ends under the wheels more than 0.1 mm off zero",
                                     steps_at_ends};
const Warning irregularity_too_large{"a value is above 100 mm, the rms of a column above 20 mm, or a slope above 0.2",
                                     too_large};

}  // namespace railtab::scene
