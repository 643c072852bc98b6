#include "contact_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "railtab/runtime/report/html_text.hpp"

namespace railtab::report {
namespace {

constexpr double bin_width = 0.5;                       // [mm]
constexpr double bar_length = 12.0;                     // of the fullest bin [mm]
constexpr double view_left = -78.0, view_right = 72.0;  // what a figure shows [mm]
constexpr double rail_depth = 34.0;                     // rail head shown below its top [mm]
constexpr double clearance = 7.0;                       // between wheel and rail, drawn apart [mm]

enum class Side { left, right };

/// Share of the contacts in each bin of the profile's own y [mm], from view_left.
struct Histogram {
  std::vector<double> count = std::vector<double>(static_cast<std::size_t>((view_right - view_left) / bin_width), 0.0);
  double total = 0.0;
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void add(double y) {
    total += 1.0;
    low = std::min(low, y);
    high = std::max(high, y);
    const double bin = std::floor((y - view_left) / bin_width);
    if (bin >= 0 && bin < static_cast<double>(count.size())) count[static_cast<std::size_t>(bin)] += 1.0;
  }
  [[nodiscard]] double fullest() const { return *std::max_element(count.begin(), count.end()); }
};

struct Contacts {
  Histogram rail, wheel;
  double mean_shift = 0.0;  // rail position minus wheel position, mean [mm]
};

/// Whether a wheel has the profile of which the results hold the outline.
bool has_outline(const ResultHeader& header, std::size_t wheel) {
  return header.wheel_outline.empty() || header.wheel_outline[wheel] == 1.0;
}

Contacts contacts_of(const RunResults& results, Side side) {
  Contacts contacts;
  for (const StepRecord& step : results.steps) {
    for (std::size_t i = side == Side::left ? 0 : 1; i < step.wheels.size(); i += 2) {
      const WheelRecord& wheel = step.wheels[i];
      if (wheel.patches == 0 || !has_outline(results.header, i)) continue;
      contacts.rail.add(1e3 * wheel.y_rail);
      contacts.wheel.add(1e3 * wheel.y_wheel);
      contacts.mean_shift += 1e3 * (wheel.y_rail - wheel.y_wheel);
      if (wheel.patches > 1) contacts.rail.add(1e3 * wheel.second_y_rail);
    }
  }
  if (contacts.wheel.total > 0) contacts.mean_shift /= contacts.wheel.total;
  return contacts;
}

/// z [mm] of an outline (in m) at a y [mm], the highest one; NaN off the outline.
double outline_z(const std::vector<double>& y, const std::vector<double>& z, double at, bool lowest) {
  double found = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i + 1 < y.size(); ++i) {
    const double y0 = 1e3 * y[i], y1 = 1e3 * y[i + 1];
    if (y0 == y1 || (at - y0) * (at - y1) > 0) continue;
    const double value = 1e3 * (z[i] + (z[i + 1] - z[i]) * (at - y0) / (y1 - y0));
    if (std::isnan(found) || (lowest ? value > found : value < found)) found = value;
  }
  return found;
}

/// The wheel is drawn above the rail, over the place where the two met on average, its tread clear of the rail.
struct Placement {
  double shift_y = 0.0, shift_z = 0.0;  // of the wheel [mm]
  double top = 0.0, bottom = 0.0;       // of the picture [mm]
};

Placement place(const ResultHeader& header, const Contacts& contacts) {
  Placement placement;
  placement.shift_y = contacts.mean_shift;
  double overlap = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < header.wheel_y.size(); ++i) {
    const double rail = outline_z(header.rail_y, header.rail_z, 1e3 * header.wheel_y[i] + placement.shift_y, false);
    if (std::isfinite(rail)) overlap = std::max(overlap, 1e3 * header.wheel_z[i] - rail);
  }
  placement.shift_z = (std::isfinite(overlap) ? -overlap : 0.0) - clearance;
  const double wheel_top = 1e3 * *std::min_element(header.wheel_z.begin(), header.wheel_z.end()) + placement.shift_z;
  placement.top = std::min(wheel_top, placement.shift_z) - bar_length - 4.0;
  placement.bottom = rail_depth;
  return placement;
}

std::string outline_points(const std::vector<double>& y, const std::vector<double>& z, double shift_y, double shift_z) {
  std::string data;
  for (std::size_t i = 0; i < y.size(); ++i) {
    fmt::format_to(std::back_inserter(data), "{:.2f},{:.2f} ", 1e3 * y[i] + shift_y, 1e3 * z[i] + shift_z);
  }
  return data;
}

