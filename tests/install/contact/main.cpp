// Another program's wheel force from a contact table in memory: no file, no HDF5, no structure, no scene.

#include <cmath>
#include <cstdio>
#include <utility>

#include "railtab/runtime/contact/contact_geometry.hpp"
#include "railtab/runtime/contact/wheel_contact.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"
#include "railtab/tables/geometry_table.hpp"

namespace {

using namespace railtab;

constexpr double shift = -4e-3;      // to the left, where the tread touches in one patch [m]
constexpr double half_width = 1e-4;  // of the table's one cell along the lateral shift [m]

// A table with one cell and one branch about one position of S1002 on 60E1: its polynomials are constants, the
// starting point of the search for the contact pair.
GeometryTableData table_about_shift(const ContactSearch& search) {
  const WheelRailPair& pair = search.pair();
  const PairDimensions dimensions;
  GeometryTableData table;
  table.wheel = pair.wheel().knots();
  table.rail = pair.rail().knots();
  table.track_gauge = dimensions.track_gauge;
  table.gauge_height = dimensions.gauge_height;
  table.flange_back = dimensions.flange_back;
  table.nominal_radius = dimensions.nominal_radius;
  table.lateral = {shift - half_width, shift + half_width, 1};
  table.node = {CellNode::leaf(0)};
  table.leaf_branch = {1};
  table.trusted_lowering = {4e-4F};
  table.coefficient.assign(static_cast<std::size_t>(branch_terms(false, false) * branch_quantities), 0.0F);
  const TouchPoint touch = search.first_touch(shift, 0.0, 0.0);
  table.coefficient[0] = static_cast<float>(touch.z_touch);
  table.coefficient[1] = static_cast<float>(touch.s_wheel);
  table.coefficient[2] = static_cast<float>(touch.s_rail);
  table.tolerance = 1e-6;
  return table;
}

}  // namespace

int main() {
  const ProfileCurve wheel(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  const ProfileCurve rail(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0));
  const ContactSearch search(WheelRailPair(wheel, rail, PairDimensions{}));
  const ContactGeometry table{TableContact(GeometryTable(table_about_shift(search)))};
  const ContactGeometry online{search};

  WheelContactModel model;
  model.speed = 50.0;
  WheelsetMotion wheelset;
  wheelset.displacement[1] = shift;
  wheelset.displacement[2] = search.touch_height(shift, 0.0, 0.0) + 8e-5;  // lowered by 80 µm below first touch
  const auto force = [&](const ContactGeometry& geometry, bool& from_table) {
    model.geometry = &geometry;
    const WheelsetPose pose = relative_pose(geometry.pair(), WheelSide::right, wheelset, {});
    const ContactPatches patches = geometry.patches(pose);
    from_table = patches.from_table;
    return wheel_force(model, WheelSide::right, wheelset, {}, patches);
  };
  bool looked_up = false;
  bool searched_from_table = false;
  const WheelForce tabulated = force(table, looked_up);
  const WheelForce exact = force(online, searched_from_table);
  std::printf("vertical force on the wheelset: %.6f kN from the table, %.6f kN by the search\n",
              1e-3 * tabulated.wheelset[2], 1e-3 * exact.wheelset[2]);
  const bool ok = looked_up && !searched_from_table && exact.wheelset[2] < -1e4 &&
                  std::abs(tabulated.wheelset[2] - exact.wheelset[2]) < 1e-3;
  return ok ? 0 : 1;
}
