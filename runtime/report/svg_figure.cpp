#include "railtab/runtime/report/svg_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "railtab/runtime/report/axis_ticks.hpp"
#include "railtab/runtime/report/html_text.hpp"

namespace railtab::report {
namespace {

constexpr double width = 420, height = 230;  // of a diagram's frame
constexpr double left = 64, right = 16, above = 34, below = 48;
constexpr double heading_height = 58, legend_height = 18;
constexpr std::array colours{"#0b6aa2", "#c8442f", "#d98e04", "#2e7d52"};

struct Frame {
  Axis x, y;
  double x0, y0;  // upper left corner
  [[nodiscard]] double px(double value) const { return x0 + width * x.fraction(value); }
  [[nodiscard]] double py(double value) const { return y0 + height * (1.0 - y.fraction(value)); }
};

Frame frame_of(const SvgPanel& panel, double x0, double y0) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double x_low = infinity, x_high = -infinity, y_low = infinity, y_high = -infinity;
  for (const std::vector<Series>* group : {&panel.lines, &panel.dots}) {
    for (const Series& series : *group) {
      for (std::size_t i = 0; i < series.x.size(); ++i) {
        if (!std::isfinite(series.y[i])) continue;
        x_low = std::min(x_low, series.x[i]);
        x_high = std::max(x_high, series.x[i]);
        y_low = std::min(y_low, series.y[i]);
        y_high = std::max(y_high, series.y[i]);
      }
    }
  }
  if (!(x_low <= x_high)) x_low = y_low = 0.0, x_high = y_high = 1.0;
  if (panel.scale == SvgScale::equal) {
    const double unit = std::max((x_high - x_low) / width, (y_high - y_low) / height);  // per pixel
    const double x = 0.5 * (x_low + x_high), y = 0.5 * (y_low + y_high);
    return {tight_axis(x - 0.5 * unit * width, x + 0.5 * unit * width, 6),
            tight_axis(y - 0.5 * unit * height, y + 0.5 * unit * height, 5), x0, y0};
  }
  return {tight_axis(x_low, x_high, 6), rounded_axis(y_low, y_high, 5), x0, y0};
}

std::string text(double x, double y, const char* anchor, const std::string& content, int size = 11) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\">{}</text>", x, y, anchor,
                     size, escaped(content));
}

std::string axes(const SvgPanel& panel, const Frame& frame, double title_y) {
  std::string svg = text(frame.x0, title_y, "start", panel.title, 13);
  for (const Tick& tick : frame.y.ticks) {
    const double y = frame.py(tick.value);
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"{}\" d=\"M{:.1f} {:.1f}h{}\"/>",
                   tick.value == 0.0 ? "#9aa5b1" : "#e3e7ec", frame.x0, y, width);
    svg += text(frame.x0 - 6, y + 4, "end", tick.label);
  }
  for (const Tick& tick : frame.x.ticks) {
    const double x = frame.px(tick.value);
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"#e3e7ec\" d=\"M{:.1f} {:.1f}v{}\"/>", x, frame.y0, height);
    svg += text(x, frame.y0 + height + 15, "middle", tick.label);
  }
  svg += text(frame.x0 + 0.5 * width, frame.y0 + height + 32, "middle", panel.x_label);
  fmt::format_to(std::back_inserter(svg),
                 "<text transform=\"translate({:.1f} {:.1f}) rotate(-90)\" text-anchor=\"middle\" "
                 "font-size=\"11\">{}</text>",
                 frame.x0 - 48, frame.y0 + 0.5 * height, escaped(panel.y_label));
  return svg;
}

// The attribute that draws line k.
const char* dashes(const SvgPanel& panel, std::size_t k) {
  return k < panel.styles.size() && panel.styles[k] == LineStyle::dashed ? " stroke-dasharray=\"5 4\"" : "";
}

