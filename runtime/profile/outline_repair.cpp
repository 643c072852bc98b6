#include <fmt/format.h>

#include <cmath>
#include <cstddef>

#include "railtab/runtime/profile/outline_turn.hpp"

namespace railtab {

namespace {

// Far below the rounding of any profile file (1e-9 m), far above that of the numbers in it.
constexpr double repeated_distance = 1e-9;  // [m]
constexpr double longest_step_back = 2e-3;  // [m]
constexpr double widest_overlap = 0.1e-3;   // between stitched scans, normal to the outline [m]
constexpr double largest_share = 0.1;       // of the points that may be removed

/// Counts what was removed and remembers where that began.
struct Removed {
  std::size_t count = 0;
  int first_line = 0;
  void add(const OutlinePoint& p) {
    if (count++ == 0) first_line = p.line;
  }
};

std::vector<OutlinePoint> without_repeated(const std::vector<OutlinePoint>& points, Removed& removed) {
  std::vector<OutlinePoint> kept;
  for (const OutlinePoint& p : points) {
    if (!kept.empty() && std::hypot(p.y - kept.back().y, p.z - kept.back().z) < repeated_distance) {
      removed.add(p);
    } else {
      kept.push_back(p);
    }
  }
  return kept;
}

/// Position of p against the line through a and b, from b on: along it and normal to it [m].
struct LinePosition {
  double along, normal;
};
LinePosition against_line(const OutlinePoint& a, const OutlinePoint& b, const OutlinePoint& p) {
  const double length = std::hypot(b.y - a.y, b.z - a.z);
  const double ty = (b.y - a.y) / length;
  const double tz = (b.z - a.z) / length;
  return {(p.y - b.y) * ty + (p.z - b.z) * tz, (p.z - b.z) * ty - (p.y - b.y) * tz};
}

std::vector<OutlinePoint> without_steps_back(const std::string& file, const std::vector<OutlinePoint>& points,
                                             Removed& removed) {
  std::vector<OutlinePoint> kept;
  bool behind = false;  // the outline has stepped back and not yet passed the point at which it turned
  for (const OutlinePoint& p : points) {
    if (kept.size() < 2) {
      kept.push_back(p);
      continue;
    }
    const OutlinePoint& before = kept[kept.size() - 2];
    const OutlinePoint& last = kept.back();
    const LinePosition at = against_line(before, last, p);
    const double cosine = cosine_of_turn(before, last, p);
    behind = cosine < cosine_of_turning_back || (behind && at.along <= 0.0);
    if (!behind) {
      kept.push_back(p);
      continue;
    }
    if (-at.along > longest_step_back || std::abs(at.normal) > widest_overlap) throw turning_back(file, last, cosine);
    removed.add(p);
  }
  return kept;
}

}  // namespace

void repair_outline(const std::string& file, ProfilePoints& outline) {
  Removed repeated;
  Removed back;
  const std::size_t all = outline.points.size();
  outline.points = without_repeated(outline.points, repeated);
  outline.points = without_steps_back(file, outline.points, back);
  if (back.count > 0 && static_cast<double>(back.count) > largest_share * static_cast<double>(all)) {
    throw input_error(fmt::format("{}:{}", file, back.first_line),
                      fmt::format("{} of {} points that step back along the outline", back.count, all),
                      "points in order along the outline");
  }
  if (repeated.count > 0) {
    outline.notes.push_back(
        fmt::format("{}:{}: {} repeated points left out, this the first", file, repeated.first_line, repeated.count));
  }
  if (back.count > 0) {
    outline.notes.push_back(fmt::format("{}:{}: {} points that step back along the outline left out, this the first",
                                        file, back.first_line, back.count));
  }
}

}  // namespace railtab
