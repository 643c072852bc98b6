#include "railtab/runtime/stability/rigid_rails.hpp"

#include <utility>

namespace railtab {

VsiModel on_rigid_rails(const VsiModel& model, double speed) { return on_rigid_rails(model, model.vehicle, 0, speed); }

VsiModel on_rigid_rails(const VsiModel& model, VehicleModel vehicle, int first_wheelset, double speed) {
  VsiModel rigid;
  rigid.vehicle = std::move(vehicle);
  rigid.vehicle_x = {0.0};
  rigid.geometry = model.geometry;
  rigid.contact = model.contact;
  rigid.contact.speed = speed;
  if (!model.wheelset_geometry.empty()) {
    const auto first = model.wheelset_geometry.begin() + first_wheelset;
    rigid.wheelset_geometry.assign(first, first + rigid.wheelsets());
    rigid.geometry = rigid.wheelset_geometry.front();
    rigid.contact.geometry = rigid.geometry.get();
  }
  rigid.gyroscopic_moments = model.gyroscopic_moments;
  return rigid;
}

}  // namespace railtab
