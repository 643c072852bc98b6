#include "railtab/runtime/report/chart.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "railtab/runtime/report/history_store.hpp"
#include "railtab/runtime/report/html_text.hpp"
#include "railtab/runtime/report/polyline.hpp"

namespace railtab::report {
namespace {

constexpr int columns = 900;  // about the width in pixels at which a chart is drawn

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void include(const std::vector<double>& values) {
    for (const double value : values) include(value);
  }
  [[nodiscard]] bool empty() const { return low > high; }
};

struct Axes {
  Axis x, y;
};

std::string grid(const Axes& axes) {
  std::string svg;
  for (const Tick& tick : axes.y.ticks) {
    fmt::format_to(std::back_inserter(svg), "<line class=\"{}\" x1=\"0\" x2=\"1000\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>",
                   tick.value == 0.0 ? "zero" : "grid", 1000 * (1 - axes.y.fraction(tick.value)),
                   1000 * (1 - axes.y.fraction(tick.value)));
  }
  for (const Tick& tick : axes.x.ticks) {
    fmt::format_to(std::back_inserter(svg), "<line class=\"grid\" y1=\"0\" y2=\"1000\" x1=\"{0:.1f}\" x2=\"{0:.1f}\"/>",
                   1000 * axes.x.fraction(tick.value));
  }
  return svg;
}

/// Shaded parts of the x axis, as far as the chart reaches.
std::string mark_areas(const Chart& chart, const Axes& axes) {
  std::string svg;
  for (const Mark& mark : chart.marks) {
    const double from = std::clamp(axes.x.fraction(mark.from), 0.0, 1.0);
    const double to = std::clamp(axes.x.fraction(mark.to), 0.0, 1.0);
    if (to <= from) continue;
    fmt::format_to(std::back_inserter(svg),
                   "<rect class=\"mark\" x=\"{:.1f}\" width=\"{:.1f}\" y=\"0\" height=\"1000\"/>", 1000 * from,
                   1000 * (to - from));
  }
  return svg;
}

std::string lines(const Chart& chart, const Axes& axes) {
  std::string svg;
  for (const Band& band : chart.bands) {
    std::vector<Point> outline = decimated(band.x, band.high, axes.x, columns);
    std::vector<Point> back = decimated(band.x, band.low, axes.x, columns);
    outline.insert(outline.end(), back.rbegin(), back.rend());
    fmt::format_to(std::back_inserter(svg), "<path class=\"band\" d=\"{}Z\"/>", path_data(outline, axes.x, axes.y));
  }
  for (const Limit& limit : chart.limits) {
    fmt::format_to(std::back_inserter(svg),
                   "<line class=\"limit\" x1=\"0\" x2=\"1000\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>",
                   1000 * (1 - axes.y.fraction(limit.value)));
  }
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const Series& series = chart.series[i];
    fmt::format_to(std::back_inserter(svg), "<path class=\"line c{}\" data-label=\"{}\" d=\"{}\"/>", i % line_styles,
                   escaped(series.label), path_data(decimated(series.x, series.y, axes.x, columns), axes.x, axes.y));
  }
  return svg;
}

std::string labels(const Chart& chart, const Axes& axes) {
  std::string html;
  for (const Tick& tick : axes.y.ticks) {
    fmt::format_to(std::back_inserter(html), "<span class=\"ytick\" style=\"top:{:.2f}%\">{}</span>",
                   100 * (1 - axes.y.fraction(tick.value)), tick.label);
  }
  for (std::size_t i = 0; i < axes.x.ticks.size(); ++i) {
    // every second one goes on a narrow screen
    fmt::format_to(std::back_inserter(html), "<span class=\"xtick{}\" style=\"left:{:.2f}%\">{}</span>",
                   i % 2 == 1 ? " spare" : "", 100 * axes.x.fraction(axes.x.ticks[i].value), axes.x.ticks[i].label);
  }
  std::string_view before;
  for (const Mark& mark : chart.marks) {
    const double from = axes.x.fraction(mark.from);
    if (mark.label != before && from < 1.0 && axes.x.fraction(mark.to) > 0.0) {
      fmt::format_to(std::back_inserter(html), "<span class=\"mark-name\" style=\"left:{:.2f}%\">{}</span>",
                     100 * std::max(0.0, from), escaped(mark.label));
    }
    before = mark.label;
  }
  for (const Limit& limit : chart.limits) {
    fmt::format_to(std::back_inserter(html), "<span class=\"limit-name\" style=\"top:{:.2f}%\">{}</span>",
                   100 * (1 - axes.y.fraction(limit.value)), escaped(limit.label));
  }
  return html;
}

