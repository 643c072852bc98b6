#pragma once

#include <memory>
#include <vector>

#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/tablegen/rolling_contact_grid.hpp"

namespace railtab {

/// How the exact solution is discretised and when it is done.
struct RollingContactOptions {
  int elements = 40;        ///< n along each axis of an ellipse, 4..240
  double tolerance = 1e-6;  ///< on the residual of a solution, 1e-12..1e-2
  int max_iterations = 50;  ///< Newton steps before the safe method takes over, 0..1000
  /// Where the rigid slip of a step is taken, in elements ahead of the observed element's centre, 0..1. One half is the
  /// middle of the step; one sixth halves the error of coarse grids and is what CONTACT does.
  double slip_ahead = 1.0 / 6.0;
  using ElementSize = railtab::ElementSize;
  ElementSize size = ElementSize::rectangle;
  /// Force of a slipping element: the bound against the slip at one place of it, as CONTACT, or its mean over the
  /// element, which counts where the slip turns within elements. The tractions are the same.
  enum class SlipDirection { sampled, averaged } direction = SlipDirection::sampled;

  /// @throws InputError
  void validate() const;
};

/// One solution of exact rolling contact and what proves it.
struct RollingContactSolution {
  CreepForce force;  ///< on the wheel, normalised
  /// p_x of all elements, then p_y; rows across (y, rightward), each forward (x); zero where there is no contact.
  std::vector<double> traction;
  /// Σ|p − P(p − s/b0)| over that of p = 0: P the projection on the friction circle, b0 an element's own influence.
  double residual = 0.0;
  double bound_excess = 0.0;  ///< largest |p|/(μ p_n) − 1, zero (to rounding) where friction is not exceeded
  /// Σ(|p||s| + p·s)/Σ|p||s| over the slipping elements: zero where slip opposes traction, 2 where it goes along.
  double slip_deviation = 0.0;
  int iterations = 0;        ///< of Newton's method, or steps rolled by the safe one
  int products = 0;          ///< with the influence matrix
  int adhesion = 0;          ///< elements that stick
  int slip = 0;              ///< elements that slip
  bool safe_method = false;  ///< Newton's method failed, the slow one was used
  bool converged = false;    ///< the residual is below the tolerance
};

/// Rigid slip w of the elements, wheel against rail over the running speed [-].
struct RigidSlip {
  /// w_x of all elements, then w_y, each taken slip_ahead elements ahead of the element's centre.
  ElementField w;
  double spin = 0.0;  ///< how w turns: −∂w_x/∂y and ∂w_y/∂x where an averaged slip direction has no neighbour to ask
};

/// Kalker's exact theory of steady rolling [Kalker1990, Ch. 4]: two half-spaces of the same material, G = 1, Coulomb
/// friction. The contact area is an ellipse with elliptic pressure, normalised by μF_n = 1, a = √(a/b), b = 1/a; or any
/// set of elements with any bounds and any rigid slip.
///
/// Tractions p are constant on each element. With the slip per step of one element s = B p + w dx, in an ellipse
/// w = (υx − φ y, υy + φ x): |p| ≤ μ p_n, s = 0 where |p| < μ p_n, else s against p. The error is of first order in
/// 1/n. The object is the work space for one contact area: one thread at a time.
class RollingContact {
 public:
  /// @param ratio a/b, 1e-4..1e4; @param nu Poisson's ratio 0..0.5. @throws InputError
  RollingContact(double ratio, double nu, const RollingContactOptions& options = {});
  /// Any contact area. Tractions are in units of G, as the grid's bounds, μ p_n/G; forces in units of G times area.
  /// @param grid not empty; options.elements and options.size have no meaning. @throws InputError
  RollingContact(RollingContactGrid grid, double nu, const RollingContactOptions& options);
  ~RollingContact();
  RollingContact(RollingContact&&) noexcept;
  RollingContact& operator=(RollingContact&&) noexcept;

  /// @param creepage finite
  /// @param start tractions to begin with, laid out as RollingContactSolution::traction (those of a neighbouring case);
  /// nullptr for none. What exceeds friction is cut back to it.
  [[nodiscard]] RollingContactSolution solve(const Creepage& creepage, const std::vector<double>* start = nullptr);
  /// The same for any rigid slip, finite.
  [[nodiscard]] RollingContactSolution solve(const RigidSlip& rigid, const std::vector<double>* start = nullptr);
  /// Start for solve() from a solution of the same ellipse with half as many elements along each axis.
  [[nodiscard]] std::vector<double> refined(const std::vector<double>& half_traction) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A solution without the first-order error of the elements.
struct ExtrapolatedContactSolution {
  CreepForce force;  ///< 2 fine − coarse; may exceed friction by what is left of the error
  RollingContactSolution coarse, fine;
};

/// Exact rolling contact on n/2 and n elements of equal area, extrapolated to elements of size zero; the coarse
/// solution starts the fine one.
class ExtrapolatedRollingContact {
 public:
  /// As RollingContact; options.elements is the fine grid's, even and at least 8; of equal area with averaged slip
  /// direction whatever the options say.
  ExtrapolatedRollingContact(double ratio, double nu, const RollingContactOptions& options = {});
  /// @param coarse_start tractions on the coarse grid to begin with, those of a neighbouring creepage; nullptr for none
  [[nodiscard]] ExtrapolatedContactSolution solve(const Creepage& creepage,
                                                  const std::vector<double>* coarse_start = nullptr);

 private:
  RollingContact coarse_, fine_;
};

}  // namespace railtab
