#include "conicity_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "railtab/runtime/base/constants.hpp"

namespace railtab {

namespace {

constexpr std::array bearer_names = {"wheels", "rails", "both"};

bool inside(double position) { return std::abs(position) <= 1.0; }

int count_inside(const ConicityRuns& runs, std::size_t amplitude, double reference, const ConicityLimits& limits) {
  return static_cast<int>(std::count_if(runs.begin(), runs.end(), [&](const std::vector<double>& run) {
    return inside(band_position(run[amplitude], reference, limits));
  }));
}

void set_errors(const ConicityRequest& request, const std::array<ConicityRuns, 3>& runs, std::size_t amplitude,
                ConicityPoint& point) {
  for (std::size_t bearer = 0; bearer < runs.size(); ++bearer) {
    point.errors[bearer] = run_statistics(runs[bearer], amplitude);
    if (request.reference.empty()) continue;
    const ConicityBand& band = request.reference[amplitude];
    point.inside_narrow[bearer] = count_inside(runs[bearer], amplitude, band.reference, band.narrow);
    point.inside_wide[bearer] = count_inside(runs[bearer], amplitude, band.reference, band.wide);
  }
}

/// The point farthest from the reference, and how many lie outside.
struct BandSummary {
  double position = 0.0, amplitude = 0.0;
  int outside = 0;
};

BandSummary band_summary(const std::vector<ConicityPoint>& points, double ConicityPoint::*position) {
  BandSummary summary;
  for (const ConicityPoint& point : points) {
    const double p = point.*position;
    if (!inside(p)) ++summary.outside;
    if (std::abs(p) > std::abs(summary.position)) summary = {p, point.amplitude, summary.outside};
  }
  return summary;
}

nlohmann::ordered_json column(const std::vector<ConicityPoint>& points, double ConicityPoint::*member) {
  nlohmann::ordered_json values = nlohmann::ordered_json::array();
  for (const ConicityPoint& point : points) values.push_back(number_or_null(point.*member));
  return values;
}

nlohmann::ordered_json summary_json(const BandSummary& summary) {
  return {{"outside", summary.outside},
          {"farthest", number_or_null(summary.position)},
          {"farthest_amplitude", summary.amplitude}};
}

nlohmann::ordered_json reference_json(const ConicityRequest& request, const std::vector<ConicityPoint>& points) {
  nlohmann::ordered_json reference = nlohmann::ordered_json::array();
  for (const ConicityBand& band : request.reference) reference.push_back(band.reference);
  return {{"conicity", reference},
          {"narrow_position", column(points, &ConicityPoint::narrow)},
          {"wide_position", column(points, &ConicityPoint::wide)},
          {"narrow", summary_json(band_summary(points, &ConicityPoint::narrow))},
          {"wide", summary_json(band_summary(points, &ConicityPoint::wide))}};
}

const char* direction_word(ErrorDirection direction) {
  if (direction == ErrorDirection::y) return "y";
  return direction == ErrorDirection::z ? "z" : "both";
}

nlohmann::ordered_json bearer_json(const ConicityRequest& request, const std::vector<ConicityPoint>& points,
                                   std::size_t bearer) {
  nlohmann::ordered_json j;
  for (const ConicityPoint& point : points) {
    const RunStatistics& s = point.errors[bearer];
    j["found"].push_back(s.found);
    j["mean"].push_back(number_or_null(s.mean));
    j["standard_deviation"].push_back(number_or_null(s.standard_deviation));
    j["min"].push_back(number_or_null(s.least));
    j["max"].push_back(number_or_null(s.greatest));
    if (request.reference.empty()) continue;
    j["inside_narrow"].push_back(point.inside_narrow[bearer]);
    j["inside_wide"].push_back(point.inside_wide[bearer]);
  }
  return j;
}

nlohmann::ordered_json errors_json(const ConicityRequest& request, const std::vector<ConicityPoint>& points) {
  const ConicityErrorOptions& options = *request.errors;
  nlohmann::ordered_json j{{"random_error", options.errors.deviation},
                           {"grid", options.errors.grid},
                           {"spacing", options.errors.spacing},
                           {"direction", direction_word(options.errors.direction)},
                           {"smoothing", options.smoothing},
                           {"runs", options.runs},
                           {"seed", options.seed},
                           {"amplitude", column(points, &ConicityPoint::amplitude)}};
  for (std::size_t bearer = 0; bearer < bearer_names.size(); ++bearer) {
    j[bearer_names[bearer]] = bearer_json(request, points, bearer);
  }
  return j;
}

std::string decimals(double value, int count) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, count) : "-";
}

