#include "derailment.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace railtab {
namespace {

// A rail head is 72 mm wide and a wheel 135 mm: beyond, the wheel is beside its rail whatever the profiles.
constexpr double farthest_aside = 0.15;  // m
constexpr double deepest = 0.1;          // m, below the rails

bool touches(const VsiState& state, int wheel) {
  return state.contact.patches[static_cast<std::size_t>(wheel)].count > 0;
}

/// Mean position of the two rail heads under a wheelset, lateral and down.
std::array<double, 2> rails_under(const VsiModel& model, const VsiState& state, int wheelset) {
  std::array<double, 2> mean{};
  const double x = model.wheelset_x(wheelset, state.time);
  for (const RailSide side : {RailSide::left, RailSide::right}) {
    const RailDeviation deviation = model.irregularity.at(side, x);
    mean[0] += 0.5 * deviation.y;
    mean[1] += 0.5 * deviation.z;
  }
  if (!model.structure) return mean;
  Eigen::VectorXd rail = Eigen::VectorXd::Zero(12 * model.wheelsets());
  gather_rails(place_wheels(model, state.time), state.structure.displacement, rail);
  for (int wheel : {2 * wheelset, 2 * wheelset + 1}) {
    mean[0] += 0.5 * rail[rail_unknown(wheel)];
    mean[1] += 0.5 * rail[rail_unknown(wheel) + 1];
  }
  return mean;
}

}  // namespace

std::string derailment(const VsiModel& model, const VsiState& state) {
  if (model.normal_contact == NormalContact::rigid) return {};
  for (int wheelset = 0; wheelset < model.wheelsets(); ++wheelset) {
    if (touches(state, 2 * wheelset) && touches(state, 2 * wheelset + 1)) continue;
    const auto vehicle = static_cast<std::size_t>(wheelset / model.wheelsets_per_vehicle());
    const int body = model.vehicle.wheelsets[static_cast<std::size_t>(wheelset % model.wheelsets_per_vehicle())];
    const DofIndices& dof = model.vehicle.dof[static_cast<std::size_t>(body)];
    const auto at = [&](std::size_t k) { return dof[k] == held ? 0.0 : state.vehicle[vehicle].displacement[dof[k]]; };
    const std::array<double, 2> rails = rails_under(model, state, wheelset);
    const double aside = at(1) - rails[0], down = at(2) - rails[1];
    if (std::abs(aside) <= farthest_aside && down <= deepest) continue;
    return fmt::format("wheelset {} has left the rails at t = {:.6g} s: it stands {:.3g} m to the {} and {:.3g} m {}",
                       wheelset + 1, state.time, std::abs(aside), aside < 0.0 ? "left" : "right", std::abs(down),
                       down < 0.0 ? "above" : "below");
  }
  return {};
}

}  // namespace railtab
