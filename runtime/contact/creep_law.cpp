#include "railtab/runtime/contact/creep_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "fastsim.hpp"
#include "linear_creep.hpp"
#include "polach.hpp"
#include "railtab/tables/creep_table_file.hpp"
#include "railtab/tables/input_error.hpp"
#include "table_creep.hpp"

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

/// The material's ratio and the table's: c11 changes by 0.4 % over a hundredth.
constexpr double same_poisson = 0.005;

TableCreep read_table_creep(const std::filesystem::path& file, double nu) {
  const std::filesystem::path name = file.empty() ? shipped_creep_table() : file;
  auto table = std::make_shared<const CreepTable>(read_creep_table(name));
  const double found = table->data().poisson;
  if (std::abs(found - nu) > same_poisson) {
    throw input_error(
        name.string(),
        fmt::format("{} for Poisson's ratio {}",
                    file.empty() ? "the creep table that comes with railtab" : "a creep table", found),
        fmt::format("one for {}, as the material has: tablegen creep --poisson {} makes it (contact.creep_table); or "
                    "the law polach, fastsim or linear, or a material of {}",
                    nu, nu, found));
  }
  return {std::move(table)};
}

}  // namespace

CreepForce creep_force(const CreepLaw& law, double ratio, const Creepage& creepage) noexcept {
  assert(ratio > 0.0);
  return std::visit(Force{ratio, creepage}, law);
}

CreepLaw creep_law(std::string_view name, double nu, const std::filesystem::path& table) {
  if (!(nu >= 0.0 && nu <= 0.5))
    throw input_error("creep law", fmt::format("nu = {}", nu), "Poisson's ratio in 0..0.5");
  if (name == "linear") return LinearCreep{.nu = nu};
  if (name == "polach") return PolachCreep{.nu = nu};
  if (name == "fastsim") return FastsimCreep{.nu = nu};
  if (name == "table") return read_table_creep(table, nu);
  throw input_error("creep law", fmt::format("\"{}\"", name), "linear, polach, fastsim or table");
}

std::string_view creep_law_name(const CreepLaw& law) noexcept {
  constexpr std::string_view names[] = {"linear", "polach", "fastsim", "table"};
  return names[law.index()];
}

}  // namespace railtab