std::string reference_text(const ConicityRequest& request, const std::vector<ConicityPoint>& points) {
  std::string text = fmt::format("\n{:>14}{:>11}{:>12}{:>17}{:>15}\n", "amplitude [mm]", "reference", "conicity",
                                 "narrow position", "wide position");
  for (std::size_t i = 0; i < points.size(); ++i) {
    text +=
        fmt::format("{:14.1f}{:11.3f}{:>12}{:>17}{:>15}\n", points[i].amplitude / mm, request.reference[i].reference,
                    conicity_text(points[i].wave), decimals(points[i].narrow, 2), decimals(points[i].wide, 2));
  }
  for (const auto& [name, position] : {std::pair{"narrow", &ConicityPoint::narrow}, {"wide", &ConicityPoint::wide}}) {
    const BandSummary summary = band_summary(points, position);
    text += fmt::format("{} band: {} of {} amplitudes outside, farthest position {:+.2f} at {:.1f} mm\n", name,
                        summary.outside, points.size(), summary.position, summary.amplitude / mm);
  }
  return text;
}

std::string errors_text(const ConicityRequest& request, const std::vector<ConicityPoint>& points) {
  std::string text;
  for (std::size_t bearer = 0; bearer < bearer_names.size(); ++bearer) {
    text += fmt::format("\nerrors of {}: {} runs\n{:>14}{:>8}{:>9}{:>9}{:>9}{:>9}\n", bearer_names[bearer],
                        request.errors->runs, "amplitude [mm]", "found", "mean", "st. dev.", "min", "max");
    for (const ConicityPoint& point : points) {
      const RunStatistics& s = point.errors[bearer];
      text += fmt::format("{:14.1f}{:8d}{:>9}{:>9}{:>9}{:>9}\n", point.amplitude / mm, s.found, decimals(s.mean, 4),
                          decimals(s.standard_deviation, 4), decimals(s.least, 4), decimals(s.greatest, 4));
    }
  }
  return text;
}

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

}  // namespace

std::vector<ConicityPoint> conicity_points(const ConicityRequest& request, const WheelsetFunctions& functions,
                                           const std::array<ConicityRuns, 3>& runs) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<ConicityPoint> points;
  for (std::size_t i = 0; i < request.amplitudes.size(); ++i) {
    const RadiusDifferenceCurve& curve = functions.radius_difference;
    const double amplitude = request.amplitudes[i];
    ConicityPoint point{
        amplitude, conicity_of_wave(curve, amplitude), conicity_of_regression(curve, amplitude), none, none, {}};
    if (!request.reference.empty()) {
      const ConicityBand& band = request.reference[i];
      point.narrow = band_position(point.wave.tan_gamma, band.reference, band.narrow);
      point.wide = band_position(point.wave.tan_gamma, band.reference, band.wide);
    }
    if (request.errors) set_errors(request, runs, i, point);
    points.push_back(point);
  }
  return points;
}

nlohmann::ordered_json points_json(const ConicityRequest& request, const std::vector<ConicityPoint>& points) {
  nlohmann::ordered_json j = nlohmann::ordered_json::object();
  if (!request.reference.empty()) j["reference"] = reference_json(request, points);
  if (request.errors) j["errors"] = errors_json(request, points);
  return j;
}

std::string points_text(const ConicityRequest& request, const std::vector<ConicityPoint>& points) {
  return (request.reference.empty() ? "" : reference_text(request, points)) +
         (request.errors ? errors_text(request, points) : "");
}

std::string points_csv(const ConicityRequest& request, const std::vector<ConicityPoint>& points) {
  std::string text = fmt::format("{},y_low,y_high,status", conicity_csv_mark);
  if (!request.reference.empty()) text += ",narrow_position,wide_position";
  if (request.errors) {
    for (const char* name : bearer_names) {
      for (const char* value : {"found", "mean", "standard_deviation", "min", "max"}) {
        text += fmt::format(",{}_{}", name, value);
      }
    }
  }
  text += '\n';
  for (const ConicityPoint& p : points) {
    text += fmt::format("{},{},{},{},{},{}", p.amplitude, cell(p.wave.tan_gamma), cell(p.regression.tan_gamma),
                        p.wave.y_low, p.wave.y_high, status_word(p.wave.status));
    if (!request.reference.empty()) text += fmt::format(",{},{}", cell(p.narrow), cell(p.wide));
    if (request.errors) {
      for (const RunStatistics& s : p.errors) {
        text += fmt::format(",{},{},{},{},{}", s.found, cell(s.mean), cell(s.standard_deviation), cell(s.least),
                            cell(s.greatest));
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace railtab
