#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "command/json_text.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "loaded_contact_command.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/rolling_contact.hpp"
#include "table_command_line.hpp"

namespace railtab {

namespace {

namespace po = boost::program_options;

/// "X,Y,PHI". @throws InputError
Creepage parse_creepage(const std::string& text) {
  const std::vector<double> values = parse_numbers("--creepage", text, 3, "X,Y,PHI, three normalised creepages");
  constexpr double most = 1e100;  // its square is still a number
  for (const double value : values) {
    if (std::abs(value) > most) throw input_error("--creepage", text, fmt::format("normalised creepages to {}", most));
  }
  return {values[0], values[1], values[2]};
}

nlohmann::ordered_json grid_description(const RollingContactSolution& s, int elements) {
  return {{"elements", elements},         {"fx", s.force.x},         {"fy", s.force.y},
          {"mz", s.force.moment},         {"residual", s.residual},  {"bound_excess", s.bound_excess},
          {"adhesion", s.adhesion},       {"slip", s.slip},          {"iterations", s.iterations},
          {"safe_method", s.safe_method}, {"converged", s.converged}};
}

std::string grid_text(const RollingContactSolution& s, int elements) {
  return fmt::format("  {:3} x {:3}    {:12.8f} {:12.8f} {:12.8f}   {} stick, {} slip, residual {:.1e}{}\n", elements,
                     elements, s.force.x, s.force.y, s.force.moment, s.adhesion, s.slip, s.residual,
                     s.safe_method ? ", safe method" : "");
}

}  // namespace

void contact_command(const std::vector<std::string>& arguments) {
  po::options_description own("An ellipse (normalised: G = 1, mu F_n = 1, sqrt(ab) = 1)");
  own.add_options()("ratio", po::value<std::string>()->value_name("A/B"), "ratio of the semi-axes, a along x")  //
      ("creepage", po::value<std::string>()->value_name("X,Y,PHI"), "longitudinal, lateral and spin creepage");
  po::options_description both("Both");
  both.add_options()("poisson", text_value("0.28")->value_name("NU"), "Poisson's ratio")  //
      ("elements", text_value("40")->value_name("N"),
       "along each axis of an ellipse, even (the result is extrapolated from N/2 and N); across the narrowest overlap "
       "of "
       "a wheel and its rail");
  own.add(loaded_contact_options()).add(both);
  const TableCommandLine line(
      "tablegen contact --ratio A/B --creepage X,Y,PHI [options]\n"
      "       tablegen contact --wheel P --rail P | --table FILE.h5 --pose Y,YAW,ROLL --load N | --dz M [options]",
      own, {}, arguments);
  if (line.help_printed()) return;
  if (line.given("pose")) return loaded_contact_command(line);
  line.reject(
      {"wheel", "rail", "smoothing", "rail-inclination", "gauge", "gauge-height", "flange-back", "wheel-radius",
       "table", "load", "dz", "friction", "velocity", "pitch-rate", "motion", "modulus", "most-elements", "output"},
      "only with a --pose");
  RollingContactOptions options;
  options.elements = static_cast<int>(line.whole_number("elements", 8, 240));
  const std::string creepage_text = line.required("creepage");
  static_cast<void>(line.required("ratio"));
  const double ratio = line.number("ratio");
  const Creepage creepage = parse_creepage(creepage_text);
  ExtrapolatedRollingContact contact(ratio, line.number("poisson"), options);
  const ExtrapolatedContactSolution s = contact.solve(creepage);
  if (!s.coarse.converged || !s.fine.converged) {
    throw ComputationError(fmt::format("no solution: residual {:.2g} on {} elements, {:.2g} on {}; tolerance {:.2g}",
                                       s.coarse.residual, options.elements / 2, s.fine.residual, options.elements,
                                       options.tolerance));
  }
  if (line.json()) {
    const nlohmann::ordered_json j{{"ratio", ratio},
                                   {"creepage", {creepage.x, creepage.y, creepage.spin}},
                                   {"poisson", line.number("poisson")},
                                   {"fx", s.force.x},
                                   {"fy", s.force.y},
                                   {"mz", s.force.moment},
                                   {"fine", grid_description(s.fine, options.elements)},
                                   {"coarse", grid_description(s.coarse, options.elements / 2)}};
    print_json(j);
  } else if (!line.quiet()) {
    print_formatted("               F_x/(mu F_n)  F_y/(mu F_n)  M_z/(mu F_n sqrt(ab)), on the wheel\n");
    print_formatted("  limit        {:12.8f} {:12.8f} {:12.8f}\n", s.force.x, s.force.y, s.force.moment);
    print_formatted("{}{}", grid_text(s.fine, options.elements), grid_text(s.coarse, options.elements / 2));
  }
}

}  // namespace railtab
