#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <utility>

#include "railtab/runtime/algebra/section_layout.hpp"
#include "railtab/runtime/algebra/sectioned_product.hpp"
#include "railtab/runtime/vsi/linear_motion.hpp"

namespace railtab {

/// A motion in the order of a SectionLayout, by sums and differences of its pairs.
struct OrderedMotion {
  std::shared_ptr<const SectionLayout> layout;  ///< null: there is none
  Eigen::VectorXd displacement, velocity, acceleration;
};

/// Motion of a structure at the end of a step, and the contacts' loads on it. Steps of a structure in sections leave
/// the motion of the active unknowns in the sections' order, in which the next step goes on; whoever asks for it gets
/// it in the unknowns' own order. Reading may convert it: two threads may not read one motion at a time.
class StructureMotion {
 public:
  explicit StructureMotion(Eigen::Index dofs = 0) : own_order_(dofs) {}
  explicit StructureMotion(LinearMotion motion) : own_order_(std::move(motion)) {}

  [[nodiscard]] Eigen::Index dofs() const noexcept { return own_order_.displacement.size(); }
  /// All unknowns in their own order.
  [[nodiscard]] const LinearMotion& whole() const;
  /// The same to be changed: the next step begins from it, as it does after a checkpoint.
  [[nodiscard]] LinearMotion& whole();
  /// The loads of all unknowns and the motion of these; that of others is of an earlier step, in a build with
  /// assertions not a number. @param unknowns some perhaps held
  [[nodiscard]] const LinearMotion& at(std::span<const int> unknowns) const;
  /// The loads, to be read or changed. Not to be asked for motion: that may be of an earlier step.
  [[nodiscard]] LinearMotion& loads() noexcept { return own_order_; }
  [[nodiscard]] const LinearMotion& loads() const noexcept { return own_order_; }
  /// Sets displacement, velocity and acceleration of one unknown.
  void set(int unknown, const Eigen::RowVector3d& motion);

  /// The motion of the layout's unknowns in its order.
  [[nodiscard]] const OrderedMotion& in_order(const std::shared_ptr<const SectionLayout>& layout) const;
  /// What a predictor makes of the motion, in the layout's order; end_step() has left it where nothing has changed the
  /// motion since. Its borders are anyone's to write. @param predictor one for a layout
  [[nodiscard]] SectionedProduct::Motion& predicted(const WeightedPredictor& predictor,
                                                    const std::shared_ptr<const SectionLayout>& layout) const;
  /// Displacement, velocity and acceleration as the next step takes them up: in the order of in_order(), if it was
  /// called since the motion was last changed as a whole, or in their own.
  [[nodiscard]] std::array<const Eigen::VectorXd*, 3> numbers() const;
  /// The same to be changed.
  [[nodiscard]] std::array<Eigen::VectorXd*, 3> numbers();
  /// Ends a step with an increment in the layout's order. @pre in_order() of that layout, at the step's beginning
  /// @param next the predictor of that layout
  void end_step(const HhtScheme& scheme, const WeightedPredictor& next, const Eigen::VectorXd& increment);

 private:
  void update_whole() const;

  // Each stands for the motion where it is up to date. In its own order, unknowns beyond the layout always are.
  mutable LinearMotion own_order_;
  mutable OrderedMotion ordered_;
  mutable bool own_order_is_current_ = true;
  // The last bits of predicted_ depend on whether end_step() has made it: runs that go on from a checkpoint are the
  // same since whole(), which makes a motion the beginning of a new run, has it made again in both.
  mutable SectionedProduct::Motion predicted_;
  mutable bool predicted_is_current_ = false;
};

}  // namespace railtab
