#include "railtab/tablegen/loaded_column.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/creepage.hpp"
#include "railtab/tablegen/ellipse_of_pressure.hpp"
#include "railtab/tablegen/force_over_lowering.hpp"

namespace railtab {

namespace {

/// Pressure moments of one part of the rail's surface. A cut may leave a part a nanometre of a row, whose second moment
/// would be lost in the square of an arc length of centimetres: arc lengths are relative to `origin`.
struct PartSums {
  double origin = 0.0;  ///< arc length at which the part begins to press [m]
  double force = 0.0, x = 0.0, s = 0.0, xx = 0.0, xs = 0.0, ss = 0.0, pp = 0.0, s_wheel = 0.0;
  Eigen::Vector3d arm = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::Zero();
  double peak = 0.0, saddle = 0.0, pressure = 0.0;
};

/// Parts of rows of elements: a row across a cut belongs to both sides by its width there.
std::vector<PartSums> part_sums(const ContactSearch& search, const LoadedContact& contact,
                                const std::vector<double>& cut) {
  std::vector<PartSums> sums(cut.size() + 1);
  const ContactElements& e = contact.elements;
  const WheelsetCentre centre = wheelset_centre(search.pair(), contact.pose);
  std::vector<double> density(static_cast<std::size_t>(e.ns), 0.0);
  for (int j = 0; j < e.ns; ++j) {
    const SurfaceLine& line = e.line[static_cast<std::size_t>(j)];
    const ContactAxes axes(line.angle);
    const Eigen::Vector3d deepest =
        Eigen::Vector3d(0.0, line.y - centre.y, line.z - centre.z) + line.overlap * axes.normal;
    PartSums row;
    for (int i = 0; i < e.nx; ++i) {
      const int k = j * e.nx + i;
      const double force = contact.pressure[k] * e.area();
      if (force <= 0.0) continue;
      const double x = e.x[static_cast<std::size_t>(i)];
      row.force += force;
      row.x += force * x;
      row.xx += force * x * x;
      row.pp += force * contact.pressure[k];
      row.pressure = std::max(row.pressure, contact.pressure[k]);
      row.s_wheel += force * e.s_wheel[static_cast<std::size_t>(k)];
    }
    density[static_cast<std::size_t>(j)] = row.force / e.ds;
    if (row.force <= 0.0) continue;
    const double low = line.s - 0.5 * e.ds, high = line.s + 0.5 * e.ds;
    for (std::size_t p = 0; p < sums.size(); ++p) {
      const double from = p == 0 ? low : std::max(low, cut[p - 1]);
      const double to = p == cut.size() ? high : std::min(high, cut[p]);
      if (to <= from) continue;
      PartSums& sum = sums[p];
      if (sum.force == 0.0) sum.origin = from;
      const double share = (to - from) / e.ds, s = 0.5 * (from + to) - sum.origin, force = share * row.force;
      sum.force += force;
      sum.x += share * row.x;
      sum.xx += share * row.xx;
      sum.pp += share * row.pp;
      sum.s += force * s;
      sum.xs += share * row.x * s;
      sum.ss += force * (s * s + (to - from) * (to - from) / 12.0);
      sum.s_wheel += share * row.s_wheel;
      sum.arm += force * deepest + share * row.x * Eigen::Vector3d::UnitX();
      sum.direction += force * axes.normal;
      sum.peak = std::max(sum.peak, density[static_cast<std::size_t>(j)]);
      sum.pressure = std::max(sum.pressure, row.pressure);
    }
  }
  for (std::size_t p = 0; p < cut.size(); ++p) {
    const double place = (cut[p] - e.line.front().s) / e.ds;
    if (place < 0.0 || place >= e.ns - 1) continue;
    const auto j = static_cast<std::size_t>(place);
    const double part = place - static_cast<double>(j);
    sums[p].saddle = (1.0 - part) * density[j] + part * density[j + 1];
  }
  return sums;
}

/// With fewer elements where a narrow part asks for too many, and at last with more than allowed: two narrow contacts
/// on tread and flange, which yaw moves centimetres apart along the rail, lie in a wide box.
LoadedContact solved(const ContactSearch& search, const WheelsetPose& pose, LoadedContactOptions options,
                     int refinements) {
  while (true) {
    try {
      return loaded_contact(search, pose, options, refinements);
    } catch (const TooManyElements&) {
      constexpr int fewest = 4;  // ContactElementOptions
      if (options.elements.across_narrowest > fewest) {
        options.elements.across_narrowest = std::max(fewest, options.elements.across_narrowest * 2 / 3);
      } else if (options.elements.most < most_elements) {
        options.elements.most = most_elements;
      } else {
        throw;
      }
    }
  }
}

/// At a height at which the energy is nearly w⁵, from one near by: U^(2/5) is nearly linear in the lowering.
/// @param refinements of the last solution of the column; is replaced
LoadedContact near_level(const ContactSearch& search, WheelsetPose pose, double touch, double w,
                         const LoadedColumnOptions& options, int& refinements, long& solutions) {
  // Of the lowering. Wider where the elements' change with the height keeps the iteration from coming nearer.
  constexpr double nearest = 1e-2, widest = 6e-2;
  double near = nearest;
  for (int iteration = 0; near < widest; ++iteration) {
    if (iteration > 5) near *= 1.5;
    LoadedContact contact = solved(search, pose, options.contact, std::max(refinements - 1, 0));
    refinements = contact.refinements;
    ++solutions;
    const double energy = contact.elastic_energy, force = contact.on_rail.force.z(), lowering = pose.z - touch;
    if (!contact.converged || !(energy > 0.0) || !(force > 0.0)) {
      pose.z += 0.5 * lowering;  // above the rail by rounding
      continue;
    }
    const double change = (w * w - std::pow(energy, 0.4)) / (0.4 * std::pow(energy, -0.6) * force);
    if (std::abs(change) <= near * lowering) return contact;
    pose.z += std::max(change, -0.8 * lowering);
  }
  throw ComputationError(fmt::format(
      "loaded contact at y = {:.6g} m, roll = {:.4g} rad, yaw = {:.4g} rad: no height has the elastic energy {:.3g} J",
      pose.y, pose.roll, pose.yaw, std::pow(w, 5)));
}

/// M_roll = ∂U/∂roll [N m].
double roll_moment(const ContactSearch& search, const LoadedContact& contact) {
  const WheelsetCentre centre = wheelset_centre(search.pair(), contact.pose);
  return contact.on_rail.moment_about({0.0, centre.y, centre.z}).x();
}

/// Solutions at growing energy, their number that of the levels above first touch.
struct ColumnSolutions {
  // from first touch on
  std::vector<double> lowering{0.0};   ///< [m]
  std::vector<double> force{0.0};      ///< F_z [N]
  std::vector<double> slope;           ///< (F_y − climb·M_roll)/F_z
  std::vector<LoadedContact> contact;  ///< without first touch
};

ColumnSolutions solutions_near_levels(const ContactSearch& search, WheelsetPose pose, const TouchPoint& touch,
                                      double step, const LoadedColumnOptions& options, long& count) {
  ColumnSolutions found;
  found.slope.push_back(options.climb * touch.z_touch_droll - touch.z_touch_dy);
  const auto steepness = [&](std::size_t k) {
    return found.lowering[k] / std::pow(found.contact[k - 1].elastic_energy, 0.4);
  };
  int refinements = 0;
  for (std::size_t k = 1; k < static_cast<std::size_t>(options.levels); ++k) {
    const double w = static_cast<double>(k) * step;
    constexpr double first_guess = 5e-5;  // m/J^(2/5), ordinary for a tread
    const double guess = k == 1 ? first_guess : k == 2 ? steepness(1) : 2.0 * steepness(k - 1) - steepness(k - 2);
    pose.z = touch.z_touch + std::max(guess, 1e-7) * w * w;
    const LoadedContact& contact =
        found.contact.emplace_back(near_level(search, pose, touch.z_touch, w, options, refinements, count));
    found.lowering.push_back(contact.pose.z - touch.z_touch);
    found.force.push_back(contact.on_rail.force.z());
    found.slope.push_back((contact.on_rail.force.y() - options.climb * roll_moment(search, contact)) /
                          contact.on_rail.force.z());
  }
  return found;
}

}  // namespace

std::vector<LoadedPart> loaded_parts(const ContactSearch& search, const LoadedContact& contact,
                                     const std::vector<double>& cut, double w) {
  std::vector<LoadedPart> parts;
  const double dx = contact.elements.dx;
  for (const PartSums& sum : part_sums(search, contact, cut)) {
    LoadedPart part{};
    if (sum.force > 0.0) {
      const double x = sum.x / sum.force, s = sum.s / sum.force;
      const EllipseOfPressure ellipse({.xx = sum.xx / sum.force - x * x + dx * dx / 12.0,
                                       .xs = sum.xs / sum.force - x * s,
                                       .ss = sum.ss / sum.force - s * s,
                                       .mean_pressure = sum.pp / sum.force},
                                      sum.force);
      assert(std::isfinite(ellipse.a) && ellipse.b > 0.0);
      part = {.share = sum.direction.z() / contact.on_rail.force.z(),
              .arm_x = contact.pose.yaw != 0.0 ? sum.arm.x() / sum.force / contact.pose.yaw : 0.0,
              .arm_y = sum.arm.y() / sum.force,
              .arm_z = sum.arm.z() / sum.force,
              .angle = std::atan2(-sum.direction.y(), sum.direction.z()),
              .a = ellipse.a / w,
              .b = ellipse.b / w,
              .peak = sum.peak / (w * w),
              .saddle = sum.saddle / (w * w),
              .s_rail = sum.origin + s,
              .s_wheel = sum.s_wheel / sum.force,
              .pressure = sum.pressure / w};
    }
    parts.push_back(part);
  }
  return parts;
}

LoadedColumn loaded_column(const ContactSearch& search, const WheelsetPose& pose, const LoadedColumnOptions& options) {
  const TouchPoint touch = search.first_touch(pose.y, pose.roll, pose.yaw);
  if (!std::isfinite(touch.z_touch)) {
    throw ComputationError(fmt::format("wheel and rail never meet at y = {:.6g} m, roll = {:.4g} rad, yaw = {:.4g} rad",
                                       pose.y, pose.roll, pose.yaw));
  }
  const double step = options.largest_level / (options.levels - 1);
  LoadedColumn column;
  const ColumnSolutions found = solutions_near_levels(search, pose, touch, step, options, column.solutions);
  const ForceOverLowering over(found.lowering, found.force);
  column.level.resize(static_cast<std::size_t>(options.levels));
  for (std::size_t k = 1; k < column.level.size(); ++k) {
    const double w = static_cast<double>(k) * step, lowering = over.lowering_at(std::pow(w, 5));
    LoadedNode& node = column.level[k];
    node.z = touch.z_touch + lowering;
    node.force = over.force(lowering);
    node.z_w = 5.0 * std::pow(w, 4) / node.force;
    const std::size_t beside = lowering > found.lowering[k] && k + 1 < column.level.size() ? k + 1 : k - 1;
    const double part = (lowering - found.lowering[k]) / (found.lowering[beside] - found.lowering[k]);
    node.z_y = -found.slope[k] - part * (found.slope[beside] - found.slope[k]);
    node.part = loaded_parts(search, found.contact[k - 1], options.cut, std::pow(over.work(k), 0.2));
  }
  LoadedNode& first = column.level.front();
  first.z = touch.z_touch;
  first.z_y = -found.slope.front();
  first.part = column.level[1].part;
  return column;
}

}  // namespace railtab