std::string legend(const Chart& chart) {
  std::string html = "<ul class=\"legend\">";
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    html += fmt::format("<li><i class=\"c{}\"></i>{}</li>", i % line_styles, escaped(chart.series[i].label));
  }
  for (const Band& band : chart.bands) html += "<li><i class=\"band\"></i>" + escaped(band.label) + "</li>";
  return html + "</ul>";
}

/// The figure in words: the range of every line.
std::string description(const Chart& chart) {
  std::string text = chart.title;
  for (const Series& series : chart.series) {
    Extent y;
    y.include(series.y);
    if (!y.empty()) text += fmt::format("; {}: {} to {}", series.label, shown(y.low), shown(y.high));
  }
  return text + fmt::format("; {} over {}", chart.y_label, chart.x_label);
}

/// What the page's script draws the chart from.
std::string live_data(const Chart& chart) {
  if (chart.live.empty() || chart.over == Over::quantity) return "";
  std::vector<std::string> series, bands, limits, marks;
  for (const LiveSeries& line : chart.live) {
    series.push_back(
        fmt::format(R"({{"label":{},"run":{},"history":{},"offset":{},"factor":{},"shift":{},"shown":{}}})",
                    json_string(line.label), line.run, line.history, line.offset, line.factor, line.shift, line.shown));
  }
  for (const Band& band : chart.bands) {
    bands.push_back(fmt::format(R"({{"label":{},"x":"{}","low":"{}","high":"{}"}})", json_string(band.label),
                                float_base64(band.x), float_base64(band.low), float_base64(band.high)));
  }
  for (const Limit& limit : chart.limits) {
    limits.push_back(fmt::format(R"({{"value":{},"label":{}}})", limit.value, json_string(limit.label)));
  }
  for (const Mark& mark : chart.marks) {
    marks.push_back(fmt::format(R"({{"from":{},"to":{},"label":{}}})", mark.from, mark.to, json_string(mark.label)));
  }
  return fmt::format(
      R"(<script type="application/json" class="chart-data">{{"title":{},"over":"{}","y":{},"series":[{}],)"
      R"("bands":[{}],"limits":[{}],"marks":[{}]}}</script>)",
      json_string(chart.title), chart.over == Over::time ? "time" : "position", json_string(chart.y_label),
      fmt::join(series, ",\n"), fmt::join(bands, ","), fmt::join(limits, ","), fmt::join(marks, ","));
}

}  // namespace

std::string chart_html(const Chart& chart) {
  Extent x, y;
  for (const Series& series : chart.series) {
    x.include(series.x);
    y.include(series.y);
  }
  for (const Band& band : chart.bands) {
    x.include(band.x);
    y.include(band.low);
    y.include(band.high);
  }
  if (x.empty() || y.empty()) return "";
  for (const Limit& limit : chart.limits) y.include(1.05 * limit.value);
  const Axes axes{tight_axis(x.low, x.high, 10), rounded_axis(y.low, y.high, 5)};
  return fmt::format(
      "<figure class=\"chart\"><figcaption><h3>{}</h3><p>{}</p></figcaption><div class=\"static\">{}"
      "<div class=\"y-label\">{}</div><div class=\"plot\"><div class=\"area\" data-x=\"{:.9g},{:.9g}\" "
      "data-y=\"{:.9g},{:.9g}\" data-xlabel=\"{}\"><svg viewBox=\"0 0 1000 1000\" preserveAspectRatio=\"none\" "
      "role=\"img\" aria-label=\"{}\">{}{}{}</svg>{}</div></div><div class=\"x-label\">{}</div></div>{}</figure>\n",
      escaped(chart.title), escaped(chart.note), legend(chart), escaped(chart.y_label), axes.x.low, axes.x.high,
      axes.y.low, axes.y.high, escaped(chart.x_label), escaped(description(chart)), mark_areas(chart, axes), grid(axes),
      lines(chart, axes), labels(chart, axes), escaped(chart.x_label), live_data(chart));
}

}  // namespace railtab::report
