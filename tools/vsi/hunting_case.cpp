#include "hunting_case.hpp"

#include <fmt/format.h>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab::vsi {

void set_conicity(const CommandLine& line, HuntingCase& hunting) {
  if (!line.given("amplitude")) return;
  hunting.amplitude = line.number("amplitude");
  if (!(*hunting.amplitude > 0.0 && *hunting.amplitude < 0.01)) {
    throw input_error("--amplitude", fmt::format("{} m", *hunting.amplitude), "above 0, below 0.01 m");
  }
  hunting.conicity = hunting.model.geometry->equivalent_conicity(*hunting.amplitude);
  if (hunting.conicity) return;
  throw input_error("--amplitude", fmt::format("{} m, at which these profiles have no wave", *hunting.amplitude),
                    "a smaller amplitude, or none: the contact at rest");
}

std::string name_of(const HuntingCase& hunting) {
  const WheelRailPair& pair = hunting.model.geometry->pair();
  const std::string about = hunting.conicity ? fmt::format("equivalent conicity {:.4f} at an amplitude of {:.3g} mm",
                                                           *hunting.conicity, 1e3 * *hunting.amplitude)
                                             : std::string("the contact at rest");
  return fmt::format("{}, {} on {}, friction {:.3g}, {}", hunting.model.vehicle.name, pair.wheel().knots().name,
                     pair.rail().knots().name, hunting.model.contact.friction, about);
}

}  // namespace railtab::vsi
