#pragma once

#include <optional>

#include "railtab/runtime/vsi/step.hpp"

namespace railtab {

/// Decides whether a step that has no solution is solved again with another contact geometry: where a table misses a
/// patch, its forces jump, and there may be no solution on either side; the online search has it.
class ContactRetry {
 public:
  explicit ContactRetry(const VsiModel& model)
      : table_(model.normal_contact == NormalContact::hertz && model.contact.geometry->is_table()) {}
  [[nodiscard]] std::optional<GeometrySource> after(StepOutcome outcome, GeometrySource used) const noexcept {
    const bool search = table_ && outcome == StepOutcome::diverged && used == GeometrySource::model;
    return search ? std::optional(GeometrySource::search) : std::nullopt;
  }

 private:
  bool table_;
};

}  // namespace railtab