/// Bars into the body from its surface: down from the rail's, up from the wheel's.
std::string bars(const Histogram& histogram, const std::vector<double>& y, const std::vector<double>& z,
                 const Placement& placement, bool is_wheel) {
  std::string data;
  const double scale = bar_length / std::max(1.0, histogram.fullest());
  for (std::size_t k = 0; k < histogram.count.size(); ++k) {
    if (histogram.count[k] == 0.0) continue;
    const double centre = view_left + (static_cast<double>(k) + 0.5) * bin_width;
    const double surface = outline_z(y, z, centre, is_wheel);
    if (!std::isfinite(surface)) continue;
    const double length = std::max(0.4, scale * histogram.count[k]);
    fmt::format_to(std::back_inserter(data), "M{:.2f} {:.2f}v{:.2f}", centre + (is_wheel ? placement.shift_y : 0.0),
                   surface + (is_wheel ? placement.shift_z : 0.0), is_wheel ? -length : length);
  }
  return data;
}

std::string range_text(const Histogram& histogram) {
  if (histogram.total == 0.0) return "no contact";
  return fmt::format("{} to {} mm", shown(histogram.low), shown(histogram.high));
}

std::string side_figure(const RunResults& results, Side side) {
  const ResultHeader& header = results.header;
  const Contacts contacts = contacts_of(results, side);
  const Placement placement = place(header, contacts);
  const double height = placement.bottom - placement.top;
  // left: the mirror image, so that the figure shows the track as it lies ahead of the driver
  const char* const mirror = side == Side::left ? "scale(-1 1)" : "";
  const double left = side == Side::left ? -view_right : view_left;
  std::string svg = fmt::format(
      "<svg class=\"profiles\" viewBox=\"{:.1f} {:.1f} {:.1f} {:.1f}\" role=\"img\" aria-label=\"contact positions\">"
      "<g transform=\"{}\"><polyline class=\"rail\" points=\"{}\"/><polyline class=\"wheel\" points=\"{}\"/>"
      "<path class=\"hits\" d=\"{}\"/><path class=\"hits\" d=\"{}\"/></g>",
      left, placement.top, view_right - view_left, height, mirror, outline_points(header.rail_y, header.rail_z, 0, 0),
      outline_points(header.wheel_y, header.wheel_z, placement.shift_y, placement.shift_z),
      bars(contacts.rail, header.rail_y, header.rail_z, placement, false),
      bars(contacts.wheel, header.wheel_y, header.wheel_z, placement, true));
  const double scale_y = placement.bottom - 3.0, scale_x = side == Side::left ? view_left + 8.0 : view_right - 28.0;
  svg += fmt::format(
      "<path class=\"scale\" d=\"M{0:.1f} {1:.1f}v2h20v-2\"/><text x=\"{2:.1f}\" y=\"{3:.1f}\">20 mm</text></svg>",
      side == Side::left ? -view_right + 8.0 : scale_x, scale_y,
      (side == Side::left ? -view_right + 8.0 : scale_x) + 10.0, scale_y - 1.0);
  return fmt::format("<div><h4>{} side</h4>{}<p>Contact on the rail at y = {}, on the wheel at y = {}.</p></div>",
                     side == Side::left ? "Left" : "Right", svg, range_text(contacts.rail), range_text(contacts.wheel));
}

}  // namespace

std::string contact_figure(const RunResults& results) {
  const ResultHeader& header = results.header;
  if (header.wheel_y.size() < 2 || header.rail_y.size() < 2 || results.steps.empty() || header.wheel_x.empty())
    return "";
  return fmt::format(
      "<figure class=\"chart\"><figcaption><h3>Contact positions</h3><p>Wheel {} and rail {}, seen in the direction of "
      "travel and drawn apart; a bar is how often that place was in contact, over {} and all records. The wheel "
      "shows the patch with the larger force. y in the "
      "profile's own frame, negative towards the track centre.</p></figcaption><div "
      "class=\"pair\">{}{}</div></figure>\n",
      escaped(header.wheel_profile), escaped(header.rail_profile),
      header.wheel_outline.empty() ? "all wheels" : "the wheels of that profile", side_figure(results, Side::left),
      side_figure(results, Side::right));
}

}  // namespace railtab::report
