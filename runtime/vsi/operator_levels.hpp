#pragma once

#include <map>
#include <memory>

#include "railtab/runtime/vsi/step_operators.hpp"

namespace railtab {

/// Operators of the steps of a model, whole and divided, made when first needed. Runs of one model in steps of one size
/// may share them one after the other: what they hold depends on the time of a step alone.
class OperatorLevels {
 public:
  /// @param model outlives this
  OperatorLevels(const VsiModel& model, double alpha, double time_step)
      : model_(model), alpha_(alpha), time_step_(time_step) {}

  [[nodiscard]] const VsiModel& model() const noexcept { return model_; }
  /// Length of the steps of a level, halved `level` times [s].
  [[nodiscard]] double length(int level) const noexcept;
  /// For a step of a level that ends at `end`; those of other levels may go.
  const StepOperators& update(int level, double end, const DofRange& active);
  /// As they were last updated.
  [[nodiscard]] const StepOperators& at(int level) const { return operators_.at(level); }

 private:
  void make_room(int level);

  const VsiModel& model_;
  double alpha_, time_step_;                      // [s]
  std::shared_ptr<const StepMatrices> matrices_;  // made when first needed; not where the model has a store
  std::map<int, StepOperators> operators_;
};

}  // namespace railtab
