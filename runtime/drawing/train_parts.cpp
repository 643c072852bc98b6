#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "railtab/runtime/drawing/body_names.hpp"
#include "railtab/runtime/drawing/drawn_points.hpp"
#include "railtab/runtime/drawing/run_parts.hpp"

namespace railtab::drawing {
namespace {

/// A body as it is drawn: its place at rest behind the first wheelset, and a box about it.
struct DrawnBody {
  std::size_t index = 0;  // in StepRecord::bodies
  Eigen::Vector3d offset, low, high;
};

/// Where a body is at rest; older files say only where along the track.
Eigen::Vector3d rest_of(const ResultHeader& header, std::size_t body, double standard_z) {
  return {header.body_x[body], header.body_y.empty() ? 0.0 : header.body_y[body],
          header.body_z.empty() ? standard_z : header.body_z[body]};
}

/// From a car body to the end of it: a little beyond its last wheelset, and not into the next car body.
double half_length(const ResultHeader& header, const std::vector<std::size_t>& car_bodies, std::size_t body) {
  constexpr double overhang = 2.5, gap = 0.5, least = 3.0;  // drawn [m]
  const double x = header.body_x[body];
  double to_next = INFINITY, to_wheel = 0.0;
  for (const std::size_t other : car_bodies) {
    if (other != body) to_next = std::min(to_next, std::abs(header.body_x[other] - x));
  }
  for (const double wheel : header.wheel_x) {
    const bool own = std::abs(wheel - x) <= 0.5 * to_next;
    if (own) to_wheel = std::max(to_wheel, std::abs(wheel - x));
  }
  return std::max(least, std::min(to_wheel + overhang, 0.5 * (to_next - gap)));
}

std::vector<DrawnBody> drawn_bodies(const ResultHeader& header) {
  constexpr double car_body_z = -1.8, bogie_z = -0.6;            // of older files [m]
  constexpr double floor = -1.1, roof = -3.9, half_width = 1.4;  // of a car body [m]
  const Eigen::Vector3d bogie(1.6, 1.1, 0.15);                   // half of its box [m]
  std::vector<std::size_t> car_bodies;
  for (std::size_t b = 0; b < header.body_names.size(); ++b) {
    if (is_car_body(header.body_names[b])) car_bodies.push_back(b);
  }
  std::vector<DrawnBody> bodies;
  for (std::size_t b = 0; b < header.body_names.size(); ++b) {
    if (is_wheelset(header.body_names[b])) continue;
    if (!is_car_body(header.body_names[b])) {
      bodies.push_back({b, rest_of(header, b, bogie_z), -bogie, bogie});
      continue;
    }
    const Eigen::Vector3d rest = rest_of(header, b, car_body_z);
    const double half = half_length(header, car_bodies, b);
    bodies.push_back({b, rest, {-half, -half_width, roof - rest[2]}, {half, half_width, floor - rest[2]}});
  }
  return bodies;
}

/// Shared by the functions of parts, which std::function copies.
template <class Drawn>
using Shared = std::shared_ptr<const std::vector<Drawn>>;
template <class Drawn>
Shared<Drawn> shared(std::vector<Drawn> drawn) {
  return std::make_shared<const std::vector<Drawn>>(std::move(drawn));
}

Part bodies_part(const ResultHeader& header, const Shared<DrawnBody>& bodies) {
  return {"bodies", [bodies, &header](const StepRecord& step) {
            Grid grid;
            DrawnPoints points(grid);
            std::vector<std::int32_t> index;
            for (const DrawnBody& body : *bodies) {
              const Motion motion(step.bodies[body.index]);
              const Eigen::Vector3d rest = body.offset + Eigen::Vector3d(step.position, 0.0, 0.0);
              grid.add_cell(Cell::vertex, {{points.add(rest, motion, true)}});
              points.add_box(rest, motion, body.low, body.high);
              index.insert(index.end(), 2, static_cast<std::int32_t>(body.index));
            }
            points.write();
            grid.cell_data.push_back({"body", 1, std::move(index)});
            grid.texts.emplace_back("body_names", header.body_names);
            return grid;
          }};
}

/// A wheelset that is drawn: of a recorded body, or where only wheels are recorded, without displacement.
struct DrawnWheelset {
  std::optional<std::size_t> body;
  Eigen::Vector3d offset;
  double radius = 0.0;  // [m]
};

/// Height of a wheelset's centre above the rails, of files that do not say it: the rolling radius at the begin.
double radius_of(std::span<const StepRecord> records) {
  constexpr double standard = 0.46;  // [m]
  for (const StepRecord& step : records) {
    for (const WheelRecord& wheel : step.wheels) {
      if (wheel.patches > 0 && wheel.rolling_radius > 0.0) return wheel.rolling_radius;
    }
  }
  return standard;
}

std::vector<DrawnWheelset> drawn_wheelsets(const ResultHeader& header, std::span<const StepRecord> records) {
  const double radius = radius_of(records);
  std::vector<DrawnWheelset> wheelsets;
  for (std::size_t b = 0; b < header.body_x.size(); ++b) {
    if (!is_wheelset(header.body_names[b])) continue;
    const Eigen::Vector3d rest = rest_of(header, b, -radius);
    wheelsets.push_back({b, rest, -rest[2]});
  }
  if (!wheelsets.empty()) return wheelsets;
  for (std::size_t w = 0; w < header.wheel_x.size(); w += 2) {
    wheelsets.push_back({std::nullopt, {header.wheel_x[w], 0.0, -radius}, radius});
  }
  return wheelsets;
}

/// Two discs with their rim, and the number of cells that they are.
void add_wheel(Grid& grid, DrawnPoints& points, const Eigen::Vector3d& centre, const Motion& motion, double y,
               double radius) {
  constexpr int corners = 24;
  constexpr double half_width = 0.0675;  // drawn [m]
  std::array<std::vector<std::int64_t>, 2> rim;
  for (std::size_t side = 0; side < rim.size(); ++side) {
    for (int i = 0; i < corners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / corners;
      const Eigen::Vector3d arm(radius * std::cos(angle), y + (side == 0 ? -half_width : half_width),
                                radius * std::sin(angle));
      rim[side].push_back(points.add(centre + arm, motion.at(arm), false));
    }
    grid.add_cell(Cell::polygon, rim[side]);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(corners); ++i) {
    const std::size_t next = (i + 1) % corners;
    const std::array<std::int64_t, 4> quad{rim[0][i], rim[0][next], rim[1][next], rim[1][i]};
    grid.add_cell(Cell::quad, quad);
  }
}

Motion motion_of(const DrawnWheelset& wheelset, const StepRecord& step) {
  return wheelset.body ? Motion(step.bodies[*wheelset.body]) : Motion();
}

Part wheelsets_part(const ResultHeader& header, const Shared<DrawnWheelset>& wheelsets) {
  return {"wheelsets", [wheelsets, half = half_rail_distance(header)](const StepRecord& step) {
            Grid grid;
            DrawnPoints points(grid);
            std::vector<std::int32_t> body;
            for (const DrawnWheelset& wheelset : *wheelsets) {
              const Eigen::Vector3d centre = wheelset.offset + Eigen::Vector3d(step.position, 0.0, 0.0);
              const Motion motion = motion_of(wheelset, step), drawn = motion.without_pitch();
              const Eigen::Vector3d axle(0.08, half, 0.08);  // half of its box [m]
              grid.add_cell(Cell::vertex, {{points.add(centre, motion, wheelset.body.has_value())}});
              points.add_box(centre, drawn, -axle, axle);
              for (const double y : {-half, half}) add_wheel(grid, points, centre, drawn, y, wheelset.radius);
              body.resize(grid.types.size(), wheelset.body ? static_cast<std::int32_t>(*wheelset.body) : -1);
            }
            points.write();
            grid.cell_data.push_back({"body", 1, std::move(body)});
            return grid;
          }};
}

/// The wheelset that a wheel belongs to.
const DrawnWheelset& nearest(const std::vector<DrawnWheelset>& wheelsets, double x) {
  return *std::min_element(wheelsets.begin(), wheelsets.end(), [x](const DrawnWheelset& a, const DrawnWheelset& b) {
    return std::abs(a.offset[0] - x) < std::abs(b.offset[0] - x);
  });
}

/// Values of the contacts, wheel by wheel.
struct ContactValues {
  std::vector<float> force, normal_force, angle, penetration;
  std::vector<std::int32_t> wheel, patches, from_table;

