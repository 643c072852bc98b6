#include "railtab/runtime/contact_files/creep_law_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/creep_table_file.hpp"

namespace railtab {

namespace {

/// The material's ratio and the table's: c11 changes by 0.4 % over a hundredth.
constexpr double same_poisson = 0.005;

TableCreep read_table_creep(const std::filesystem::path& file, double nu) {
  const std::filesystem::path name = file.empty() ? shipped_creep_table() : file;
  auto table = in_file(name.string(), [&name] { return std::make_shared<const CreepTable>(read_creep_table(name)); });
  const double found = table->data().poisson;
  if (std::abs(found - nu) > same_poisson) {
    throw input_error(
        name.string(),
        fmt::format("{} for Poisson's ratio {}",
                    file.empty() ? "the creep table that comes with railtab" : "a creep table", found),
        fmt::format(
            "one for {}, the ratio of the material: tablegen creep --poisson {} makes it (contact.creep_table); or "
            "the law polach, fastsim or linear, or a material of {}",
            nu, nu, found));
  }
  return {std::move(table)};
}

}  // namespace

CreepLaw creep_law(std::string_view name, double nu, const std::filesystem::path& table) {
  if (!(nu >= 0.0 && nu <= 0.5))
    throw input_error("creep law", fmt::format("nu = {}", nu), "Poisson's ratio in 0..0.5");
  if (name == "linear") return LinearCreep{.nu = nu};
  if (name == "polach") return PolachCreep{.nu = nu};
  if (name == "fastsim") return FastsimCreep{.nu = nu};
  if (name == "table") return read_table_creep(table, nu);
  throw input_error("creep law", fmt::format("\"{}\"", name), "linear, polach, fastsim or table");
}

}  // namespace railtab
