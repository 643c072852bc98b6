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

namespace {

void set_column(const CreepForce& from, const CreepForce& to, double step, std::size_t j, CreepForceJet& jet) {
  jet.derivative[0][j] = (to.x - from.x) / step;
  jet.derivative[1][j] = (to.y - from.y) / step;
  jet.derivative[2][j] = (to.moment - from.moment) / step;
}

}  // namespace

CreepForceJet creep_force_jet(const CreepLaw& law, double ratio, const Creepage& creepage) noexcept {
  constexpr double share = 1e-6;  // of a/b, and of a creepage or of 1
  CreepForceJet jet;
  const auto* const table = std::get_if<TableCreep>(&law);
  const bool from_table = table && table->share(ratio, creepage) == 1.0;
  if (from_table) {
    const Creepage c = within_range(creepage);
    const CreepLookup found = table->table->jet(ratio, {c.x, c.y, c.spin});
    jet.force = {found.force[0], found.force[1], found.force[2]};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<double, 3>& d = found.derivative[i];
      jet.derivative[i] = {found.by_ratio[i], d[0], d[1], d[2]};
    }
    return jet;
  }
  jet.force = creep_force(law, ratio, creepage);
  set_column(jet.force, creep_force(law, (1.0 + share) * ratio, creepage), share * ratio, 0, jet);
  const auto along = [&](double Creepage::*member, std::size_t j) {
    Creepage moved = creepage;
    const double step = share * std::max(1.0, std::abs(creepage.*member));
    moved.*member += step;
    set_column(jet.force, creep_force(law, ratio, moved), step, j, jet);
  };
  along(&Creepage::x, 1);
  along(&Creepage::y, 2);
  along(&Creepage::spin, 3);
  return jet;
}

std::string_view creep_law_name(const CreepLaw& law) noexcept {
  constexpr std::string_view names[] = {"linear", "polach", "fastsim", "table"};
  return names[law.index()];
}

}  // namespace railtab
