#include "railtab/tablegen/contact_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

constexpr double walk_step = 5e-5;  // along the rail profile [m]
constexpr double margin = 0.01;     // of the box, on each side: the contact lies well inside the overlap
constexpr double no_wheel = -5e-3;  // overlap where no wheel surface was found [m]

/// The overlap on one line of the rail.
struct Slice {
  double s, overlap, x, half;  ///< half: of its length along x [m]
  [[nodiscard]] double area() const { return 4.0 / 3.0 * half * overlap; }
};

Slice slice(const SurfaceLine& line) {
  const double overlap = std::max(0.0, line.overlap);
  return {line.s, overlap, line.x, std::sqrt(2.0 * overlap / line.curvature)};
}

/// Slices from one line to the end of the overlap, which may be that of a profile; sign ±1 along s.
void walk(const UndeformedDistance& distance, SurfaceLine line, double sign, std::vector<Slice>& slices) {
  const ProfileCurve& rail = distance.pair().rail();
  while (true) {
    const double s = line.s + sign * walk_step;
    if (!rail.contains(s)) return;
    const std::optional<SurfaceLine> next = distance.line(s, line.s_wheel);
    if (!next) return;
    if (next->overlap <= 0.0) {
      // the end, from the overlap on both sides of it
      slices.push_back({line.s + sign * walk_step * line.overlap / (line.overlap - next->overlap), 0.0, line.x, 0.0});
      return;
    }
    slices.push_back(slice(*next));
    line = *next;
  }
}

/// Slices first..last, the volume of each that of a step along s.
SurfaceOverlap::Part part(const std::vector<Slice>& slices, std::size_t first, std::size_t last) {
  // (∫A ds)²/∫A² ds over the width of an ellipse's overlap, A ~ (1 − t²)^(3/2): (3π/8)²/(32/35)/2
  constexpr double of_ellipse = 0.7591;
  SurfaceOverlap::Part part{0.0, 0.0, 0.0};
  double squares = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    part.length = std::max(part.length, 2.0 * slices[i].half);
    part.volume += slices[i].area() * walk_step;
    squares += slices[i].area() * slices[i].area() * walk_step;
  }
  const double extent = slices[last].s - slices[first].s;
  part.width = squares > 0.0 ? std::min(extent, part.volume * part.volume / squares / of_ellipse) : extent;
  return part;
}

SurfaceOverlap region_of(const std::vector<Slice>& slices) {
  SurfaceOverlap region{slices.front().s, slices.back().s, slices.front().x, slices.front().x, 0.0, {}};
  std::size_t first = 0;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const Slice& here = slices[i];
    region.x_low = std::min(region.x_low, here.x - here.half);
    region.x_high = std::max(region.x_high, here.x + here.half);
    region.depth = std::max(region.depth, here.overlap);
    const bool saddle = i > first && i + 1 < slices.size() && here.overlap < slices[i - 1].overlap &&
                        here.overlap <= slices[i + 1].overlap;
    if (!saddle && i + 1 < slices.size()) continue;
    region.parts.push_back(part(slices, first, i));
    first = i;
  }
  return region;
}

}  // namespace

std::vector<SurfaceOverlap> surface_overlaps(const ContactSearch& search, const WheelsetPose& pose,
                                             const UndeformedDistance& distance) {
  std::vector<SurfaceOverlap> regions;
  for (const ContactPatch& patch : search.patches(pose)) {
    const bool known = std::any_of(regions.begin(), regions.end(), [&](const SurfaceOverlap& r) {
      return patch.s_rail >= r.s_low && patch.s_rail <= r.s_high;
    });
    const std::optional<SurfaceLine> line = distance.line(patch.s_rail, patch.s_wheel);
    if (!line) {
      throw ComputationError(
          fmt::format("no undeformed distance at the contact of s_rail = {} m, s_wheel = {} m: the "
                      "rail's normal does not meet the wheel there",
                      patch.s_rail, patch.s_wheel));
    }
    if (known || line->overlap <= 0.0) continue;  // overlap within rounding of zero
    std::vector<Slice> slices;
    walk(distance, *line, -1.0, slices);
    std::reverse(slices.begin(), slices.end());
    slices.push_back(slice(*line));
    walk(distance, *line, 1.0, slices);
    regions.push_back(region_of(slices));
  }
  std::sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.s_low < b.s_low; });
  return regions;
}

void ContactElementOptions::validate() const {
  if (across_narrowest < 4 || across_narrowest > 1000) {
    throw input_error("elements", fmt::format("{}", across_narrowest), "4..1000");
  }
  if (most < 64 || most > 4000000)
    throw input_error("largest number of elements", fmt::format("{}", most), "64..4000000");
  if (!(full_share >= 1e-6 && full_share <= 1.0)) {
    throw input_error("full_share", fmt::format("{}", full_share), "1e-6..1");
  }
}

