#include "railtab/runtime/contact/table_creep.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "railtab/runtime/base/smooth_step.hpp"
#include "railtab/runtime/contact/polach.hpp"

namespace railtab {

namespace {

constexpr double ratio_border = 1.25;    ///< factor of a/b over which the table fades out at the ends of its axis
constexpr double creepage_border = 0.8;  ///< share of the largest creepage at which it begins to fade out

}  // namespace

double TableCreep::share(double ratio, const Creepage& creepage) const noexcept {
  const CreepTableData& data = table->data();
  if (data.layout == CreepTableLayout::smooth && ratio >= ratio_border * data.nodes[0].front() &&
      ratio_border * ratio <= data.nodes[0].back()) {
    return 1.0;
  }
  const double factor = std::min(ratio / data.nodes[0].front(), data.nodes[0].back() / ratio);
  double share = smooth_step((factor - 1.0) / (ratio_border - 1.0));
  if (data.layout == CreepTableLayout::smooth) return share;
  const double used =
      std::max({std::abs(creepage.x) / data.nodes[1].back(), std::abs(creepage.y) / data.nodes[2].back(),
                std::abs(creepage.spin) / data.nodes[3].back()});
  return share * smooth_step((1.0 - used) / (1.0 - creepage_border));
}

CreepForce table_creep(const TableCreep& law, double ratio, const Creepage& creepage) noexcept {
  const double share = law.share(ratio, creepage);
  CreepForce force;
  if (share > 0.0) {
    const std::array<double, 3> found = law.table->force(ratio, {creepage.x, creepage.y, creepage.spin});
    force = {found[0], found[1], found[2]};
  }
  if (share == 1.0) return force;
  const CreepForce polach = polach_creep({.nu = law.table->data().poisson}, ratio, creepage);
  return {share * force.x + (1.0 - share) * polach.x, share * force.y + (1.0 - share) * polach.y,
          share * force.moment + (1.0 - share) * polach.moment};
}

}  // namespace railtab
