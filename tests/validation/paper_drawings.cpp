// Drawings like Figs. 5, 21 and 22 of [MontenegroCalcada2023]: the profiles of the Manchester benchmark, and the line
// of rails over spans that turn. Usage: paper_drawings FOLDER, which writes manchester_profiles.svg and
// span_deviations.svg there.

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "profile_drawing.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/line/span_deviation.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/report/svg_figure.hpp"

namespace railtab {
namespace {

void profiles(const std::string& folder) {
  const auto outline = [](ProfileKind kind, const char* name) {
    return drawing(name, outline_of(ProfileCurve(standard_profile(kind, name, 1.0 / 40.0))), 1.0,
                   {-75.0, 75.0, -60.0, 40.0});
  };
  const auto panel = [](const std::string& title, const report::Series& line) {
    return report::SvgPanel{title, "lateral, to the field side [mm]", "up [mm]", {line}, {}, report::SvgScale::equal};
  };
  write_text_file(folder + "/manchester_profiles.svg",
                  report::svg_figure("Fig. 5: profiles of the Manchester benchmark",
                                     {panel("Wheel, from the tape circle", outline(ProfileKind::wheel, "S1002")),
                                      panel("Rail at 1:40, from the crown", outline(ProfileKind::rail, "UIC60"))},
                                     2));
}

/// Lateral line of the rails over spans of 20 m.
report::SvgPanel shape(const std::string& title, SpanDeviationShape kind) {
  const SpanDeviation deviation({kind, SpanDeviationDirection::lateral, 20.0, 0.008, 0.0, 0.0});
  report::Series line{"railtab", {}, {}};
  for (double x = -10.0; x <= 60.0; x += 0.05) {
    line.x.push_back(x);
    line.y.push_back(1e3 * deviation.at(x).y);
  }
  return {title, "x [m]", "lateral deviation [mm]", {line}, {}};
}

/// A vertical kink of angle θ at s = 0: the slope of the rail over θ, as Eq. 22 prints it and with its sign corrected.
report::SvgPanel transition(const std::string& title, bool slope) {
  const double beta = transition_stiffness(SpanDeviationDirection::vertical);
  constexpr double half_length = 3.0;  // L_t [m]
  report::Series own{"railtab", {}, {}}, printed{"Eq. 22 as printed", {}, {}};
  const auto decay = [&](double s, double sign) {
    return std::exp(-beta * std::abs(s)) * (std::cos(beta * std::abs(s)) + sign * std::sin(beta * std::abs(s))) /
           (4.0 * beta);
  };
  // Both branches in s = x_t − L_t; before the kink cos + sin of the negative argument is cos − sin of its amount.
  const auto value = [&](double s, double sign) { return std::max(s, 0.0) + decay(s, s < 0.0 ? -1.0 : sign); };
  constexpr double step = 1e-3;  // m
  for (double s = -half_length + 0.5 * step; s < half_length; s += 10.0 * step) {
    for (auto* const series : {&own, &printed}) {
      const double sign = series == &own ? -1.0 : 1.0;
      series->x.push_back(s);
      series->y.push_back(slope ? (value(s + 0.4 * step, sign) - value(s - 0.4 * step, sign)) / (0.8 * step)
                                : value(s, sign));
    }
  }
  return {title, "s [m]", slope ? "slope / θ [-]" : "deviation / θ [m]", {own, printed}, {}};
}

void deviations(const std::string& folder) {
  write_text_file(folder + "/span_deviations.svg",
                  report::svg_figure("Figs. 21 and 22: rails over spans that turn by 8 mm",
                                     {shape("Fig. 21a: BS, spans of 20 m", SpanDeviationShape::bending),
                                      shape("Fig. 21b: PS, span of 20 m", SpanDeviationShape::parallel_shift),
                                      transition("Fig. 22: transition at a kink, vertical", false),
                                      transition("Fig. 22: its slope", true)},
                                     2));
}

}  // namespace
}  // namespace railtab

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: paper_drawings FOLDER\n", stderr);
    return 2;
  }
  try {
    railtab::profiles(argv[1]);
    railtab::deviations(argv[1]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "paper_drawings: %s\n", e.what());
    return 1;
  }
}