namespace {

SurfaceOverlap bounding_box(const std::vector<SurfaceOverlap>& regions) {
  SurfaceOverlap box = regions.front();
  for (const SurfaceOverlap& r : regions) {
    box.s_low = std::min(box.s_low, r.s_low);
    box.s_high = std::max(box.s_high, r.s_high);
    box.x_low = std::min(box.x_low, r.x_low);
    box.x_high = std::max(box.x_high, r.x_high);
  }
  return box;
}

/// Overlap of the row's elements: from where the wheel is deepest to both sides.
void fill_row(const UndeformedDistance& distance, const SurfaceLine& line, int row, ContactElements& e) {
  const auto fill = [&](int first, int step) {
    OverlapDepth point{line.overlap, line.s_wheel};
    for (int i = first; i >= 0 && i < e.nx; i += step) {
      const std::optional<OverlapDepth> found = distance.at(line, e.x[static_cast<std::size_t>(i)], point);
      if (!found) return;
      point = *found;
      e.overlap[row * e.nx + i] = point.overlap;
      e.s_wheel[static_cast<std::size_t>(row * e.nx + i)] = point.s_wheel;
    }
  };
  const double place = (line.x - e.x.front()) / e.dx;
  const int middle = static_cast<int>(std::clamp(std::floor(place), -1.0, e.nx - 1.0));
  fill(middle, -1);
  fill(middle + 1, 1);
}

}  // namespace

ContactElements contact_elements(const UndeformedDistance& distance, const std::vector<SurfaceOverlap>& regions, int nx,
                                 int ns) {
  const SurfaceOverlap box = bounding_box(regions);
  const double length = (1.0 + 2.0 * margin) * (box.x_high - box.x_low);
  const double width = (1.0 + 2.0 * margin) * (box.s_high - box.s_low);
  ContactElements e;
  e.nx = nx;
  e.ns = ns;
  e.dx = length / nx;
  e.ds = width / ns;
  const double x_first = 0.5 * (box.x_low + box.x_high - length), s_first = 0.5 * (box.s_low + box.s_high - width);
  for (int i = 0; i < nx; ++i) e.x.push_back(x_first + (i + 0.5) * e.dx);
  e.overlap = Eigen::VectorXd::Constant(e.count(), no_wheel);
  e.s_wheel.assign(static_cast<std::size_t>(e.count()), 0.0);
  std::optional<SurfaceLine> before;
  for (int j = 0; j < ns; ++j) {
    const double s = s_first + (j + 0.5) * e.ds;
    const bool overlaps = std::any_of(regions.begin(), regions.end(), [&](const SurfaceOverlap& r) {
      return s > r.s_low - 2.0 * e.ds && s < r.s_high + 2.0 * e.ds;
    });
    std::optional<SurfaceLine> line;
    if (overlaps && before) line = distance.line(s, before->s_wheel);
    if (overlaps && !line) line = distance.line(s);
    if (line) {
      e.line.push_back(*line);
      fill_row(distance, *line, j, e);
    } else {
      e.line.push_back(distance.rail_point(s));
    }
    before = line;
  }
  return e;
}

ContactElements contact_elements(const UndeformedDistance& distance, const std::vector<SurfaceOverlap>& regions,
                                 const ContactElementOptions& options) {
  double volume = 0.0, length = 1.0, width = 1.0;
  for (const SurfaceOverlap& r : regions)
    for (const SurfaceOverlap::Part& p : r.parts) volume += p.volume;
  for (const SurfaceOverlap& r : regions) {
    for (const SurfaceOverlap::Part& p : r.parts) {
      const double weight = std::sqrt(std::min(1.0, p.volume / (options.full_share * volume)));
      if (weight == 0.0) continue;
      length = std::min(length, p.length / weight);
      width = std::min(width, p.width / weight);
    }
  }
  const SurfaceOverlap box = bounding_box(regions);
  const double nx = std::ceil(options.across_narrowest * (box.x_high - box.x_low) / length - 1e-9);
  const double ns = std::ceil(options.across_narrowest * (box.s_high - box.s_low) / width - 1e-9);
  if (nx * ns > options.most) {
    throw TooManyElements(fmt::format(
        "{:.0f} x {:.0f} elements are needed for {} across the narrowest overlap ({:.3g} x {:.3g} mm in a box "
        "of {:.3g} x {:.3g} mm); at most {} are allowed. Ask for fewer across it or allow more.",
        nx, ns, options.across_narrowest, 1e3 * length, 1e3 * width, 1e3 * (box.x_high - box.x_low),
        1e3 * (box.s_high - box.s_low), options.most));
  }
  return contact_elements(distance, regions, static_cast<int>(nx), static_cast<int>(ns));
}

}  // namespace railtab
