#include "railtab/runtime/structure/deck_channels.hpp"

namespace railtab {

std::string_view quantity_name(DeckQuantity quantity) noexcept {
  switch (quantity) {
    case DeckQuantity::displacement:
      return "displacement";
    case DeckQuantity::roll:
      return "roll";
    case DeckQuantity::twist:
      return "twist";
    case DeckQuantity::end_rotation:
      return "end_rotation";
    case DeckQuantity::horizontal_rotation:
      return "horizontal_rotation";
    case DeckQuantity::joint_step:
      return "joint_step";
    case DeckQuantity::joint_gap:
      return "joint_gap";
    case DeckQuantity::bending_moment:
      return "bending_moment";
    case DeckQuantity::shear_force:
      break;
  }
  return "shear_force";
}

std::string_view quantity_unit(DeckQuantity quantity) noexcept {
  switch (quantity) {
    case DeckQuantity::roll:
    case DeckQuantity::end_rotation:
    case DeckQuantity::horizontal_rotation:
      return "rad";
    case DeckQuantity::bending_moment:
      return "N m";
    case DeckQuantity::shear_force:
      return "N";
    default:
      return "m";
  }
}

void add_sum(const DofSum& sum, double factor, DofSum& to) {
  for (const auto& [dof, value] : sum) to.emplace_back(dof, factor * value);
}

}  // namespace railtab