  void add(std::size_t index, const WheelRecord& w) {
    for (const double component : {w.X, w.Y, w.Q}) force.push_back(static_cast<float>(component));
    normal_force.push_back(static_cast<float>(w.normal_force));
    angle.push_back(static_cast<float>(w.angle));
    penetration.push_back(static_cast<float>(w.penetration));
    wheel.push_back(static_cast<std::int32_t>(index));
    patches.push_back(w.patches);
    from_table.push_back(w.from_table);
  }
  void write(Grid& grid) {
    grid.point_data.push_back({"force", 3, std::move(force)});
    grid.point_data.push_back({"normal_force", 1, std::move(normal_force)});
    grid.point_data.push_back({"contact_angle", 1, std::move(angle)});
    grid.point_data.push_back({"penetration", 1, std::move(penetration)});
    grid.point_data.push_back({"wheel", 1, std::move(wheel)});
    grid.point_data.push_back({"patches", 1, std::move(patches)});
    grid.point_data.push_back({"from_table", 1, std::move(from_table)});
  }
};

/// Forces on the rails, where the largest patch of each wheel is; they move with the wheelset.
Part contact_forces_part(const ResultHeader& header, const Shared<DrawnWheelset>& wheelsets) {
  return {"contact_forces", [wheelsets, &header, half = half_rail_distance(header)](const StepRecord& step) {
            Grid grid;
            DrawnPoints points(grid);
            ContactValues values;
            for (std::size_t w = 0; w < step.wheels.size(); ++w) {
              const WheelRecord& wheel = step.wheels[w];
              const double side = w % 2 == 0 ? -1.0 : 1.0, y = side * (half + wheel.y_rail);
              const DrawnWheelset& wheelset = nearest(*wheelsets, header.wheel_x[w]);
              const Motion motion = motion_of(wheelset, step).without_pitch().at({0.0, y, wheelset.radius});
              const std::int64_t point = points.add({step.position + header.wheel_x[w], y, 0.0}, motion, false);
              grid.add_cell(Cell::vertex, {{point}});
              values.add(w, wheel);
            }
            points.write();
            values.write(grid);
            return grid;
          }};
}

}  // namespace

std::vector<Part> train_parts(const ResultHeader& header, std::span<const StepRecord> records) {
  std::vector<Part> parts;
  const Shared<DrawnBody> bodies = shared(header.body_x.empty() ? std::vector<DrawnBody>{} : drawn_bodies(header));
  const Shared<DrawnWheelset> wheelsets = shared(drawn_wheelsets(header, records));
  if (!bodies->empty()) parts.push_back(bodies_part(header, bodies));
  if (!wheelsets->empty()) parts.push_back(wheelsets_part(header, wheelsets));
  if (!header.wheel_x.empty()) parts.push_back(contact_forces_part(header, wheelsets));
  return parts;
}

std::vector<std::string> not_recorded(const ResultHeader& header) {
  std::vector<std::string> missing;
  if (header.wheel_x.empty()) missing.emplace_back("contact forces: output.wheels = true records them");
  if (header.body_names.empty()) missing.emplace_back("bodies of the train: output.bodies = [\"*\"] records them");
  if (!header.body_names.empty() && header.body_x.empty()) {
    missing.emplace_back("places of the bodies along the train: the file is of an older version, run the scene again");
  }
  const bool deck = std::any_of(header.node_names.begin(), header.node_names.end(), is_deck);
  if (!header.span_from.empty() && !deck) {
    missing.emplace_back("motion of the deck: output.nodes = [\"*\"] records it, at the positions of structure.report");
  } else if (!header.span_from.empty()) {
    missing.emplace_back(
        "motion of the deck and of the rails above it between the recorded nodes, and of the rails beside the bridge: "
        "structure.report chooses the nodes");
  }
  return missing;
}

std::vector<std::string> drawn_only(const ResultHeader& header) {
  std::vector<std::string> drawn{
      "where recorded = 0: between recorded nodes a cubic spline, supports and track beside the bridge at rest, "
      "corners "
      "of bodies by their rigid motion, contact forces with their wheelset; wheels do not turn",
      "sizes of bodies, wheels and deck"};
  if (header.body_z.empty() && !header.body_names.empty()) drawn.emplace_back("heights of the bodies");
  if (header.node_z.empty() && !header.node_names.empty()) drawn.emplace_back("places of the nodes across the track");
  return drawn;
}

}  // namespace railtab::drawing
