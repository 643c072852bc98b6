#pragma once

#include <random>
#include <string>
#include <vector>

#include "railtab/contact.h"
#include "railtab/runtime/contact/contact_response.hpp"
#include "railtab/runtime/contact/frictionless_contact.hpp"
#include "railtab/runtime/contact_files/contact_table_file.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"

namespace railtab::c_test {

inline constexpr double speed = 20.0;

/// What a C++ program uses in place of the header.
struct CppContact {
  ContactTable table;
  WheelContactModel model;

  explicit CppContact(const std::string& file) : table(read_contact_table(file)) {
    model.geometry = &table.geometry;
    model.creep_law = creep_law("table", model.normal.material.nu);
    model.speed = speed;
  }
  CppContact(const CppContact&) = delete;
  CppContact& operator=(const CppContact&) = delete;

  [[nodiscard]] WheelContact at(WheelSide side, const WheelsetMotion& wheelset, const RailHeadMotion& rail) const {
    return wheel_contact(table.geometry, relative_pose(table.geometry.pair(), side, wheelset, rail));
  }
};

struct Motions {
  WheelSide side;
  WheelsetMotion wheelset;
  RailHeadMotion rail;

  [[nodiscard]] railtab_side c_side() const { return side == WheelSide::left ? RAILTAB_LEFT : RAILTAB_RIGHT; }
  [[nodiscard]] railtab_wheelset_motion c_wheelset() const {
    railtab_wheelset_motion c;
    for (int i = 0; i < 6; ++i) {
      c.displacement[i] = wheelset.displacement[i];
      c.velocity[i] = wheelset.velocity[i];
    }
    return c;
  }
  [[nodiscard]] railtab_rail_motion c_rail() const {
    railtab_rail_motion c;
    for (int i = 0; i < 3; ++i) {
      c.displacement[i] = rail.displacement[i];
      c.velocity[i] = rail.velocity[i];
    }
    c.yaw = rail.yaw;
    c.slope = rail.slope;
    c.friction = rail.friction;
    return c;
  }
};

/// Motions with both wheels near first touch, within and without the tables: loads of up to some 100 kN, no contact.
inline std::vector<Motions> random_motions(const CppContact& contact, int count) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Motions> all;
  for (int i = 0; i < count; ++i) {
    Motions m{i % 2 ? WheelSide::left : WheelSide::right, {}, {}};
    const double y = 5e-3 * unit(engine), roll = i % 3 ? 0.0 : 5e-4 * unit(engine),
                 yaw = i % 5 ? 0.0 : 2e-3 * unit(engine);
    m.rail.displacement << 5e-4 * unit(engine), 1e-3 * unit(engine), i % 7 ? 0.0 : 1e-4 * unit(engine);
    m.rail.velocity << 1e-2 * unit(engine), 1e-2 * unit(engine), 1e-2 * unit(engine);
    m.rail.yaw = i % 5 ? 0.0 : 2e-4 * unit(engine);
    m.rail.slope = 1e-4 * unit(engine);
    m.rail.friction = 1.0 + 0.5 * unit(engine);
    m.wheelset.displacement << unit(engine), y, 0.0, roll, unit(engine), yaw;
    m.wheelset.velocity << unit(engine), 0.1 * unit(engine), 0.1 * unit(engine), 0.1 * unit(engine), unit(engine),
        0.05 * unit(engine);
    const WheelsetPose pose = relative_pose(contact.table.geometry.pair(), m.side, m.wheelset, m.rail);
    const double touch = contact.table.patches.search().touch_height(pose.y, pose.roll, pose.yaw);
    m.wheelset.displacement[2] = touch - pose.z + 1e-4 * (unit(engine) + 0.8);
    all.push_back(m);
  }
  return all;
}

}  // namespace railtab::c_test
