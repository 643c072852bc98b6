#include "railtab/runtime/contact/contact_geometry.hpp"

#include "railtab/runtime/contact/equivalent_conicity.hpp"
#include "railtab/runtime/contact/rolling_radius_difference.hpp"

namespace railtab {

namespace {

std::optional<double> conicity_at(const ContactGeometry& geometry, double amplitude) {
  // as far as a wave about a rest off the centre goes; ΔR within some 1e-3 of its size
  constexpr double off_centre = 3e-3;
  const double reach = amplitude + off_centre;
  const WheelsetContactOptions options{.y_low = -reach, .y_high = reach, .step = 5e-4, .tolerance = 5e-7};
  const TableContact* const table = geometry.table();
  const auto tabulated = [table](const WheelsetPose& pose, double near_miss) {
    return table->patches(pose, near_miss);
  };
  const RadiusDifferenceCurve curve(table ? wheelset_contacts(tabulated, geometry.pair(), options)
                                          : wheelset_contacts(ContactSearch(geometry.pair()), options));
  const EquivalentConicity conicity = conicity_of_wave(curve, amplitude);
  if (conicity.status != ConicityStatus::found) return {};
  return conicity.tan_gamma;
}

}  // namespace

std::optional<double> ContactGeometry::equivalent_conicity(double amplitude) const {
  const std::lock_guard lock(last_conicity_->mutex);
  if (last_conicity_->amplitude != amplitude) {
    last_conicity_->value = conicity_at(*this, amplitude);
    last_conicity_->amplitude = amplitude;
  }
  return last_conicity_->value;
}

}  // namespace railtab
