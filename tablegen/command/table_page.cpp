#include "table_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "railtab/runtime/base/constants.hpp"
#include "railtab/runtime/report/chart.hpp"
#include "railtab/runtime/report/html_page.hpp"
#include "railtab/runtime/report/html_text.hpp"

namespace railtab {

namespace {

constexpr double clearance = 14.0;   // between wheel and rail, drawn apart [mm]
constexpr double margin = 3.0;       // around the picture [mm]
constexpr double rail_depth = 34.0;  // of the head shown [mm]

std::string outline(const ProfileKnots& k, double shift_y, double shift_z, double deepest) {
  std::string data;
  for (std::size_t i = 0; i < k.y.size(); i += 2) {
    if (k.z[i] / mm > deepest) continue;
    fmt::format_to(std::back_inserter(data), "{:.2f},{:.2f} ", k.y[i] / mm + shift_y, k.z[i] / mm + shift_z);
  }
  return data;
}

/// The right wheel above its rail, each pair of touching points joined by a line, one per millimetre of lateral shift.
std::string contact_lines(const WheelRailPair& pair, const WheelsetFunctions& functions, bool right) {
  const double shift = (pair.tape_circle_offset() - pair.rail_offset()) / mm;
  const auto [wheel_low, wheel_high] =
      std::minmax_element(pair.wheel().knots().y.begin(), pair.wheel().knots().y.end());
  const double top = *std::min_element(pair.wheel().knots().z.begin(), pair.wheel().knots().z.end()) / mm;
  const double x0 = std::min(*wheel_low / mm + shift, pair.rail().knots().y.front() / mm) - margin;
  const double x1 = std::max(*wheel_high / mm + shift, pair.rail().knots().y.back() / mm) + margin;
  const double y0 = top - clearance - margin - 4.0;
  std::string lines, labels;
  for (double k = std::ceil(functions.contacts.front().y / mm); k * mm <= functions.contacts.back().y; ++k) {
    const WheelsetContact& c = nearest_contact(functions, k * mm);
    const ContactPatch& p = right ? c.right : c.left;
    const double x = p.y_wheel / mm + shift;
    fmt::format_to(std::back_inserter(lines), "M{:.2f} {:.2f}L{:.2f} {:.2f}", x, p.z_wheel / mm - clearance,
                   p.y_rail / mm, p.z_rail / mm);
  }
  const double left = right ? x0 : -x1;
  const double bottom = rail_depth + margin;
  std::string svg = fmt::format(
      "<svg class=\"profiles\" viewBox=\"{:.1f} {:.1f} {:.1f} {:.1f}\" role=\"img\" aria-label=\"contact positions\">"
      "<g transform=\"scale({} 1)\"><polyline points=\"{}\"/><polyline points=\"{}\"/><path class=\"hits\" "
      "d=\"{}\"/></g>",
      left, y0, x1 - x0, bottom - y0, right ? 1 : -1, outline(pair.rail().knots(), 0, 0, rail_depth),
      outline(pair.wheel().knots(), shift, -clearance, 1e3), lines);
  // beside the rail, which stands towards the track's centre
  const double scale_x = right ? left + 6.0 : left + (x1 - x0) - 26.0;
  fmt::format_to(
      std::back_inserter(svg),
      "<path class=\"scale\" d=\"M{0:.1f} {1:.1f}v2h20v-2\"/><text x=\"{2:.1f}\" y=\"{3:.1f}\">20 mm</text></svg>",
      scale_x, bottom - 4.0, scale_x + 10.0, bottom - 5.0);
  return fmt::format("<div><h4>{} side</h4>{}</div>", right ? "Right" : "Left", svg);
}

std::string contact_figure(const WheelRailPair& pair, const GeometryTableData& table,
                           const WheelsetFunctions& functions) {
  return fmt::format(
      "<figure class=\"chart\"><figcaption><h3>Contact points</h3><p>Wheel {} above rail {}, centred and drawn apart, "
      "seen "
      "in the direction of travel. A line joins the points that touch, one per millimetre of lateral shift from {:.0f} "
      "to "
      "{:.0f} mm.</p></figcaption><div class=\"pair\">{}{}</div></figure>\n",
      report::escaped(table.wheel.name), report::escaped(profile_in_words(table.rail)),
      std::ceil(functions.contacts.front().y / mm), std::floor(functions.contacts.back().y / mm),
      contact_lines(pair, functions, false), contact_lines(pair, functions, true));
}

template <class F>
report::Series over_shift(const WheelsetFunctions& functions, std::string label, F value) {
  report::Series series{std::move(label), {}, {}};
  for (const WheelsetContact& c : functions.contacts) {
    series.x.push_back(c.y / mm);
    series.y.push_back(value(c));
  }
  return series;
}

std::string shift_charts(const WheelsetFunctions& functions) {
  const std::string shift = "lateral shift y [mm]";
  constexpr double degrees = 57.29577951308232;
  report::Chart difference{"Rolling radius difference",
                           "Right minus left; a steep piece is a jump of the contact.",
                           shift,
                           "Δr [mm]",
                           {},
                           {},
                           {}};
  difference.series.push_back(
      over_shift(functions, "Δr", [](const WheelsetContact& c) { return c.radius_difference / mm; }));
  report::Chart angle{"Contact angle",
                      "Its amount, against the track plane, of the point that touches first.",
                      shift,
                      "angle [°]",
                      {},
                      {},
                      {}};
  angle.series.push_back(
      over_shift(functions, "left", [](const WheelsetContact& c) { return degrees * std::abs(c.left.angle); }));
  angle.series.push_back(
      over_shift(functions, "right", [](const WheelsetContact& c) { return degrees * std::abs(c.right.angle); }));
  report::Chart position{"Contact position",
                         "In the profile's own frame, negative towards the track centre.",
                         shift,
                         "y on the profile [mm]",
                         {},
                         {},
                         {}};
  position.series.push_back(
      over_shift(functions, "right wheel", [](const WheelsetContact& c) { return c.right.y_wheel / mm; }));
  position.series.push_back(
      over_shift(functions, "right rail", [](const WheelsetContact& c) { return c.right.y_rail / mm; }));
  return report::chart_html(difference) + report::chart_html(angle) + report::chart_html(position);
}

std::string conicity_chart(const WheelsetFunctions& functions) {
  const RadiusDifferenceCurve& curve = functions.radius_difference;
  report::Chart chart{"Equivalent conicity",
                      "After EN 15302, " + std::string(functions.roll == WheelsetRoll::free ? "with" : "without") +
                          " roll of the wheelset. The curve is interrupted where there is no such wave.",
                      "amplitude [mm]",
                      "tan γe [-]",
                      {},
                      {},
                      {}};
  chart.series.push_back({"kinematic wave", {}, {}});
  chart.series.push_back({"linear regression", {}, {}});
  const double most = std::min(10.0, 0.5 * (curve.y().back() - curve.y().front()) / mm);
  for (double amplitude = 0.5; amplitude <= most; amplitude += 0.05) {
    for (report::Series& series : chart.series) series.x.push_back(amplitude);
    chart.series[0].y.push_back(conicity_of_wave(curve, amplitude * mm).tan_gamma);
    chart.series[1].y.push_back(conicity_of_regression(curve, amplitude * mm).tan_gamma);
  }
  return report::chart_html(chart);
}

}  // namespace

std::string table_page(const WheelRailPair& pair, const GeometryTableData& table, const WheelsetFunctions& functions,
                       const std::string& description) {
  std::string body = fmt::format("<h1>{} on {}</h1><p class=\"lead\">Contact geometry table; wheelset without yaw</p>",
                                 report::escaped(table.wheel.name), report::escaped(profile_in_words(table.rail)));
  body += report::html_section("Wheel and rail", contact_figure(pair, table, functions) + shift_charts(functions));
  body += report::html_section("Conicity", conicity_chart(functions));
  body += report::html_section("The table", fmt::format("<pre>{}</pre>", report::escaped(description)));
  return report::html_page(table_page_kind, table.wheel.name + " on " + profile_in_words(table.rail), body,
                           table.provenance.program_version);
}

}  // namespace railtab