std::string curves(const SvgPanel& panel, const Frame& frame) {
  std::string svg;
  for (std::size_t k = 0; k < panel.lines.size(); ++k) {
    const Series& series = panel.lines[k];
    std::string data;
    bool pen_down = false;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const bool drawn = std::isfinite(series.y[i]);
      if (drawn) {
        fmt::format_to(std::back_inserter(data), "{}{:.1f} {:.1f}", pen_down ? 'L' : 'M', frame.px(series.x[i]),
                       frame.py(series.y[i]));
      }
      pen_down = drawn;
    }
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"{}\" stroke-width=\"1.5\"{} d=\"{}\"/>",
                   colours[k % colours.size()], dashes(panel, k), data);
  }
  for (std::size_t k = 0; k < panel.dots.size(); ++k) {
    const Series& series = panel.dots[k];
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!std::isfinite(series.y[i])) continue;
      fmt::format_to(std::back_inserter(svg), "<circle stroke=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\"/>",
                     colours[k % colours.size()], frame.px(series.x[i]), frame.py(series.y[i]));
    }
  }
  return svg;
}

/// Names of lines and circles from x0 on, at the height y.
std::string legend(const SvgPanel& panel, double x0, double y) {
  std::string svg;
  double x = x0;
  const auto name = [&](const std::string& label) {
    svg += text(x, y + 4, "start", label);
    x += 24.0 + 5.9 * static_cast<double>(label.size());
  };
  for (std::size_t k = 0; k < panel.lines.size(); ++k) {
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"{}\" stroke-width=\"2\"{} d=\"M{:.1f} {:.1f}h16\"/>",
                   colours[k % colours.size()], dashes(panel, k), x, y);
    x += 22;
    name(panel.lines[k].label);
  }
  for (std::size_t k = 0; k < panel.dots.size(); ++k) {
    fmt::format_to(std::back_inserter(svg), "<circle stroke=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\"/>",
                   colours[k % colours.size()], x + 5, y);
    x += 14;
    name(panel.dots[k].label);
  }
  return svg;
}

/// Whether the legend of the first diagram holds for this one: it has the first of the same names.
bool shares_legend(const SvgPanel& first, const SvgPanel& panel) {
  const auto same = [](const std::vector<Series>& of_first, const std::vector<Series>& of_panel) {
    return of_panel.size() <= of_first.size() &&
           std::equal(of_panel.begin(), of_panel.end(), of_first.begin(),
                      [](const Series& a, const Series& b) { return a.label == b.label; });
  };
  return same(first.lines, panel.lines) && same(first.dots, panel.dots);
}

}  // namespace

std::string svg_figure(const std::string& heading, const std::vector<SvgPanel>& panels, int columns) {
  const int count = static_cast<int>(panels.size());
  const int rows = (count + columns - 1) / columns;
  const bool one_legend = std::all_of(panels.begin(), panels.end(),
                                      [&](const SvgPanel& panel) { return shares_legend(panels.front(), panel); });
  const double top = one_legend ? above : above + legend_height;
  const double cell_width = left + width + right;
  const double cell_height = top + height + below;
  const double head = one_legend ? heading_height : heading_height - legend_height;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" fill=\"none\">\n<style>text{{fill:#1d2430}}</style><rect width=\"100%\" "
      "height=\"100%\" fill=\"#fff\"/>{2}\n",
      cell_width * columns, head + cell_height * rows, text(left, 24, "start", heading, 16));
  if (one_legend && !panels.empty()) svg += legend(panels.front(), left, 44);
  for (int i = 0; i < count; ++i) {
    const SvgPanel& panel = panels[static_cast<std::size_t>(i)];
    const int row = i / columns, column = i % columns;
    const Frame frame = frame_of(panel, left + cell_width * column, head + top + cell_height * row);
    svg += axes(panel, frame, frame.y0 - (one_legend ? 10 : 10 + legend_height)) + curves(panel, frame);
    if (!one_legend) svg += legend(panel, frame.x0, frame.y0 - 10);
    svg += "\n";
  }
  return svg + "</svg>\n";
}

}  // namespace railtab::report
