#pragma once

// Error over time in panels side by side on the same logarithmic axes, as one SVG file.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "railtab/runtime/report/html_text.hpp"

namespace railtab::error_time_panels {

struct Point {
  std::string method, label;  ///< points of one method are joined; no label: none is drawn
  double time;                ///< [s]
  double error;
};

struct Panel {
  std::string title;
  double resolution;  ///< of the reference: a dashed line
  std::vector<Point> points;
};

constexpr double width = 300, height = 330, left = 76, gap = 48, above = 96, below = 58;

/// Whole powers of ten.
struct Axis {
  int low, high;
  [[nodiscard]] double fraction(double value) const { return (std::log10(value) - low) / (high - low); }
};

inline std::string text(double x, double y, const char* anchor, const std::string& content, int size = 11) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\">{}</text>", x, y, anchor,
                     size, report::escaped(content));
}

inline std::string time_of(int power) {
  constexpr std::array units{"ns", "µs", "ms", "s"};
  const int unit = std::clamp((power + 9) / 3, 0, 3);
  return fmt::format("{:g} {}", std::pow(10.0, power + 9 - 3 * unit), units[static_cast<std::size_t>(unit)]);
}

inline std::string grid(const Panel& panel, double x0, const Axis& time, const Axis& error, bool named) {
  std::string svg = text(x0, above - 10, "start", panel.title, 13);
  for (int power = time.low; power <= time.high; ++power) {
    const double x = x0 + width * (power - time.low) / (time.high - time.low);
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"#e3e7ec\" d=\"M{:.1f} {}v{}\"/>", x, above, height);
    if ((power - time.low) % 2 == 0) svg += text(x, above + height + 16, "middle", time_of(power));
  }
  for (int power = error.low; power <= error.high; ++power) {
    const double y = above + height * (1.0 - static_cast<double>(power - error.low) / (error.high - error.low));
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"#e3e7ec\" d=\"M{:.1f} {:.1f}h{}\"/>", x0, y, width);
    if (named) svg += text(x0 - 6, y + 4, "end", fmt::format("{:g} %", 100.0 * std::pow(10.0, power)));
  }
  return svg + text(x0 + 0.5 * width, above + height + 38, "middle", "time per evaluation");
}

/// @param methods in the legend's order
inline std::string figure(const std::string& heading, const std::string& y_label,
                          const std::vector<std::string>& methods, const std::vector<Panel>& panels) {
  constexpr std::array colours{"#c8442f", "#d98e04", "#7a4fa3", "#0b6aa2", "#2e7d52", "#5b6675"};
  double t_low = 1e300, t_high = 0.0, e_low = 1e300, e_high = 0.0;
  for (const Panel& panel : panels) {
    e_low = std::min(e_low, panel.resolution);
    for (const Point& p : panel.points) {
      t_low = std::min(t_low, p.time);
      t_high = std::max(t_high, p.time);
      e_low = std::min(e_low, p.error);
      e_high = std::max(e_high, p.error);
    }
  }
  const auto around = [](double low, double high) {
    return Axis{static_cast<int>(std::floor(std::log10(low))), static_cast<int>(std::ceil(std::log10(high)))};
  };
  const Axis time = around(t_low, t_high), error = around(e_low, e_high);
  const double full = left + static_cast<double>(panels.size()) * (width + gap) - 0.5 * gap;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" fill=\"none\">\n<style>text{{fill:#1d2430}}</style><rect width=\"100%\" "
      "height=\"100%\" fill=\"#fff\"/>{2}\n",
      full, above + height + below, text(left, 28, "start", heading, 16));
  double legend = left;
  for (std::size_t k = 0; k < methods.size(); ++k) {
    fmt::format_to(std::back_inserter(svg), "<circle fill=\"{}\" cx=\"{:.1f}\" cy=\"52\" r=\"4.5\"/>", colours[k],
                   legend + 5);
    svg += text(legend + 14, 56, "start", methods[k]);
    legend += 40 + 6.2 * static_cast<double>(methods[k].size());
  }
  fmt::format_to(std::back_inserter(svg), "<path stroke=\"#5b6675\" stroke-dasharray=\"4 3\" d=\"M{:.1f} 52h22\"/>{}\n",
                 legend, text(legend + 28, 56, "start", "reference, halved elements"));
  fmt::format_to(std::back_inserter(svg),
                 "<text transform=\"translate({:.1f} {:.1f}) rotate(-90)\" text-anchor=\"middle\" "
                 "font-size=\"11\">{}</text>\n",
                 left - 58, above + 0.5 * height, report::escaped(y_label));
  for (std::size_t n = 0; n < panels.size(); ++n) {
    const Panel& panel = panels[n];
    const double x0 = left + static_cast<double>(n) * (width + gap);
    const auto x_of = [&](double value) { return x0 + width * time.fraction(value); };
    const auto y_of = [&](double value) { return above + height * (1.0 - error.fraction(value)); };
    svg += grid(panel, x0, time, error, n == 0);
    fmt::format_to(std::back_inserter(svg),
                   "<path stroke=\"#5b6675\" stroke-dasharray=\"4 3\" d=\"M{:.1f} {:.1f}h{}\"/>\n", x0,
                   y_of(panel.resolution), width);
    for (std::size_t k = 0; k < methods.size(); ++k) {
      std::string line, marks;
      for (const Point& p : panel.points) {
        if (p.method != methods[k]) continue;
        const double x = x_of(p.time), y = y_of(p.error);
        fmt::format_to(std::back_inserter(line), "{}{:.1f} {:.1f}", line.empty() ? 'M' : 'L', x, y);
        fmt::format_to(std::back_inserter(marks), "<circle fill=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.5\"/>",
                       colours[k], x, y);
        if (!p.label.empty()) marks += text(x + 8, y - 5, "start", p.label, 10);
      }
      fmt::format_to(std::back_inserter(svg), "<path stroke=\"{}\" d=\"{}\"/>{}\n", colours[k], line, marks);
    }
  }
  return svg + "</svg>\n";
}

}  // namespace railtab::error_time_panels
