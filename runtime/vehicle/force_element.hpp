#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "railtab/runtime/vehicle/force_curve.hpp"

namespace railtab {

/// Which force elements of a vehicle's data a run has.
enum class ForceElementChoice {
  nonlinear,  ///< stops, dampers by their curves, dry friction
  linear,     ///< linear stand-ins of dampers and friction, no stops
};

/// Dry friction between the two ends of a suspension unit along or about one axis.
struct Friction {
  double force = 0.0;    ///< limit that no load changes [N] or [N m]
  double ratio = 0.0;    ///< limit over the load that the unit's spring along z carries [-], as on a wedge
  double travel = 2e-4;  ///< before it slides under the load at rest, elastic [m] or [rad], > 0
  [[nodiscard]] bool acts() const noexcept { return force > 0.0 || ratio > 0.0; }
};

/// What a suspension unit has along one axis besides its linear spring and damper.
struct NonlinearUnit {
  ForceCurve stop;    ///< beside the spring [m], [N]
  ForceCurve damper;  ///< in place of the linear damper, in series with the unit's series stiffness [m/s], [N]
  Friction friction;  ///< in place of the linear damper
  [[nodiscard]] bool replaces_damper() const noexcept { return !damper.empty() || friction.acts(); }
};

enum class ForceElementKind { stop, damper, friction };

/// A force element that is not linear. It pulls its two ends together by the force f of its elongation or its rate.
struct ForceElement {
  std::string name;  ///< "secondary suspension along y, bogie-1 to car-body, right"
  ForceElementKind kind;
  int row;                 ///< of ForceElements::rows, its elongation
  ForceCurve curve;        ///< of a stop or a damper
  Friction friction;       ///< of kind friction
  double stiffness = 0.0;  ///< of a friction element before it slides [N/m] or [N m/rad]
  /// The load of a friction element with a ratio: load + load_stiffness · (row load_row) [N], none below zero.
  int load_row = -1;
  double load = 0.0, load_stiffness = 0.0;
  int coach = 0;  ///< of its first body (RigidBody::coach)

  /// Limit of a friction element at the elongations x of all rows, and its derivative by that of load_row.
  struct Limit {
    double force, by_load_row;
  };
  [[nodiscard]] Limit limit(const Eigen::VectorXd& x) const noexcept;
};

/// The elements of a vehicle. With elongations x = rows · u they load its dofs by −rowsᵀ f.
struct ForceElements {
  Eigen::MatrixXd rows;  ///< elongations per dofs; none where there is no element
  std::vector<ForceElement> element;

  [[nodiscard]] bool empty() const noexcept { return element.empty(); }
  [[nodiscard]] int elongations() const noexcept { return static_cast<int>(rows.rows()); }
  /// Forces by row of a vehicle as it moves.
  /// @param x, v elongations and rates  @param friction force of every element of that kind, by element
  [[nodiscard]] Eigen::VectorXd force(const Eigen::VectorXd& x, const Eigen::VectorXd& v,
                                      const Eigen::VectorXd& friction) const;
};

struct Suspension;
struct VehicleModel;

/// Adds the elements of the units whose rows are not held. Dampers in series act on the rows that add_series_dampers()
/// has numbered in the same order.
/// @param rest displacement of all dofs under gravity, from which units carry their loads
/// @param first_series_row first inner degree of freedom of the series stiffnesses
/// @throws InputError where a friction ratio belongs to a spring without load
void add_force_elements(VehicleModel& vehicle, const std::vector<Suspension>& suspension, const Eigen::VectorXd& rest,
                        int first_series_row);

}  // namespace railtab
