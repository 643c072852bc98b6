#include "railtab/runtime/contact/creep_law.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "railtab/runtime/contact/fastsim.hpp"
#include "railtab/runtime/contact/linear_creep.hpp"
#include "railtab/runtime/contact/polach.hpp"
#include "railtab/runtime/contact/table_creep.hpp"

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
  CreepForce operator()(const TableCreep& law) const { return table_creep(law, ratio, within_range(creepage)); }
};

}  // namespace

CreepForce creep_force(const CreepLaw& law, double ratio, const Creepage& creepage) noexcept {
  assert(ratio > 0.0);
  return std::visit(Force{ratio, creepage}, law);
}

std::string_view creep_law_name(const CreepLaw& law) noexcept {
  constexpr std::string_view names[] = {"linear", "polach", "fastsim", "table"};
  return names[law.index()];
}

}  // namespace railtab
