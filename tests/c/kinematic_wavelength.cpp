// The wavelength of the kinematic motion of a free wheelset, y'' = −Δr(y)/(e r0), from the table alone, without forces:
// kinematic_wavelength TABLE.h5 AMPLITUDE_IN_M
// prints λ = 2π √(e r0/(2 tan γe)), the formula of Klingel with the equivalent conicity of EN 15302, for the distance e
// of the contact points and the rolling radius r0 in the centred position. The wheelset rolls as both wheels touch.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "railtab/runtime/contact/equivalent_conicity.hpp"
#include "railtab/runtime/contact_files/contact_table_file.hpp"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const railtab::ContactTable table = railtab::read_contact_table(argv[1]);
  const railtab::WheelRailPair& pair = table.geometry.pair();
  railtab::WheelsetContactOptions options;
  options.roll = railtab::WheelsetRoll::free;
  const std::vector<railtab::WheelsetContact> contacts = railtab::wheelset_contacts(
      [&](const railtab::WheelsetPose& pose, double near_miss) { return table.patches.patches(pose, near_miss); }, pair,
      options);
  const railtab::WheelsetContact& centred =
      *std::min_element(contacts.begin(), contacts.end(),
                        [](const auto& one, const auto& other) { return std::abs(one.y) < std::abs(other.y); });
  const double e = 2.0 * (pair.rail_offset() + centred.right.y_rail), r0 = centred.right.rolling_radius;
  std::vector<double> shift, radius_difference;
  for (const railtab::WheelsetContact& contact : contacts) {
    shift.push_back(contact.y - r0 * contact.roll);
    radius_difference.push_back(contact.radius_difference);
  }
  const auto found = railtab::conicity_of_wave({shift, radius_difference}, std::atof(argv[2]));
  if (found.status != railtab::ConicityStatus::found) return 1;
  std::fputs(fmt::format("{}\n", 2.0 * std::numbers::pi * std::sqrt(e * r0 / (2.0 * found.tan_gamma))).c_str(), stdout);
}
