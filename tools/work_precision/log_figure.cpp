#include "log_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "label_placement.hpp"
#include "railtab/runtime/report/html_text.hpp"

namespace railtab::work_precision {

namespace {

constexpr double width = 680, height = 400, left = 84, right = 260, above = 60, below = 56;
constexpr std::array colours{"#0b6aa2", "#c8442f", "#d98e04", "#2e7d52", "#7a4fa3", "#5b6675", "#b0348b", "#2a9d9d"};

/// Logarithmic, over round numbers.
struct LogAxis {
  double low, high;           // powers of ten
  std::vector<double> ticks;  // values
  [[nodiscard]] double fraction(double value) const { return (std::log10(value) - low) / (high - low); }
};

/// Ends at 1, 2 or 5 times a power of ten where that is less than two powers of ten, else at powers of ten.
LogAxis axis_over(double low, double high) {
  constexpr std::array<double, 3> round{1.0, 2.0, 5.0};
  std::vector<double> all;
  for (double power = std::floor(std::log10(low)); power <= std::ceil(std::log10(high)); power += 1.0) {
    for (const double r : round) all.push_back(r * std::pow(10.0, power));
  }
  constexpr double hair = 1.0 + 1e-9;
  auto first = std::find_if(all.rbegin(), all.rend(), [&](double v) { return v <= low * hair; });
  auto last = std::find_if(all.begin(), all.end(), [&](double v) { return v * hair >= high; });
  if (first.base() - 1 >= last) last = first.base();  // equal ends
  LogAxis axis{std::log10(*first), std::log10(*last), {first.base() - 1, last + 1}};
  if (axis.high - axis.low <= 2.0) return axis;
  axis.low = std::floor(axis.low + 1e-9);
  axis.high = std::ceil(axis.high - 1e-9);
  axis.ticks.clear();
  const double step = std::ceil((axis.high - axis.low) / 8.0);
  for (double power = axis.low; power <= axis.high; power += step) axis.ticks.push_back(std::pow(10.0, power));
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
  for (const double value : frame.time.ticks) {
    const double x = frame.x(value);
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"#e3e7ec\" d=\"M{:.1f} {}v{}\"/>", x, above, height);
    svg += text(x, above + height + 16, "middle", over_size ? fmt::format("{:g}", value) : time_name(value));
  }
  for (const double value : frame.error.ticks) {
    const double y = frame.y(value);
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"#e3e7ec\" d=\"M{} {:.1f}h{}\"/>", left, y, width);
    svg += text(left - 6, y + 4, "end",
                value >= 1e-3 && value < 1e4 ? fmt::format("{:g}", value) : fmt::format("{:.0e}", value));
  }
  svg += text(left + 0.5 * width, above + height + 38, "middle", figure.x_label);
  fmt::format_to(std::back_inserter(svg),
                 "<text transform=\"translate({:.1f} {:.1f}) rotate(-90)\" text-anchor=\"middle\" "
                 "font-size=\"11\">{}</text>",
                 left - 52, above + 0.5 * height, report::escaped(figure.y_label));
  return svg;
}

/// What is drawn of a point.
struct Mark {
  double x, y;
  bool front;
  const WorkPoint* point;
  const char* colour;
};

std::vector<Mark> marks_of(const WorkFigure& figure, const Frame& frame, const std::vector<std::string>& methods) {
  const std::vector<bool> front = pareto_front(figure);
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < figure.points.size(); ++i) {
    const WorkPoint& p = figure.points[i];
    const auto method = std::find(methods.begin(), methods.end(), p.method) - methods.begin();
    marks.push_back({frame.x(p.x), frame.y(std::max(p.y, figure.least_error)), front[i], &p,
                     colours[static_cast<std::size_t>(method) % colours.size()]});
  }
  return marks;
}

/// Marks on the Pareto front, from left to right.
std::vector<Mark> sorted_front(std::vector<Mark> marks) {
  std::erase_if(marks, [](const Mark& m) { return !m.front; });
  std::sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.x < b.x; });
  return marks;
}

/// From one point of the front to the next, no further right or up than what they reach.
std::string front_line(const std::vector<Mark>& marks) {
  std::string line;
  for (const Mark& m : sorted_front(marks)) {
    if (line.empty()) {
      line = fmt::format("M{:.1f} {}V{:.1f}", m.x, above, m.y);
    } else {
      fmt::format_to(std::back_inserter(line), "H{:.1f}V{:.1f}", m.x, m.y);
    }
  }
  if (line.empty()) return line;
  return fmt::format("<path stroke=\"#9aa5b1\" stroke-dasharray=\"4 3\" d=\"{}H{}\"/>\n", line, left + width);
}

