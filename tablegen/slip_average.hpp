#pragma once

#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/tablegen/rolling_contact_grid.hpp"
#include "railtab/tablegen/rolling_contact_product.hpp"

namespace railtab {

/// What the force changes by when the traction of a slipping element is the mean over the element of the bound against
/// the slip, instead of the bound against the slip at one place of it.
///
/// Where the slip turns a lot from one element to the next, around the point of zero slip in sliding spin, one place is
/// a poor sample: on wide ellipses the force of 40 x 40 elements then wavers by 0.01 and its extrapolation by 0.03
/// μF_n. The slip is taken as linear over the element, with differences to the slipping neighbours as its gradient.
/// @param traction of all elements; @param slip per step of one element, elastic and rigid
/// @param rigid_gradient φ dx: of the rigid slip per step, where an element has no slipping neighbour
[[nodiscard]] CreepForce slip_average_correction(const RollingContactGrid& grid, const ElementField& traction,
                                                 const ElementField& slip, double rigid_gradient);

}  // namespace railtab
