#include <fmt/format.h>

#include <algorithm>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/geometry_parts.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"

namespace railtab {

bool same_profile(const ProfileKnots& p, const ProfileKnots& q) {
  return p.kind == q.kind && p.s == q.s && p.y == q.y && p.z == q.z && p.dy == q.dy && p.dz == q.dz;
}

std::string difference_of_tables(const GeometryTableData& p, const GeometryTableData& q) {
  if (!same_profile(p.wheel, q.wheel)) return fmt::format("another wheel profile ({})", q.wheel.name);
  if (!same_profile(p.rail, q.rail)) return fmt::format("another rail profile ({})", q.rail.name);
  if (p.track_gauge != q.track_gauge || p.gauge_height != q.gauge_height || p.flange_back != q.flange_back ||
      p.nominal_radius != q.nominal_radius) {
    return "other dimensions of wheelset or track";
  }
  if (p.lateral != q.lateral || p.yaw_squared != q.yaw_squared || p.roll != q.roll) return "other axes";
  return p.tolerance == q.tolerance ? "" : "other options";
}

std::string difference_of_parts(const GeometryTableData& p, const GeometryTableData& q) {
  if (std::string difference = difference_of_tables(p, q); !difference.empty()) return difference;
  if (p.statistics != q.statistics) return "other options";
  if (p.provenance.program_version != q.provenance.program_version) {
    return fmt::format("another version of the program ({})", q.provenance.program_version);
  }
  return {};
}

GeometryTableData merge_geometry_tables(std::vector<GeometryTableData> parts) {
  if (parts.empty()) throw input_error("geometry parts", "none", "all parts of one table");
  std::sort(parts.begin(), parts.end(),
            [](const GeometryTableData& p, const GeometryTableData& q) { return p.shard.index < q.shard.index; });
  const int count = parts.front().shard.count;
  std::size_t roots = 0;
  for (std::size_t n = 0; n < parts.size(); ++n) {
    const TableShard& shard = parts[n].shard;
    const std::string name = fmt::format("geometry part {}/{}", shard.index, shard.count);
    if (shard.count != count)
      throw input_error(name, fmt::format("a part of {}", shard.count), fmt::format("of {}", count));
    const std::string other = difference_of_parts(parts.front(), parts[n]);
    if (!other.empty()) throw input_error(name, other, fmt::format("that of part {}", parts.front().shard.index));
    if (shard.index != static_cast<int>(n) + 1) {
      const bool twice = n > 0 && shard.index == parts[n - 1].shard.index;
      throw input_error("geometry parts",
                        twice ? fmt::format("part {} twice", shard.index) : fmt::format("no part {}", n + 1),
                        fmt::format("parts 1 to {}, each once", count));
    }
    const auto [first, end] = root_range(shard, root_cells(parts[n]));
    if (parts[n].node.size() < static_cast<std::size_t>(end - first)) {
      throw input_error(name, fmt::format("{} nodes", parts[n].node.size()), fmt::format("at least {}", end - first));
    }
    roots += static_cast<std::size_t>(end - first);
  }
  if (static_cast<int>(parts.size()) != count) {
    throw input_error("geometry parts", fmt::format("{} parts", parts.size()), fmt::format("parts 1 to {}", count));
  }

  GeometryTableData whole = parts.front();
  whole.shard = {};
  whole.node.assign(roots, 0);
  whole.leaf_branch.clear();
  whole.trusted_lowering.clear();
  whole.coefficient.clear();
  std::size_t root = 0;
  for (const GeometryTableData& part : parts) {
    const auto [first, end] = root_range(part.shard, root_cells(part));
    const auto own = static_cast<std::size_t>(end - first);
    const std::size_t behind = whole.node.size();
    const std::size_t leaves = whole.leaf_branch.size();
    const auto moved = [&](std::uint32_t code) {
      const std::size_t index = CellNode::index(code);
      if (CellNode::is_leaf(code)) return CellNode::leaf(static_cast<std::uint32_t>(leaves + index));
      return CellNode::halved(CellNode::axis(code), static_cast<std::uint32_t>(behind + index - own));
    };
    for (std::size_t n = 0; n < own; ++n) whole.node[root++] = moved(part.node[n]);
    for (std::size_t n = own; n < part.node.size(); ++n) whole.node.push_back(moved(part.node[n]));
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(whole.leaf_branch, part.leaf_branch);
    append(whole.trusted_lowering, part.trusted_lowering);
    append(whole.coefficient, part.coefficient);
  }
  return whole;
}

}  // namespace railtab
