#include "railtab/runtime/stability/rigid_rails.hpp"

namespace railtab {

VsiModel on_rigid_rails(const VsiModel& model, double speed) {
  VsiModel rigid;
  rigid.vehicle = model.vehicle;
  rigid.vehicle_x = {0.0};
  rigid.geometry = model.geometry;
  rigid.contact = model.contact;
  rigid.contact.speed = speed;
  if (!model.wheelset_geometry.empty()) {
    const auto first = model.wheelset_geometry.begin();
    rigid.wheelset_geometry.assign(first, first + model.wheelsets_per_vehicle());
  }
  rigid.gyroscopic_moments = model.gyroscopic_moments;
  return rigid;
}

}  // namespace railtab
