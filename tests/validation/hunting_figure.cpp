// Logarithmic decrement of hunting against speed, like Fig. 18b of [MontenegroCalcada2023]: writes
// hunting_decrement.csv and hunting_decrement.svg into the folder given.

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <fstream>

#include "../reference_table.hpp"
#include "hunting_model.hpp"

namespace {

using namespace railtab::hunting;

struct Row {
  double kmh, eq_18, assumptions, all_terms;
};

std::vector<Row> compute() {
  auto reference = railtab::testing::read_reference("hunting_eigenvalues.csv");
  const Assumptions full{.roll = Roll::free,
                         .spin = Spin::included,
                         .gravitational_stiffness = railtab::GravitationalStiffness::included,
                         .gyroscopic_moments = railtab::GyroscopicMoments::included};
  std::vector<Row> rows;
  for (std::size_t i = 0; i < reference["V_kmh"].size(); ++i) {
    const double kmh = reference["V_kmh"][i];
    if (kmh < 50.0 || std::fmod(kmh, 10.0) != 0.0) continue;
    rows.push_back({kmh, reference["logdec"][i], oscillation(wheelset({}, kmh / 3.6), 3).decrement,
                    oscillation(wheelset(full, kmh / 3.6), 3).decrement});
  }
  return rows;
}

void write_csv(const std::string& path, const std::vector<Row>& rows) {
  std::ofstream out(path);
  out << "# Logarithmic decrement per cycle (Eq. 21) of the suspended wheelset, made by "
         "tests/validation/hunting_figure\n"
         "V_kmh,eq_18,railtab_assumptions_of_eq_18,railtab_all_terms\n";
  for (const Row& r : rows)
    out << fmt::format("{:.0f},{:.5f},{:.5f},{:.5f}\n", r.kmh, r.eq_18, r.assumptions, r.all_terms);
}

constexpr double left = 60, right = 620, top = 20, bottom = 340;  // px
double px(double kmh) { return left + (kmh - 50.0) / 250.0 * (right - left); }
double py(double decrement) { return bottom - (decrement + 0.4) / 1.2 * (bottom - top); }

std::string line(const std::vector<Row>& rows, double Row::*column, const char* style) {
  std::string points;
  for (const Row& r : rows) points += fmt::format("{:.1f},{:.1f} ", px(r.kmh), py(r.*column));
  return fmt::format("<polyline fill=\"none\" {} points=\"{}\"/>\n", style, points);
}

void write_svg(const std::string& path, const std::vector<Row>& rows) {
  std::ofstream svg(path);
  svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 390\" font-family=\"sans-serif\" "
         "font-size=\"13\">\n<title>Logarithmic decrement of hunting against speed</title>\n"
         "<rect width=\"640\" height=\"390\" fill=\"white\"/>\n";
  for (int kmh = 50; kmh <= 300; kmh += 50) {
    svg << fmt::format(
        "<path d=\"M{0:.0f} {1}V{2}\" stroke=\"#ddd\"/><text x=\"{0:.0f}\" y=\"{3}\" "
        "text-anchor=\"middle\">{4}</text>\n",
        px(kmh), top, bottom, bottom + 18, kmh);
  }
  for (int tenths = -4; tenths <= 8; tenths += 2) {
    svg << fmt::format(
        "<path d=\"M{} {:.0f}H{}\" stroke=\"{}\"/><text x=\"{}\" y=\"{:.0f}\" text-anchor=\"end\">{:.1f}</text>\n",
        left, py(0.1 * tenths), right, tenths == 0 ? "#555" : "#ddd", left - 8, py(0.1 * tenths) + 4, 0.1 * tenths);
  }
  svg << line(rows, &Row::eq_18, "stroke=\"#1b6ca8\" stroke-width=\"2\"")
      << line(rows, &Row::all_terms, "stroke=\"#c2410c\" stroke-width=\"2\" stroke-dasharray=\"6 4\"");
  for (const Row& r : rows)
    svg << fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"#1b6ca8\"/>", px(r.kmh),
                       py(r.assumptions));
  svg << "\n<text x=\"340\" y=\"380\" text-anchor=\"middle\">speed [km/h]</text>\n"
         "<text transform=\"translate(16 180) rotate(-90)\" text-anchor=\"middle\">logarithmic decrement</text>\n"
         "<text x=\"350\" y=\"50\" fill=\"#1b6ca8\">line: Eq. 18; dots: railtab, same assumptions</text>\n"
         "<text x=\"350\" y=\"70\" fill=\"#c2410c\">dashed: railtab with roll, spin,</text>\n"
         "<text x=\"350\" y=\"88\" fill=\"#c2410c\">gravitational and gyroscopic terms</text>\n</svg>\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: hunting_figure FOLDER\n", stderr);
    return 2;
  }
  try {
    const std::vector<Row> rows = compute();
    write_csv(std::string(argv[1]) + "/hunting_decrement.csv", rows);
    write_svg(std::string(argv[1]) + "/hunting_decrement.svg", rows);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