std::string lines(const std::vector<Mark>& marks, const std::vector<std::string>& methods) {
  std::string svg;
  for (const std::string& method : methods) {
    std::string line;
    const char* colour = "";
    for (const Mark& m : marks) {
      if (m.point->method != method) continue;
      fmt::format_to(std::back_inserter(line), "{}{:.1f} {:.1f}", line.empty() || !m.point->joined ? 'M' : 'L', m.x,
                     m.y);
      colour = m.colour;
    }
    fmt::format_to(std::back_inserter(svg), "<path stroke=\"{}\" d=\"{}\"/>\n", colour, line);
  }
  return svg;
}

/// Those of the front last, so that none is hidden by a hollow one.
std::string circles(const std::vector<Mark>& marks) {
  std::string svg;
  for (const bool front : {false, true}) {
    for (const Mark& m : marks) {
      if (m.front != front) continue;
      fmt::format_to(std::back_inserter(svg),
                     "<circle stroke=\"{0}\" fill=\"{1}\" cx=\"{2:.1f}\" cy=\"{3:.1f}\" r=\"{4}\"/>", m.colour,
                     front ? m.colour : "#fff", m.x, m.y, front ? 4.5 : 3.5);
      if (!m.point->standard) continue;
      fmt::format_to(std::back_inserter(svg),
                     "<circle stroke=\"#1d2430\" stroke-width=\"1.5\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\"/>", m.x, m.y);
    }
  }
  return svg + "\n";
}

/// The settings beside the points: of the front first, which so stand nearest to theirs.
std::string labels(const std::vector<Mark>& marks) {
  constexpr int size = 9;
  LabelPlacement placement({left, above, left + width, above + height}, size);
  for (const Mark& m : marks) {
    const double r = m.point->standard ? 9.0 : 5.0;
    placement.occupy({m.x - r, m.y - r, m.x + r, m.y + r});
  }
  for (std::size_t i = 1; i < marks.size(); ++i) {
    if (marks[i].point->method != marks[i - 1].point->method || !marks[i].point->joined) continue;
    placement.cross(marks[i - 1].x, marks[i - 1].y, marks[i].x, marks[i].y);
  }
  const std::vector<Mark> front_marks = sorted_front(marks);
  for (std::size_t i = 1; i < front_marks.size(); ++i) {
    placement.cross(front_marks[i - 1].x, front_marks[i - 1].y, front_marks[i].x, front_marks[i - 1].y);
    placement.cross(front_marks[i].x, front_marks[i - 1].y, front_marks[i].x, front_marks[i].y);
  }
  if (!front_marks.empty()) {
    placement.cross(front_marks.back().x, front_marks.back().y, left + width, front_marks.back().y);
  }
  std::string svg;
  for (const bool front : {true, false}) {
    for (const Mark& m : marks) {
      if (m.front != front || m.point->setting.empty()) continue;
      const LabelPlace at = placement.place(m.x, m.y, m.point->setting);
      if (at.far) {
        fmt::format_to(std::back_inserter(svg),
                       "<path stroke=\"#9aa5b1\" stroke-width=\"0.6\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>", m.x, m.y,
                       at.x, at.y - 0.35 * size);
      }
      svg += text(at.x, at.y, at.anchor, m.point->setting, size);
    }
  }
  return svg + "\n";
}

std::string legend(const WorkFigure& figure, const std::vector<std::string>& methods) {
  std::string svg;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const double y = above + 10 + 20.0 * static_cast<double>(i);
    fmt::format_to(std::back_inserter(svg), "<circle stroke=\"{0}\" fill=\"{0}\" cx=\"{1}\" cy=\"{2}\" r=\"4\"/>",
                   colours[i % colours.size()], left + width + 16, y);
    svg += text(left + width + 26, y + 4, "start", methods[i]);
  }
  if (figure.kind == FigureKind::error_over_time) {
    svg += text(left + width + 16, above + height - 28, "start", "filled: on the Pareto front", 10);
    svg += text(left + width + 16, above + height - 14, "start", "(dashed)", 10);
    svg += text(left + width + 16, above + height, "start", "ringed: default settings", 10);
    if (std::any_of(figure.points.begin(), figure.points.end(),
                    [&](const WorkPoint& p) { return p.y < figure.least_error; })) {
      svg += text(left + width + 16, above + height + 14, "start",
                  fmt::format("errors below {0:.0e} are drawn at {0:.0e}", figure.least_error), 10);
    }
  }
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
  std::vector<std::string> methods;
  for (const WorkPoint& p : figure.points) {
    if (std::find(methods.begin(), methods.end(), p.method) == methods.end()) methods.push_back(p.method);
  }
  const std::vector<Mark> marks = marks_of(figure, frame, methods);
  const std::string head = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" fill=\"none\">\n<style>text{{fill:#1d2430}}</style><rect width=\"100%\" "
      "height=\"100%\" fill=\"#fff\"/>{2}{3}\n",
      left + width + right, above + height + below, text(left, 28, "start", figure.title, 16), grid(figure, frame));
  return head + front_line(marks) + lines(marks, methods) + circles(marks) + labels(marks) + legend(figure, methods) +
         "</svg>\n";
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
