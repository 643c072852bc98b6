#include "log_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "html_text.hpp"

namespace railtab::work_precision {

namespace {

constexpr double width = 680, height = 400, left = 84, right = 190, above = 60, below = 56;
constexpr std::array colours{"#0b6aa2", "#c8442f", "#d98e04", "#2e7d52", "#7a4fa3", "#5b6675", "#b0348b", "#2a9d9d"};

struct LogAxis {
  double low, high;  // powers of ten
  [[nodiscard]] double fraction(double value) const { return (std::log10(value) - low) / (high - low); }
};

LogAxis axis_over(double low, double high) {
  LogAxis axis{std::floor(std::log10(low)), std::ceil(std::log10(high))};
  if (axis.high <= axis.low) axis.high = axis.low + 1.0;
  return axis;
}

struct Frame {
  LogAxis time, error;
  [[nodiscard]] double x(double value) const { return left + width * time.fraction(value); }
  [[nodiscard]] double y(double value) const { return above + height * (1.0 - error.fraction(value)); }
};

Frame frame_of(const WorkFigure& figure) {
  double t_low = 1e300, t_high = 0.0, e_low = 1e300, e_high = 0.0;
  for (const WorkPoint& p : figure.points) {
    t_low = std::min(t_low, p.x);
    t_high = std::max(t_high, p.x);
    e_low = std::min(e_low, std::max(p.y, figure.least_error));
    e_high = std::max(e_high, p.y);
  }
  return {axis_over(t_low, t_high), axis_over(e_low, std::max(e_low, e_high))};
}

std::string text(double x, double y, const char* anchor, const std::string& content, int size = 11) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\">{}</text>", x, y, anchor,
                     size, report::escaped(content));
}

std::string grid(const WorkFigure& figure, const Frame& frame) {
  const bool over_size = figure.kind == FigureKind::time_over_size;
  std::string svg;
  for (double power = frame.time.low; power <= frame.time.high; power += 1.0) {
    const double x = frame.x(std::pow(10.0, power));
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"#e3e7ec\" d=\"M{:.1f} {}v{}\"/>", x, above, height);
    svg += text(x, above + height + 16, "middle",
                over_size ? fmt::format("1e{:g}", power) : time_name(std::pow(10.0, power)));
  }
  const double step = std::max(1.0, std::ceil((frame.error.high - frame.error.low) / 8.0));
  for (double power = frame.error.low; power <= frame.error.high; power += step) {
    const double y = frame.y(std::pow(10.0, power));
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"#e3e7ec\" d=\"M{} {:.1f}h{}\"/>", left, y, width);
    svg += text(left - 6, y + 4, "end", fmt::format("1e{:g}", power));
  }
  svg += text(left + 0.5 * width, above + height + 38, "middle", figure.x_label);
  fmt::format_to(std::back_inserter(svg),
                 "<text transform=\"translate({:.1f} {:.1f}) rotate(-90)\" text-anchor=\"middle\" "
                 "font-size=\"11\">{}</text>",
                 left - 52, above + 0.5 * height, report::escaped(figure.y_label));
  return svg;
}

}  // namespace

std::string time_name(double ns) {
  if (ns < 1e3) return fmt::format("{:.3g} ns", ns);
  if (ns < 1e6) return fmt::format("{:.3g} µs", ns / 1e3);
  if (ns < 1e9) return fmt::format("{:.3g} ms", ns / 1e6);
  return fmt::format("{:.3g} s", ns / 1e9);
}

std::string log_figure(const WorkFigure& figure) {
  const Frame frame = frame_of(figure);
  const std::vector<bool> front = pareto_front(figure);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" fill=\"none\">\n<style>text{{fill:#1d2430}}</style><rect width=\"100%\" "
      "height=\"100%\" fill=\"#fff\"/>{2}{3}\n",
      left + width + right, above + height + below, text(left, 28, "start", figure.title, 16), grid(figure, frame));
  std::vector<std::string> methods;
  for (const WorkPoint& p : figure.points) {
    if (std::find(methods.begin(), methods.end(), p.method) == methods.end()) methods.push_back(p.method);
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const char* colour = colours[m % colours.size()];
    std::string line;
    int labels = 0;  // those of neighbours stand above each other
    for (std::size_t i = 0; i < figure.points.size(); ++i) {
      const WorkPoint& p = figure.points[i];
      if (p.method != methods[m]) continue;
      const double x = frame.x(p.x), y = frame.y(std::max(p.y, figure.least_error));
      fmt::format_to(std::back_inserter(line), "{}{:.1f} {:.1f}", line.empty() ? 'M' : 'L', x, y);
      fmt::format_to(std::back_inserter(svg),
                     "<circle stroke=\"{0}\" fill=\"{1}\" cx=\"{2:.1f}\" cy=\"{3:.1f}\" r=\"4\"/>", colour,
                     front[i] ? colour : "#fff", x, y);
      if (p.standard) {
        fmt::format_to(std::back_inserter(svg),
                       "<circle stroke=\"#1d2430\" stroke-width=\"1.5\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\"/>", x, y);
      }
      svg += text(x + 7, y - 5 - 10 * (labels++ % 4), "start", p.setting, 9);
    }
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"{}\" d=\"{}\"/>\n", colour, line);
    const double legend_y = above + 10 + 20.0 * static_cast<double>(m);
    fmt::format_to(std::back_inserter(svg), "<circle stroke=\"{0}\" fill=\"{0}\" cx=\"{1}\" cy=\"{2}\" r=\"4\"/>",
                   colour, left + width + 16, legend_y);
    svg += text(left + width + 26, legend_y + 4, "start", methods[m]);
  }
  if (figure.kind == FigureKind::error_over_time) {
    svg += text(left + width + 16, above + height, "start", "filled: Pareto front", 10);
    svg += text(left + width + 16, above + height + 14, "start", "ringed: default", 10);
  }
  return svg + "</svg>\n";
}

std::string csv(const WorkFigure& figure) {
  const bool over_size = figure.kind == FigureKind::time_over_size;
  std::string rows = over_size ? "method,setting,size,seconds,note\n"
                               : "method,setting,time_ns,error,largest_error,pareto,default,note\n";
  const std::vector<bool> front = pareto_front(figure);
  for (std::size_t i = 0; i < figure.points.size(); ++i) {
    const WorkPoint& p = figure.points[i];
    rows += fmt::format("\"{}\",\"{}\",{:.5g},{:.4g},", p.method, p.setting, p.x, p.y);
    if (!over_size) rows += fmt::format("{:.4g},{},{},", p.largest_error, front[i] ? 1 : 0, p.standard ? 1 : 0);
    rows += fmt::format("\"{}\"\n", p.note);
  }
  return rows;
}

}  // namespace railtab::work_precision
