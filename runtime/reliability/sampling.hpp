#pragma once

#include <cstdint>
#include <vector>

namespace railtab {

/// Points in the open unit cube, one row per sample, one column per variable: F of each variable's value.
using UnitPoints = std::vector<std::vector<double>>;

/// Independent points; those of a smaller count are the first of a larger one.
[[nodiscard]] UnitPoints monte_carlo_points(std::size_t count, std::size_t variables, std::uint64_t seed);

/// Latin hypercube [McKayBeckmanConover1979]: of each variable one value in each of `count` intervals of equal
/// probability, at a random place in it, paired at random.
[[nodiscard]] UnitPoints latin_hypercube_points(std::size_t count, std::size_t variables, std::uint64_t seed);

}  // namespace railtab
