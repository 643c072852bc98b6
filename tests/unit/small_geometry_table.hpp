#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "railtab/tables/geometry_table.hpp"

namespace railtab {

/// Of the geometry table's file format; docs/file_formats/geometry_table.md.
inline constexpr int geometry_table_version = 2;

/// A geometry table with made-up numbers that use every part of the format: three axes, a branch over the whole grid, a
/// partial one with a hole, cells that cannot be trusted, windows, statistics.
inline GeometryTableData small_geometry_table() {
  GeometryTableData table;
  const auto profile = [](ProfileKind kind, const char* name, int knots) {
    ProfileKnots p{kind, name, {}, {}, {}, {}, {}};
    for (int i = 0; i < knots; ++i) {
      const double s = 0.001 * i;
      p.s.push_back(s);
      p.y.push_back(std::sin(s));
      p.z.push_back(1.0 - std::cos(s));
      p.dy.push_back(std::cos(s));
      p.dz.push_back(std::sin(s));
    }
    return p;
  };
  table.wheel = profile(ProfileKind::wheel, "made-up wheel", 12);
  table.rail = profile(ProfileKind::rail, "made-up rail", 9);
  table.track_gauge = 1.435;
  table.gauge_height = 0.014;
  table.flange_back = 1.360;
  table.nominal_radius = 0.460;
  table.tolerance = 1e-8;
  table.lateral = {-0.004, -0.001, 0.0, 0.003, 0.005};
  table.yaw_squared = {0.0, 1e-4, 4e-4};
  table.roll = {-0.002, 0.002};
  const auto branch = [](std::array<int, 3> first, std::array<int, 3> size, double value) {
    GeometryBranch b{first, size, {}, {}, {}, {}, {}, {}};
    int k = 0;
    for (auto* column : {&b.z_touch, &b.s_wheel, &b.s_rail, &b.z_touch_dy, &b.s_wheel_dy, &b.s_rail_dy}) {
      for (int i = 0; i < size[0] * size[1] * size[2]; ++i) column->push_back(value + std::sin(1.7 * ++k));
    }
    return b;
  };
  table.branches = {branch({0, 0, 0}, {5, 3, 2}, 1.0), branch({1, 2, 0}, {3, 1, 2}, 2.0)};
  GeometryBranch& partial = table.branches[1];
  for (auto* column : {&partial.z_touch, &partial.s_wheel, &partial.s_rail, &partial.z_touch_dy, &partial.s_wheel_dy,
                       &partial.s_rail_dy}) {
    (*column)[4] = std::numeric_limits<double>::quiet_NaN();
  }
  table.trusted_lowering.assign(4 * 2 * 1, 1e-4);
  table.trusted_lowering[3] = std::numeric_limits<double>::infinity();
  table.windows = {{0, 0.001, 0.002}, {0, 0.004, 0.0055}, {6, 0.003, 0.007}};
  table.searched_lowering = 1e-3;
  table.statistics = {{"samples", 2000}, {"error.penetration.max", 3.25e-9}, {"a.first", 1.0 / 3.0}};
  table.provenance = {"0.1.0", "tablegen geometry --wheel \"made-up wheel\"", "2024-01-31T12:00:00Z"};
  return table;
}

/// Equal to the last bit, NaN included.
inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

inline bool same_table(const GeometryTableData& a, const GeometryTableData& b) {
  const auto same_profile = [](const ProfileKnots& p, const ProfileKnots& q) {
    return p.kind == q.kind && p.name == q.name && same_bits(p.s, q.s) && same_bits(p.y, q.y) && same_bits(p.z, q.z) &&
           same_bits(p.dy, q.dy) && same_bits(p.dz, q.dz);
  };
  const auto same_branch = [](const GeometryBranch& p, const GeometryBranch& q) {
    return p.first == q.first && p.size == q.size && same_bits(p.z_touch, q.z_touch) &&
           same_bits(p.s_wheel, q.s_wheel) && same_bits(p.s_rail, q.s_rail) && same_bits(p.z_touch_dy, q.z_touch_dy) &&
           same_bits(p.s_wheel_dy, q.s_wheel_dy) && same_bits(p.s_rail_dy, q.s_rail_dy);
  };
  const auto dimensions = [](const GeometryTableData& t) {
    return std::vector<double>{t.track_gauge,    t.gauge_height, t.flange_back,
                               t.nominal_radius, t.tolerance,    t.searched_lowering};
  };
  const auto same_window = [](const SearchWindow& p, const SearchWindow& q) {
    return p.cell == q.cell && p.s_low == q.s_low && p.s_high == q.s_high;
  };
  const TableProvenance& from = a.provenance;
  return same_profile(a.wheel, b.wheel) && same_profile(a.rail, b.rail) && same_bits(dimensions(a), dimensions(b)) &&
         same_bits(a.lateral, b.lateral) && same_bits(a.yaw_squared, b.yaw_squared) && same_bits(a.roll, b.roll) &&
         std::equal(a.branches.begin(), a.branches.end(), b.branches.begin(), b.branches.end(), same_branch) &&
         same_bits(a.trusted_lowering, b.trusted_lowering) &&
         std::equal(a.windows.begin(), a.windows.end(), b.windows.begin(), b.windows.end(), same_window) &&
         a.statistics == b.statistics && from.program_version == b.provenance.program_version &&
         from.command_line == b.provenance.command_line && from.created == b.provenance.created;
}

}  // namespace railtab
