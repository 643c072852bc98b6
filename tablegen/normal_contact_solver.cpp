#include "railtab/tablegen/normal_contact_solver.hpp"

#include <fmt/format.h>

#include <cmath>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

void NormalContactTolerance::validate() const {
  if (!(residual >= 1e-12 && residual <= 1e-2)) {
    throw input_error("residual tolerance", fmt::format("{}", residual), "1e-12..1e-2");
  }
  if (max_iterations < 1 || max_iterations > 10000) {
    throw input_error("max_iterations", fmt::format("{}", max_iterations), "1..10000");
  }
}

namespace {

/// Conjugate gradients on a contact area that changes.
class ContactIteration {
 public:
  ContactIteration(NormalInfluence& influence, const Eigen::VectorXd& overlap, Eigen::VectorXd start)
      : influence_(influence),
        overlap_(overlap),
        p_(std::move(start)),
        gap_(p_.size()),
        z_(p_.size()),
        direction_(Eigen::VectorXd::Zero(p_.size())),
        product_(p_.size()),
        active_(Eigen::VectorXd::Zero(p_.size())) {
    for (Eigen::Index k = 0; k < p_.size(); ++k) scale_ += std::max(0.0, overlap_[k]) / influence_.self();
    find_gap();
  }

  [[nodiscard]] double residual() const {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < p_.size(); ++k)
      sum += std::abs(p_[k] - std::max(0.0, p_[k] - gap_[k] / influence_.self()));
    return sum / scale_;
  }

  void advance() {
    set_direction();
    influence_.apply(direction_, product_);
    const double curvature = direction_.dot(product_);
    if (curvature <= 0.0) return restart();
    const double step = -direction_.dot(gap_) / curvature;
    p_ += step * direction_;
    if (p_.minCoeff() < 0.0) {
      p_ = p_.cwiseMax(0.0);
      restart();
    } else {
      gap_ += step * product_;
    }
  }

  [[nodiscard]] bool has_contact() const { return scale_ > 0.0; }
  [[nodiscard]] Eigen::VectorXd& pressure() { return p_; }

 private:
  void find_gap() {
    influence_.apply(p_, gap_);
    gap_ -= overlap_;
  }

  /// Over the elements in contact and those that overlap outside; anew where these are others than before.
  void set_direction() {
    for (Eigen::Index k = 0; k < p_.size(); ++k) {
      const double active = p_[k] > 0.0 || gap_[k] < 0.0 ? 1.0 : 0.0;
      fresh_ = fresh_ || active != active_[k];
      active_[k] = active;
    }
    product_ = active_.cwiseProduct(gap_);
    influence_.apply_inverse(product_, z_);
    z_ = z_.cwiseProduct(active_);
    const double size = z_.dot(gap_);
    const double keep = fresh_ ? 0.0 : size / size_before_;
    direction_ = keep * direction_ - z_;
    size_before_ = size;
    fresh_ = false;
  }

  void restart() {
    find_gap();
    fresh_ = true;
  }

  NormalInfluence& influence_;
  const Eigen::VectorXd& overlap_;
  Eigen::VectorXd p_, gap_, z_, direction_, product_, active_;
  double scale_ = 0.0, size_before_ = 1.0;
  bool fresh_ = true;
};

}  // namespace

NormalPressure normal_pressure(NormalInfluence& influence, const Eigen::VectorXd& overlap, Eigen::VectorXd start,
                               const NormalContactTolerance& tolerance) {
  NormalPressure result;
  ContactIteration iteration(influence, overlap, std::move(start));
  result.converged = !iteration.has_contact();
  while (!result.converged) {
    result.residual = iteration.residual();
    result.converged = result.residual <= tolerance.residual;
    if (result.converged || result.iterations >= tolerance.max_iterations) break;
    iteration.advance();
    ++result.iterations;
  }
  result.pressure = std::move(iteration.pressure());
  return result;
}

}  // namespace railtab
