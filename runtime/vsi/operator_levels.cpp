#include "railtab/runtime/vsi/operator_levels.hpp"

#include <cmath>
#include <cstdlib>
#include <iterator>

#include "railtab/runtime/vsi/operator_room.hpp"

namespace railtab {

double OperatorLevels::length(int level) const noexcept { return std::ldexp(time_step_, -level); }

const StepOperators& OperatorLevels::update(int level, double end, const DofRange& active) {
  auto found = operators_.find(level);
  if (found == operators_.end()) {
    make_room(level);
    const HhtScheme scheme{.alpha = alpha_, .time_step = length(level)};
    if (model_.structure && !model_.store && !matrices_) {
      matrices_ = std::make_shared<StepMatrices>(model_.structure, !model_.window);
    }
    found = operators_.emplace(level, StepOperators(model_, scheme, matrices_)).first;
  }
  found->second.update_for_time(model_, end, active);
  return found->second;
}

// Memory is bounded: of divided steps' operators, those of the level farthest from the one to come go. Nobody holds on
// to operators of another level: a step that is divided no longer needs its own.
void OperatorLevels::make_room(int level) {
  const auto has_room = [&] {
    OperatorRoom room;
    for (const auto& [of_level, operators] : operators_) room.add(operators.bytes(model_));
    return room.for_another();
  };
  while (!has_room()) {
    const auto finest = std::prev(operators_.end()), coarsest = std::next(operators_.begin());
    operators_.erase(std::abs(finest->first - level) > std::abs(coarsest->first - level) ? finest : coarsest);
  }
}

}  // namespace railtab
