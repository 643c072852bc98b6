#include "railtab/tablegen/intersection/profile_intersection.hpp"

#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Polygon_with_holes_2.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/contact_pair.hpp"

namespace railtab {

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Polygon = CGAL::Polygon_2<Kernel>;
using PolygonWithHoles = CGAL::Polygon_with_holes_2<Kernel>;
using Point = Kernel::Point_2;

constexpr double body_depth = 0.1;  // m: how far the closing edge lies behind an outline

template <typename Visit>
void visit_curve(const ProfileCurve& curve, double spacing, Visit&& visit) {
  const double length = curve.s_end() - curve.s_begin();
  const int intervals = std::max(1, static_cast<int>(std::ceil(length / spacing)));
  for (int i = 0; i <= intervals; ++i) visit(curve.at(curve.s_begin() + length * i / intervals));
}

// The outline closed by an edge at z = `behind`, counter-clockwise.
Polygon closed(Polygon outline, double behind, const char* what) {
  const Point first = outline[0];
  const Point last = outline[outline.size() - 1];
  outline.push_back(Point(last.x(), behind));
  outline.push_back(Point(first.x(), behind));
  if (!outline.is_simple()) throw ComputationError(std::string("the outline of the ") + what + " crosses itself");
  if (outline.is_clockwise_oriented()) outline.reverse_orientation();
  return outline;
}

Polygon rail_body(const WheelRailPair& pair, double spacing) {
  Polygon outline;
  double lowest = 0.0;
  visit_curve(pair.rail(), spacing, [&](const CurvePoint& p) {
    outline.push_back(Point(p.y, p.z));
    lowest = std::max(lowest, p.z);
  });
  return closed(outline, lowest + body_depth, "rail");
}

Polygon wheel_body(const WheelRailPair& pair, const WheelsetPose& pose, double spacing) {
  const PoseTrigonometry trig(pose);
  const WheelsetCentre centre = wheelset_centre(pair, pose);
  Polygon outline;
  double highest = std::numeric_limits<double>::infinity();
  visit_curve(pair.wheel(), spacing, [&](const CurvePoint& wheel) {
    const SilhouettePoint p =
        placed(silhouette_point(wheel, pair.tape_circle_offset(), pair.nominal_radius(), trig), centre, trig);
    if (!p.exists || p.speed <= 0.0) return;  // not on the visible outline
    outline.push_back(Point(p.y, p.z));
    highest = std::min(highest, p.z);
  });
  return closed(outline, highest - body_depth, "wheel");
}

OverlapRegion region(const PolygonWithHoles& overlap) {
  Kernel::FT area = overlap.outer_boundary().area();
  for (auto hole = overlap.holes_begin(); hole != overlap.holes_end(); ++hole) area += hole->area();  // negative
  const auto box = overlap.outer_boundary().bbox();
  return {CGAL::to_double(area), box.xmin(), box.xmax()};
}

}  // namespace

std::vector<OverlapRegion> overlap_regions(const WheelRailPair& pair, const WheelsetPose& pose, double spacing) {
  std::vector<PolygonWithHoles> overlaps;
  CGAL::intersection(wheel_body(pair, pose, spacing), rail_body(pair, spacing), std::back_inserter(overlaps));
  std::vector<OverlapRegion> regions;
  for (const PolygonWithHoles& overlap : overlaps) regions.push_back(region(overlap));
  std::sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.y_low < b.y_low; });
  return regions;
}

}  // namespace railtab
