#include "railtab/runtime/vsi/structure_motion.hpp"

#include <cassert>
#include <limits>

#include "railtab/runtime/base/dof_indices.hpp"

namespace railtab {

namespace {

// The vectors of a motion: displacement, velocity, acceleration.
template <class Motion>
auto vectors(Motion& motion) {
  return std::array{&motion.displacement, &motion.velocity, &motion.acceleration};
}

}  // namespace

void StructureMotion::update_whole() const {
  if (own_order_is_current_) return;
  const auto to = vectors(own_order_);
  const auto from = vectors(ordered_);
  for (std::size_t k = 0; k < to.size(); ++k) ordered_.layout->out_of(*from[k], *to[k]);
  own_order_is_current_ = true;
}

const LinearMotion& StructureMotion::whole() const {
  update_whole();
  return own_order_;
}

LinearMotion& StructureMotion::whole() {
  update_whole();
  ordered_.layout.reset();
  predicted_is_current_ = false;
  return own_order_;
}

const LinearMotion& StructureMotion::at(std::span<const int> unknowns) const {
  if (own_order_is_current_) return own_order_;
  const SectionLayout& layout = *ordered_.layout;
  for (const int unknown : unknowns) {
    if (unknown == held || !layout.contains(unknown)) continue;
    own_order_.displacement[unknown] = layout.value(ordered_.displacement, unknown);
    own_order_.velocity[unknown] = layout.value(ordered_.velocity, unknown);
    own_order_.acceleration[unknown] = layout.value(ordered_.acceleration, unknown);
  }
  return own_order_;
}

void StructureMotion::set(int unknown, const Eigen::RowVector3d& motion) {
  predicted_is_current_ = false;
  const auto own = vectors(own_order_);
  const auto ordered = vectors(ordered_);
  for (std::size_t k = 0; k < own.size(); ++k) {
    const double value = motion[static_cast<Eigen::Index>(k)];
    (*own[k])[unknown] = value;
    if (ordered_.layout && ordered_.layout->contains(unknown)) ordered_.layout->set(unknown, value, *ordered[k]);
  }
}

const OrderedMotion& StructureMotion::in_order(const std::shared_ptr<const SectionLayout>& layout) const {
  if (ordered_.layout == layout) return ordered_;
  update_whole();
  ordered_.layout = layout;
  predicted_is_current_ = false;
  const auto from = vectors(own_order_);
  const auto to = vectors(ordered_);
  for (std::size_t k = 0; k < to.size(); ++k) {
    to[k]->setZero(layout->size());  // borders, too
    layout->into(*from[k], *to[k]);
  }
  return ordered_;
}

SectionedProduct::Motion& StructureMotion::predicted(const WeightedPredictor& p,
                                                     const std::shared_ptr<const SectionLayout>& layout) const {
  const OrderedMotion& m = in_order(layout);
  if (!predicted_is_current_) {
    p.predict(m.displacement, m.velocity, m.acceleration, predicted_.u, predicted_.v);
    predicted_is_current_ = true;
  }
  return predicted_;
}

std::array<const Eigen::VectorXd*, 3> StructureMotion::numbers() const {
  return ordered_.layout ? vectors(std::as_const(ordered_)) : vectors(std::as_const(own_order_));
}

std::array<Eigen::VectorXd*, 3> StructureMotion::numbers() {
  own_order_is_current_ = !ordered_.layout;
  predicted_is_current_ = false;
  return ordered_.layout ? vectors(ordered_) : vectors(own_order_);
}

void StructureMotion::end_step(const HhtScheme& scheme, const WeightedPredictor& next,
                               const Eigen::VectorXd& increment) {
  assert(ordered_.layout && increment.size() >= ordered_.layout->size());
  const StepEnd end = step_end(scheme, ordered_);
  const Eigen::Index size = ordered_.displacement.size();
  predicted_.u.resize(size);
  predicted_.v.resize(size);
  double *const u = predicted_.u.data(), *const v = predicted_.v.data();
#pragma GCC ivdep
  for (Eigen::Index i = 0; i < size; ++i) {
    end.move(static_cast<std::size_t>(i), increment[i]);
    next.predict(end.u[i], end.v[i], end.w[i], u[i], v[i]);
  }
  predicted_is_current_ = true;
  own_order_is_current_ = false;
#ifndef NDEBUG
  for (Eigen::VectorXd* vector : vectors(own_order_)) {
    ordered_.layout->range.of(*vector).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
#endif
}

}  // namespace railtab
