#include "railtab/runtime/contact/creep_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "fastsim.hpp"
#include "linear_creep.hpp"
#include "polach.hpp"
#include "railtab/tables/input_error.hpp"

namespace railtab {

namespace {

/// Beyond this every law that knows friction is in full sliding to rounding and depends on the creepages' proportions
/// only; larger ones are scaled down to it so that their squares do not overflow.
constexpr double kFullSliding = 1e60;

Creepage within_range(const Creepage& c) {
  const double largest = std::max({std::abs(c.x), std::abs(c.y), std::abs(c.spin)});
  if (!(largest > kFullSliding)) return c;
  return {c.x / largest * kFullSliding, c.y / largest * kFullSliding, c.spin / largest * kFullSliding};
}

struct Force {
  double ratio;
  const Creepage& creepage;
  CreepForce operator()(const LinearCreep& law) const {
    return linear_creep(law, ratio, law.saturated ? within_range(creepage) : creepage);
  }
  CreepForce operator()(const PolachCreep& law) const { return polach_creep(law, ratio, within_range(creepage)); }
  CreepForce operator()(const FastsimCreep& law) const { return fastsim_creep(law, ratio, within_range(creepage)); }
};

}  // namespace

CreepForce creep_force(const CreepLaw& law, double ratio, const Creepage& creepage) noexcept {
  assert(ratio > 0.0);
  return std::visit(Force{ratio, creepage}, law);
}

CreepLaw creep_law(std::string_view name, double nu) {
  if (!(nu >= 0.0 && nu <= 0.5))
    throw input_error("creep law", fmt::format("nu = {}", nu), "Poisson's ratio in 0..0.5");
  if (name == "linear") return LinearCreep{.nu = nu};
  if (name == "polach") return PolachCreep{.nu = nu};
  if (name == "fastsim") return FastsimCreep{.nu = nu};
  throw input_error("creep law", fmt::format("\"{}\"", name), "linear, polach or fastsim");
}

std::string_view creep_law_name(const CreepLaw& law) noexcept {
  constexpr std::string_view names[] = {"linear", "polach", "fastsim"};
  return names[law.index()];
}

}  // namespace railtab
