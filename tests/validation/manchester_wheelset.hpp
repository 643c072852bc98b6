// The Manchester benchmark's wheelset under its load, as its test and its figures need it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/contact/patch_loads.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"

namespace railtab {

/// One wheel that carries a vertical load without friction, in the benchmark's axes (left side not mirrored).
struct LoadedWheel {
  double y_rail = 0.0, y_wheel = 0.0;  ///< mean of the patches by force; rail from the point file's origin [m]
  double x = 0.0, angle = 0.0;         ///< of the patch with the largest force [m, rad]
  double radius = 0.0;                 ///< distance of that patch's point from the axle [m]
  double penetration = 0.0;            ///< largest [m]
  double normal_force = 0.0;           ///< sum over the patches [N]
  double z = 0.0;                      ///< of the wheelset pose [m]
  int patches = 0;                     ///< that carry more than a hundredth of the load
};

/// S1002 on 60E1 1:40 with the benchmark's dimensions and material.
class ManchesterWheelset {
 public:
  static constexpr double load = 10e3;                  ///< per wheel, vertical [N]
  static constexpr double rail_origin_shift = 5.95e-6;  ///< of the point file to the gauge side of the crown [m]

  ManchesterWheelset()
      : search_(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                              ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), PairDimensions{})),
        geometry_(search_) {
    constexpr double shear_modulus = 82e9;
    model_.material.nu = 0.28;
    model_.material.E = 2.0 * shear_modulus * (1.0 + model_.material.nu);
  }

  [[nodiscard]] const ContactSearch& search() const { return search_; }
  [[nodiscard]] const ContactGeometry& geometry() const { return geometry_; }
  [[nodiscard]] const NormalContactModel& model() const { return model_; }

  /// Lowers the wheelset until the vertical parts of the patches' normal forces add up to the load.
  /// @param side 1 right, -1 left
  [[nodiscard]] LoadedWheel wheel(double y, double roll, double yaw, double side) const {
    WheelsetPose pose{side * y, 0.0, side * roll, side * yaw};
    double low = search_.touch_height(pose.y, pose.roll, pose.yaw);
    double high = low + 1e-3;
    for (int i = 0; i < 50; ++i) {
      pose.z = 0.5 * (low + high);
      (vertical_force(pose) < load ? low : high) = pose.z;
    }
    return at(pose, side);
  }

 private:
  [[nodiscard]] double vertical_force(const WheelsetPose& pose) const {
    const ContactPatches patches = geometry_.patches(pose);
    const PatchLoads loads = patch_loads(model_, geometry_, pose, patches);
    double force = 0.0;
    for (int i = 0; i < patches.count; ++i)
      force += loads[index(i)].elastic_force * std::cos(loads[index(i)].contact.angle);
    return force;
  }

  [[nodiscard]] LoadedWheel at(const WheelsetPose& pose, double side) const {
    const ContactPatches patches = geometry_.patches(pose);
    const PatchLoads loads = patch_loads(model_, geometry_, pose, patches);
    LoadedWheel wheel;
    wheel.z = pose.z;
    double most = 0.0;
    for (int i = 0; i < patches.count; ++i) {
      const ContactPatch& p = loads[index(i)].contact;
      const double force = loads[index(i)].elastic_force;
      wheel.normal_force += force;
      wheel.y_rail += force * p.y_rail;
      wheel.y_wheel += force * p.y_wheel;
      wheel.penetration = std::max(wheel.penetration, patches.patch[index(i)].penetration);
      wheel.patches += force > 0.01 * load ? 1 : 0;
      if (force <= most) continue;
      most = force;
      wheel.x = p.x;
      wheel.angle = side * p.angle;
      wheel.radius = p.rolling_radius;
    }
    wheel.y_rail = side * (wheel.y_rail / wheel.normal_force + rail_origin_shift);
    wheel.y_wheel *= side / wheel.normal_force;
    return wheel;
  }

  ContactSearch search_;
  ContactGeometry geometry_;
  NormalContactModel model_;
};

}  // namespace railtab
