#include "railtab/tablegen/loaded_column.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/creepage.hpp"

namespace railtab {

namespace {

/// Pressure moments of one part of the rail's surface.
struct PartSums {
  double force = 0.0, x = 0.0, s = 0.0, xx = 0.0, xs = 0.0, ss = 0.0, s_wheel = 0.0;
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
      const double share = (to - from) / e.ds, s = 0.5 * (from + to), force = share * row.force;
      PartSums& sum = sums[p];
      sum.force += force;
      sum.x += share * row.x;
      sum.xx += share * row.xx;
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

void set_parts(const ContactSearch& search, const LoadedContact& contact, const std::vector<double>& cut, double w,
               LoadedNode& node) {
  const double dx = contact.elements.dx;
  for (const PartSums& sum : part_sums(search, contact, cut)) {
    LoadedPart part{};
    if (sum.force > 0.0) {
      const double x = sum.x / sum.force, s = sum.s / sum.force;
      const double xx = sum.xx / sum.force - x * x + dx * dx / 12.0, xs = sum.xs / sum.force - x * s;
      const double ss = sum.ss / sum.force - s * s;
      part = {.share = sum.direction.z() / contact.on_rail.force.z(),
              .arm_x = contact.pose.yaw != 0.0 ? sum.arm.x() / sum.force / contact.pose.yaw : 0.0,
              .arm_y = sum.arm.y() / sum.force,
              .arm_z = sum.arm.z() / sum.force,
              .angle = std::atan2(-sum.direction.y(), sum.direction.z()),
              .a = std::sqrt(5.0 * std::max(xx - xs * xs / ss, dx * dx / 12.0)) / w,
              .b = std::sqrt(5.0 * ss) / w,
              .peak = sum.peak / (w * w),
              .saddle = sum.saddle / (w * w),
              .s_rail = s,
              .s_wheel = sum.s_wheel / sum.force,
              .pressure = sum.pressure / w};
    }
    node.part.push_back(part);
  }
}

/// With fewer elements where a narrow part asks for too many.
LoadedContact solved(const ContactSearch& search, const WheelsetPose& pose, LoadedContactOptions options) {
  while (true) {
    try {
      return loaded_contact(search, pose, options);
    } catch (const TooManyElements&) {
      if (options.elements.across_narrowest < 8) throw;
      options.elements.across_narrowest = options.elements.across_narrowest * 2 / 3;
    }
  }
}

/// The height at which the energy is w⁵, from a height near by: U^(2/5) is nearly linear in the lowering.
LoadedNode solved_level(const ContactSearch& search, WheelsetPose pose, double touch, double w,
                        const LoadedColumnOptions& options, long& solutions) {
  // Of the lowering: the rest is to first order. Wider where the elements' change with the height keeps the iteration
  // from coming nearer.
  constexpr double nearest = 2e-3, widest = 3e-2;
  double near = nearest;
  for (int iteration = 0; near < widest; ++iteration) {
    if (iteration > 5) near *= 1.5;
    const LoadedContact contact = solved(search, pose, options.contact);
    ++solutions;
    const double energy = contact.elastic_energy, force = contact.on_rail.force.z(), lowering = pose.z - touch;
    if (!contact.converged || !(energy > 0.0) || !(force > 0.0)) {
      pose.z += 0.5 * lowering;  // above the rail by rounding
      continue;
    }
    const double change = (w * w - std::pow(energy, 0.4)) / (0.4 * std::pow(energy, -0.6) * force);
    if (std::abs(change) > near * lowering) {
      pose.z += std::max(change, -0.8 * lowering);
      continue;
    }
    LoadedNode node;
    node.z = pose.z + change;
    node.force = force * (1.0 + 1.5 * change / lowering);
    node.z_w = 5.0 * std::pow(w, 4) / node.force;
    node.z_y = -contact.on_rail.force.y() / force;
    set_parts(search, contact, options.cut, w, node);
    return node;
  }
  throw ComputationError(fmt::format(
      "loaded contact at y = {:.6g} m, roll = {:.4g} rad, yaw = {:.4g} rad: no height has the elastic energy {:.3g} J",
      pose.y, pose.roll, pose.yaw, std::pow(w, 5)));
}

/// (z − z_t)/w² about a level of a column, as a parabola of the level: its value and slope there, by least squares
/// through heights and slopes of the levels around. Heights far from a first parabola count less in the second, for
/// where the elements change with the height, single ones are off by much more than the others.
Eigen::Vector2d steepness(const std::vector<LoadedNode>& level, double step, int k) {
  constexpr int reach = 3;
  constexpr double height_noise = 2e-5, slope_noise = 1e-3;  // relative, of 28 elements
  const int last = static_cast<int>(level.size()) - 1;
  const int from = std::max(1, k - reach), count = std::min(last, k + reach) - from + 1;
  Eigen::MatrixX3d matrix(2 * count, 3);
  Eigen::VectorXd right(2 * count), weight(2 * count);
  for (int i = 0; i < count; ++i) {
    const int at = from + i;
    const double t = at - k, w = at * step;
    const LoadedNode& node = level[static_cast<std::size_t>(at)];
    matrix.row(2 * i) << 1.0, t, t * t;
    right[2 * i] = (node.z - level.front().z) / (w * w);
    // ∂z/∂w over w: twice the parabola and the level times its slope
    matrix.row(2 * i + 1) << 2.0, 2.0 * t + at, 2.0 * t * t + 2.0 * at * t;
    right[2 * i + 1] = node.z_w / w;
    weight[2 * i] = 1.0;
    weight[2 * i + 1] = 0.5 * height_noise / slope_noise;
  }
  Eigen::Vector3d parabola;
  for (int pass = 0; pass < 2; ++pass) {
    parabola = (weight.asDiagonal() * matrix).colPivHouseholderQr().solve(weight.cwiseProduct(right));
    const Eigen::VectorXd miss = (matrix * parabola - right).cwiseAbs() / (3.0 * height_noise * parabola[0]);
    for (int i = 0; i < count; ++i) weight[2 * i] = 1.0 / std::max(1.0, miss[2 * i]);
  }
  return parabola.head<2>();
}

/// Takes the noise of single solutions out of z and ∂z/∂w: the stiffness is a difference of both over one level and
/// multiplies it. A larger change than of noise is none, as where a second contact begins, and is limited.
void smooth_levels(std::vector<LoadedNode>& level, double step) {
  constexpr double most_height = 3e-4, most_slope = 1e-3;  // relative
  const std::vector<LoadedNode> solved = level;
  const double touch = level.front().z;
  for (std::size_t k = 1; k < level.size(); ++k) {
    const double at = static_cast<double>(k), w = at * step, lowering = solved[k].z - touch;
    const Eigen::Vector2d found = steepness(solved, step, static_cast<int>(k));
    const auto near = [](double wanted, double old, double most) {
      return std::clamp(wanted, (1.0 - most) * old, (1.0 + most) * old);
    };
    level[k].z = touch + near(found[0] * w * w, lowering, most_height);
    level[k].z_w = near((2.0 * found[0] + at * found[1]) * w, solved[k].z_w, most_slope);
  }
}

}  // namespace

LoadedColumn loaded_column(const ContactSearch& search, const WheelsetPose& pose, const LoadedColumnOptions& options) {
  const TouchPoint touch = search.first_touch(pose.y, pose.roll, pose.yaw);
  if (!std::isfinite(touch.z_touch)) {
    throw ComputationError(fmt::format("wheel and rail never meet at y = {:.6g} m, roll = {:.4g} rad, yaw = {:.4g} rad",
                                       pose.y, pose.roll, pose.yaw));
  }
  LoadedColumn column;
  column.level.resize(1);
  column.level.front().z = touch.z_touch;
  const double step = options.largest_level / (options.levels - 1);
  for (int k = 1; k < options.levels; ++k) {
    const double w = k * step;
    WheelsetPose at = pose;
    const auto steepness = [&](int level) {
      const double below = level * step;
      return (column.level[static_cast<std::size_t>(level)].z - touch.z_touch) / (below * below);
    };
    const double first_guess = 5e-5;  // m/J^(2/5), ordinary for a tread
    const double guess = k == 1 ? first_guess : k == 2 ? steepness(1) : 2.0 * steepness(k - 1) - steepness(k - 2);
    at.z = touch.z_touch + std::max(guess, 1e-7) * w * w;
    column.level.push_back(solved_level(search, at, touch.z_touch, w, options, column.solutions));
  }
  smooth_levels(column.level, step);
  LoadedNode& first = column.level.front();
  const LoadedNode& next = column.level[1];
  first.z_y = touch.z_touch_dy;
  first.part = next.part;
  return column;
}

}  // namespace railtab
