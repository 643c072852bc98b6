#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "railtab/runtime/contact/wheel_contact.hpp"

namespace railtab {

/// The wheel-rail contacts of a train: one model for all wheelsets, or one for each, which then differ in their
/// geometry.
struct TrainContact {
  std::vector<WheelContactModel> model;

  TrainContact(WheelContactModel of_all) { model.push_back(std::move(of_all)); }  // NOLINT(google-explicit-constructor)

  [[nodiscard]] const WheelContactModel& operator[](int wheelset) const noexcept {
    return model[model.size() == 1 ? 0 : static_cast<std::size_t>(wheelset)];
  }
  /// What is the same for all wheelsets.
  [[nodiscard]] const WheelContactModel& shared() const noexcept { return model.front(); }
  void set_speed(double speed) noexcept {
    for (WheelContactModel& m : model) m.speed = speed;
  }
};

}  // namespace railtab
