// A program outside the source tree: each of the two core libraries is used through its public headers.

#include <cmath>
#include <cstdio>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"
#include "railtab/runtime/vehicle/coach.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace {

bool rail_stands_at_the_gauge() {
  using namespace railtab;
  const ProfileCurve wheel(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  const ProfileCurve rail(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0));
  const WheelRailPair pair(wheel, rail, PairDimensions{});
  std::printf("rail offset %.4f mm\n", 1e3 * pair.rail_offset());
  // Half the gauge plus the gauge point's distance from the origin of a 60E1 head at 1:40.
  return std::abs(pair.rail_offset() - 0.7605385) < 1e-7;
}

// The matrices are allocated in the library and freed here, by code compiled for another instruction set.
bool coach_crosses_the_library_boundary() {
  const railtab::VehicleModel coach = railtab::build_coach(railtab::coach_parameters("manchester-coach"));
  railtab::VehicleModel copy = coach;
  copy.mass *= 2.0;
  return copy.dofs() == coach.dofs() && copy.mass.trace() == 2.0 * coach.mass.trace();
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

int main() {
  const bool ok =
      rail_stands_at_the_gauge() && coach_crosses_the_library_boundary() && missing_table_is_an_input_error();
  return ok ? 0 : 1;
}
