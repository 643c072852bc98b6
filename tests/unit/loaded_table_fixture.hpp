#pragma once

#include <memory>

#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tablegen/loaded_sweep.hpp"

namespace railtab {

inline const ContactSearch& s1002_on_60e1() {
  static const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                                  ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)),
                                                  PairDimensions{}));
  return search;
}

/// A small and coarse table of the tread beside its wide jump at 0.2 mm.
inline LoadedSweepOptions tread_options() {
  LoadedSweepOptions options;
  options.lateral = {-3e-3, -0.5e-3};
  options.roll = {-1e-3, 1e-3};
  options.yaw = 4e-3;
  options.roll_spacing = 5e-4;
  options.yaw_nodes = 2;
  options.levels = 13;
  options.largest_load = 150e3;
  options.force_error = 5e-3;
  options.light_error = 2e-2;
  options.contact.elements.across_narrowest = 14;
  return options;
}

/// Coarse, with other numbers of nodes.
inline LoadedTableData tread_table_of(int yaw_nodes, double roll_spacing) {
  LoadedSweepOptions options = tread_options();
  options.yaw_nodes = yaw_nodes;
  options.roll_spacing = roll_spacing;
  options.levels = 9;
  options.force_error = options.light_error = 0.1;
  options.contact.elements.across_narrowest = 8;
  return sweep_loaded(s1002_on_60e1(), options);
}

/// Made once in a process.
inline const LoadedTableData& tread_table() {
  static const LoadedTableData data = sweep_loaded(s1002_on_60e1(), tread_options());
  return data;
}

}  // namespace railtab
