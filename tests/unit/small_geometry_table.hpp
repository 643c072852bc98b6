#pragma once

#include <cmath>
#include <cstring>

#include "railtab/tables/geometry_table.hpp"

namespace railtab {

/// Of the geometry table's file format; docs/file_formats/geometry_table.md.
inline constexpr int geometry_table_version = 6;

/// A geometry table with made-up numbers that use every part of the format: three axes, halved cells, a leaf without
/// branches and one with two, limits of trust, statistics.
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
  table.lateral = {-0.004, 0.005, 2};
  table.yaw_squared = {0.0, 4e-4, 1};
  table.roll = {-0.002, 0.002, 1};
  // Two root cells. The first is halved along the lateral axis, its upper half along roll.
  table.node = {CellNode::halved(0, 2), CellNode::leaf(0), CellNode::leaf(1),
                CellNode::halved(2, 4), CellNode::leaf(2), CellNode::leaf(3)};
  table.leaf_branch = {2, 1, 0, 1};
  table.trusted_lowering = {4e-4F, 1e-4F, 0.0F, 4e-4F};
  for (int n = 0; n < 4 * branch_terms(true, true) * branch_quantities; ++n) {
    table.coefficient.push_back(static_cast<float>(1e-3 * std::sin(1.7 * n)));
  }
  table.statistics = {{"samples", 2000}, {"error.penetration.max", 3.25e-9}, {"a.first", 1.0 / 3.0}};
  table.provenance = {"0.1.0", "tablegen geometry --wheel \"made-up wheel\"", "2024-01-31T12:00:00Z"};
  return table;
}

/// Equal to the last bit.
template <typename Number>
bool same_bits(const std::vector<Number>& a, const std::vector<Number>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Number)) == 0);
}

inline bool same_table(const GeometryTableData& a, const GeometryTableData& b) {
  const auto same_profile = [](const ProfileKnots& p, const ProfileKnots& q) {
    return p.kind == q.kind && p.name == q.name && same_bits(p.s, q.s) && same_bits(p.y, q.y) && same_bits(p.z, q.z) &&
           same_bits(p.dy, q.dy) && same_bits(p.dz, q.dz);
  };
  const auto dimensions = [](const GeometryTableData& t) {
    return std::vector<double>{t.track_gauge, t.gauge_height, t.flange_back, t.nominal_radius, t.tolerance};
  };
  const TableProvenance& from = a.provenance;
  return same_profile(a.wheel, b.wheel) && same_profile(a.rail, b.rail) && same_bits(dimensions(a), dimensions(b)) &&
         a.lateral == b.lateral && a.yaw_squared == b.yaw_squared && a.roll == b.roll && a.shard == b.shard &&
         same_bits(a.node, b.node) && same_bits(a.leaf_branch, b.leaf_branch) &&
         same_bits(a.trusted_lowering, b.trusted_lowering) && same_bits(a.coefficient, b.coefficient) &&
         a.statistics == b.statistics && from.program_version == b.provenance.program_version &&
         from.command_line == b.provenance.command_line && from.created == b.provenance.created;
}

}  // namespace railtab
