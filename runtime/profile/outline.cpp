#include "railtab/runtime/profile/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/outline_turn.hpp"

namespace railtab {

namespace {

constexpr std::size_t fewest_points = 4;
// Treads and rail heads are wider, and nothing of a profile is longer: what lies outside was read in the wrong unit.
constexpr double narrowest_wheel = 0.06;      // [m]
constexpr double narrowest_rail_head = 0.02;  // [m]
constexpr double largest_extent = 0.5;        // [m]

std::string place(const std::string& file, const OutlinePoint& p) { return fmt::format("{}:{}", file, p.line); }

std::string text(const OutlinePoint& p) { return fmt::format("({:.9g}, {:.9g}) m", p.y, p.z); }

/// Of a narrow profile: columns exchanged, or numbers that are not in mm; empty where neither fits.
std::string cause_of_width(double width, double height, double narrowest) {
  constexpr double usual = 0.25;  // of wheels and rails [m]
  struct Unit {
    const char* name;
    double times;
  };
  if (height > width && height >= narrowest && height <= usual) return "; are y and z exchanged?";
  std::string fitting;
  for (const Unit& unit : {Unit{"cm", 10.0}, Unit{"inches", 25.4}, Unit{"m", 1000.0}}) {
    const double as = unit.times * width;
    if (as < narrowest || as > usual) continue;
    fitting += fmt::format("{}{:.3g} mm wide if the file is in {}", fitting.empty() ? ": " : ", ", 1e3 * as, unit.name);
  }
  return fitting;
}

void check_extent(const std::string& file, ProfileKind kind, const std::vector<OutlinePoint>& points) {
  const auto [y0, y1] = std::minmax_element(points.begin(), points.end(), [](auto& a, auto& b) { return a.y < b.y; });
  const auto [z0, z1] = std::minmax_element(points.begin(), points.end(), [](auto& a, auto& b) { return a.z < b.z; });
  const double width = y1->y - y0->y;
  const double height = z1->z - z0->z;
  const bool wheel = kind == ProfileKind::wheel;
  const double narrowest = wheel ? narrowest_wheel : narrowest_rail_head;
  if (width >= narrowest && std::max(width, height) <= largest_extent) return;
  throw input_error(
      file, fmt::format("a profile {:.6g} m wide and {:.6g} m high", width, height),
      fmt::format("a {} at least {} m wide, and no extent above {} m; check the units{}", wheel ? "wheel" : "rail head",
                  narrowest, largest_extent, cause_of_width(width, height, narrowest)));
}

void check_steps(const std::string& file, const std::vector<OutlinePoint>& points) {
  for (std::size_t i = 2; i < points.size(); ++i) {
    const double cosine = cosine_of_turn(points[i - 2], points[i - 1], points[i]);
    if (cosine < cosine_of_turning_back) throw turning_back(file, points[i - 1], cosine);
  }
}

/// Side of c as seen along a to b: 1, -1, or 0 where rounding leaves it open. Extended precision with its error bound.
int side(const OutlinePoint& a, const OutlinePoint& b, const OutlinePoint& c) {
  using Wide = long double;
  const Wide left = (static_cast<Wide>(a.y) - c.y) * (static_cast<Wide>(b.z) - c.z);
  const Wide right = (static_cast<Wide>(a.z) - c.z) * (static_cast<Wide>(b.y) - c.y);
  const Wide bound = 4 * std::numeric_limits<Wide>::epsilon() * (std::abs(left) + std::abs(right));
  const Wide difference = left - right;
  return difference > bound ? 1 : difference < -bound ? -1 : 0;
}

/// True where segments ab and cd have a point in common; an undecided side counts as touching, since an outline that
/// comes within rounding of itself encloses no body. Their bounding boxes are known to overlap in y.
bool meet(const OutlinePoint& a, const OutlinePoint& b, const OutlinePoint& c, const OutlinePoint& d) {
  if (std::max(a.z, b.z) < std::min(c.z, d.z) || std::max(c.z, d.z) < std::min(a.z, b.z)) return false;
  return side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0;
}

/// Segments sorted by their least y, each tested against those that begin before it ends.
void check_crossing(const std::string& file, const std::vector<OutlinePoint>& points) {
  std::vector<std::size_t> order(points.size() - 1);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto least_y = [&](std::size_t i) { return std::min(points[i].y, points[i + 1].y); };
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return least_y(i) < least_y(j); });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t i = order[k];
    const double greatest_y = std::max(points[i].y, points[i + 1].y);
    for (std::size_t m = k + 1; m < order.size() && least_y(order[m]) <= greatest_y; ++m) {
      const std::size_t first = std::min(i, order[m]);
      const std::size_t second = std::max(i, order[m]);
      if (second - first < 2) continue;  // neighbours share a point
      if (meet(points[first], points[first + 1], points[second], points[second + 1])) {
        throw input_error(place(file, points[second + 1]),
                          fmt::format("an outline that crosses its part of lines {} to {} near {}", points[first].line,
                                      points[first + 1].line, text(points[second + 1])),
                          "an outline that does not cross or touch itself");
      }
    }
  }
}

}  // namespace

void check_outline(const std::string& file, ProfileKind kind, const std::vector<OutlinePoint>& points) {
  if (points.size() < fewest_points) {
    throw input_error(file, fmt::format("{} points", points.size()), fmt::format("at least {}", fewest_points));
  }
  check_extent(file, kind, points);
  check_steps(file, points);
  check_crossing(file, points);
}

}  // namespace railtab
