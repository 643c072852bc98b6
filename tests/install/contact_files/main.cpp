// Another program that reads table files: the creep table that comes with railtab, and a file that is not there.

#include <cmath>
#include <cstdio>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"
#include "railtab/tables/files/creep_table_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace {

bool creep_force_comes_from_the_installed_table() {
  std::printf("creep table: %s\n", railtab::shipped_creep_table().c_str());
  const railtab::CreepLaw law = railtab::creep_law("table", 0.28);
  const railtab::CreepForce force = railtab::creep_force(law, 1.0, {0.1, 0.0, 0.0});
  std::printf("longitudinal creep force at a/b = 1, normalised creepage 0.1: %.5f\n", force.x);
  return force.x < -0.1 && force.x > -1.0 && std::abs(force.y) < 1e-3;
}

bool missing_table_is_an_input_error() {
  try {
    static_cast<void>(railtab::read_geometry_table("no-such-table.h5"));
  } catch (const railtab::InputError& wrong) {
    std::printf("%s\n", wrong.what());
    return true;
  }
  return false;
}

}  // namespace

int main() { return creep_force_comes_from_the_installed_table() && missing_table_is_an_input_error() ? 0 : 1; }
