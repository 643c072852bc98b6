#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/contact/hertz.hpp"
#include "railtab/tablegen/contact_bands.hpp"
#include "railtab/tablegen/contact_elements.hpp"
#include "railtab/tablegen/normal_contact_solver.hpp"

namespace railtab {

struct LoadedContactOptions {
  ElasticMaterial wheel, rail;
  ContactElementOptions elements;
  NormalContactTolerance tolerance;
  /// Of contact_at_load(), share of the load, 1e-9..1e-2. Not below what the residual leaves of the force.
  double load_tolerance = 1e-5;

  /// E* of the two bodies: 1/E* = (1 − ν_w²)/E_w + (1 − ν_r²)/E_r [Pa].
  [[nodiscard]] double contact_modulus() const noexcept;
  /// @throws InputError
  void validate() const;
};

/// Force on the rail and its moment about the rail-head origin below the wheelset centre (x = 0), track axes.
struct RailWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< [N m]

  void add(const Eigen::Vector3d& at, const Eigen::Vector3d& f);
  /// The moment about another point, in the rail-head frame, x relative to the wheelset centre.
  [[nodiscard]] Eigen::Vector3d moment_about(const Eigen::Vector3d& point) const { return moment - point.cross(force); }
};

/// The half-space solution of one (right) wheel on its rail, without friction.
struct LoadedContact {
  WheelsetPose pose;
  std::vector<SurfaceOverlap> regions;  ///< empty where nothing touches; then all that follows is zero or empty
  ContactElements elements;
  Eigen::VectorXd pressure;  ///< of the elements [Pa]
  std::vector<int> band;     ///< of each element, its place in `bands`; −1 without pressure
  std::vector<ContactBand> bands;
  RailWrench on_rail;             ///< ∫ p n dA: without friction no longitudinal force, the rail being a cylinder
  double normal_force = 0.0;      ///< ∫ p dA [N]
  double elastic_energy = 0.0;    ///< ½ ∫ p h dA [J]
  double largest_pressure = 0.0;  ///< [Pa]
  /// Of elements, across the ellipse of a Hertzian contact whose pressure is curved along s as this one's is at its
  /// largest. Fewer than eight: the largest pressure is not resolved, as at an edge or with too few elements allowed.
  double rows_across_peak = 0.0;
  int refinements = 0;    ///< of the rows that the overlap asks for, to half as many more each
  double area = 0.0;      ///< of the elements with pressure [m²]
  double residual = 0.0;  ///< NormalPressure::residual
  int iterations = 0;
  bool converged = false;
};

/// Pressure at a pose of the right wheel. Rail: a cylinder along x with the profile; wheel: a surface of revolution.
/// The undeformed distance is that along the rail's local normals, the influence that of a half-space over the
/// developed rail surface, times the cosine of the angle between the normals (docs/theory/loaded_contact.md).
/// @param refinements to begin with, such as one less than a contact near by has; more follow until the largest
/// pressure has settled, and it begins anew without any where they do not converge
/// @throws InputError of the options, TooManyElements
[[nodiscard]] LoadedContact loaded_contact(const ContactSearch& search, const WheelsetPose& pose,
                                           const LoadedContactOptions& options = {}, int refinements = 0);

/// A wheel lowered until it carries a load.
struct ContactAtLoad {
  LoadedContact contact;
  double vertical_force = 0.0;  ///< on the rail, friction's share included [N]
  int evaluations = 0;          ///< of the pressure
  bool converged = false;       ///< the load is met to its tolerance, by a converged pressure
};

/// Vertical force on the rail by friction at a contact, downward [N].
using FrictionShare = std::function<double(const LoadedContact&)>;

/// The height at which a wheel carries a vertical load.
/// @param pose its z is not used @param load > 0 [N]
/// @param friction added to the vertical force of the pressure where given
/// @throws InputError also where wheel and rail never meet; TooManyElements
[[nodiscard]] ContactAtLoad contact_at_load(const ContactSearch& search, const WheelsetPose& pose, double load,
                                            const LoadedContactOptions& options = {},
                                            const FrictionShare& friction = nullptr);

}  // namespace railtab
