#include "wheelset_functions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/constants.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

/// Whole multiples of `step` inside the curve.
std::vector<double> shifts(const RadiusDifferenceCurve& curve, double step) {
  std::vector<double> y;
  const double rounding = 1e-9 * step;
  for (double k = std::ceil((curve.y().front() - rounding) / step); k * step <= curve.y().back() + rounding; ++k) {
    y.push_back(std::clamp(k * step, curve.y().front(), curve.y().back()));
  }
  return y;
}

}  // namespace

std::optional<WheelsetFunctions> wheelset_functions(std::vector<WheelsetContact> contacts,
                                                    const WheelsetContactOptions& options) {
  if (contacts.size() < 2) return std::nullopt;
  RadiusDifferenceCurve curve(contacts);
  return WheelsetFunctions{options.roll, options.diameter_difference, std::move(contacts), std::move(curve)};
}

std::optional<WheelsetFunctions> wheelset_functions(const TableContact& table, WheelsetContactOptions options) {
  const GeometryTableData& data = table.table().data();
  if (!(data.lateral.low < 0.0 && data.lateral.high > 0.0)) return std::nullopt;
  options.y_low = data.lateral.low;
  options.y_high = data.lateral.high;
  const auto query = [&](const WheelsetPose& pose, double near_miss) { return table.patches(pose, near_miss); };
  return wheelset_functions(wheelset_contacts(query, table.search().pair(), options), options);
}

nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

const char* status_word(ConicityStatus status) {
  switch (status) {
    case ConicityStatus::found:
      return "found";
    case ConicityStatus::outside:
      return "outside the range";
    case ConicityStatus::no_wave:
      break;
  }
  return "no wave";
}

std::vector<double> conicity_amplitudes(const RadiusDifferenceCurve& curve) {
  std::vector<double> amplitudes;
  const double most = std::min(10.0 * mm, 0.5 * (curve.y().back() - curve.y().front()));
  for (int k = 1; k * 0.5 * mm <= most; ++k) amplitudes.push_back(k * 0.5 * mm);
  return amplitudes;
}

const WheelsetContact& nearest_contact(const WheelsetFunctions& functions, double y) {
  return *std::min_element(functions.contacts.begin(), functions.contacts.end(),
                           [&](const auto& a, const auto& b) { return std::abs(a.y - y) < std::abs(b.y - y); });
}

std::string conicity_text(const EquivalentConicity& conicity) {
  if (std::isfinite(conicity.tan_gamma)) return fmt::format("{:.4f}", conicity.tan_gamma);
  return status_word(conicity.status);
}

nlohmann::ordered_json conicity_json(const EquivalentConicity& conicity) {
  return {{"conicity", number_or_null(conicity.tan_gamma)},
          {"y_low", conicity.y_low},
          {"y_high", conicity.y_high},
          {"status", status_word(conicity.status)}};
}

nlohmann::ordered_json functions_json(const WheelsetFunctions& functions, const std::vector<double>& amplitudes) {
  nlohmann::ordered_json j;
  j["roll"] = functions.roll == WheelsetRoll::free ? "on" : "off";
  j["diameter_difference"] = functions.diameter_difference;
  const RadiusDifferenceCurve& curve = functions.radius_difference;
  nlohmann::ordered_json y, difference, amplitude, wave, regression;
  for (const double shift : shifts(curve, 0.1 * mm)) {
    y.push_back(shift);
    difference.push_back(curve.at(shift));
  }
  j["radius_difference"] = {{"y", y}, {"value", difference}};
  for (const double a : amplitudes) {
    amplitude.push_back(a);
    wave.push_back(number_or_null(conicity_of_wave(curve, a).tan_gamma));
    regression.push_back(number_or_null(conicity_of_regression(curve, a).tan_gamma));
  }
  j["conicity_curve"] = {{"amplitude", amplitude}, {"wave", wave}, {"regression", regression}};
  return j;
}

std::string functions_text(const WheelsetFunctions& functions, const std::vector<double>& amplitudes) {
  const RadiusDifferenceCurve& curve = functions.radius_difference;
  std::string text = fmt::format("\n{:>8}{:>12}{:>16}{:>16}{:>14}{:>14}\n", "y", "delta r", "|angle| left",
                                 "|angle| right", "radius left", "radius right");
  text += fmt::format("{:>8}{:>12}{:>16}{:>16}{:>14}{:>14}\n", "[mm]", "[mm]", "[mrad]", "[mrad]", "[mm]", "[mm]");
  const double excess = 0.25 * functions.diameter_difference;  // of the right wheel's radius over the nominal one
  for (const double y : shifts(curve, 1.0 * mm)) {
    const WheelsetContact& c = nearest_contact(functions, y);
    text += fmt::format("{:8.1f}{:12.4f}{:16.2f}{:16.2f}{:14.3f}{:14.3f}\n", y / mm, curve.at(y) / mm,
                        1e3 * std::abs(c.left.angle), 1e3 * std::abs(c.right.angle),
                        (c.left.rolling_radius - excess) / mm, (c.right.rolling_radius + excess) / mm);
  }
  text += fmt::format("\n{:>14}{:>22}{:>14}\n", "amplitude [mm]", "equivalent conicity", "regression");
  for (const double a : amplitudes) {
    text += fmt::format("{:14.1f}{:>22}{:>14}\n", a / mm, conicity_text(conicity_of_wave(curve, a)),
                        conicity_text(conicity_of_regression(curve, a)));
  }
  return text;
}

}  // namespace railtab
