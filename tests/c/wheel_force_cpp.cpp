// The numbers of docs/examples/contact/wheel_force.c by the C++ functions, in hexadecimal: wheel_force_cpp TABLE.h5

#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "cpp_contact.hpp"

namespace railtab::c_test {
namespace {

template <typename Numbers>
void print(const std::string& name, const Numbers& numbers) {
  std::string line = name;
  for (const double number : numbers) line += fmt::format(" {:a}", number);
  std::puts(line.c_str());
}

void print_wheel(const CppContact& contact, WheelSide side) {
  const WheelsetPose right{1e-3, 0.0, 0.0, 5e-4};
  WheelsetMotion wheelset;
  wheelset.displacement << 0.0, right.y,
      lowered_pose(contact.table.patches.search(), contact.table.geometry,
                   side == WheelSide::right ? right : right.mirrored(), Lowering::under_load, 60e3,
                   contact.model.normal, [] { return std::string(); })
          .pose.z,
      0.0, 0.0, right.yaw;
  wheelset.velocity[1] = 0.01;
  const WheelResponse found = wheel_response(contact.model, side, wheelset, {}, {Vector6::Constant(200.0), 200.0});
  print("on the wheelset", found.force.wheelset);
  print("on the rail", found.force.rail);
  for (int i = 0; i < 9; ++i) print("derivatives", Vector9(found.tangent.row(i)));
  const ContactPatches patches = contact.table.patches.patches(found.contact.pose, touch_rounding);
  const auto loads = patch_loadings(contact.table.geometry, found.contact.pose, patches, contact.model.normal);
  for (int i = 0; i < patches.count; ++i) {
    const ContactPatch& p = patches.patch[i];
    print("patch", std::vector<double>{p.y_rail, p.z_rail, p.angle, p.rolling_radius, loads[i].normal_force, loads[i].a,
                                       loads[i].b});
  }
}

}  // namespace
}  // namespace railtab::c_test

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const railtab::c_test::CppContact contact(argv[1]);
  railtab::c_test::print_wheel(contact, railtab::WheelSide::left);
  railtab::c_test::print_wheel(contact, railtab::WheelSide::right);
}
