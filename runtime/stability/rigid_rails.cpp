#include "railtab/runtime/stability/rigid_rails.hpp"

namespace railtab {

VsiModel on_rigid_rails(const VsiModel& model, double speed) {
  VsiModel rigid;
  rigid.vehicle = model.vehicle;
  rigid.vehicle_x = {0.0};
  rigid.geometry = model.geometry;
  rigid.contact = model.contact;
  rigid.contact.speed = speed;
  rigid.gyroscopic_moments = model.gyroscopic_moments;
  return rigid;
}

}  // namespace railtab
