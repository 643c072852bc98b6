#include "railtab/runtime/reliability/sampling.hpp"

#include <algorithm>
#include <numeric>

#include "railtab/runtime/reliability/counter_random.hpp"

namespace railtab {
namespace {

constexpr std::uint32_t points_stream = 1, order_stream = 2;

/// 0 … count − 1 in the order of random numbers.
std::vector<std::size_t> random_order(std::size_t count, std::uint32_t variable, std::uint64_t seed) {
  std::vector<double> key(count);
  for (std::size_t i = 0; i < count; ++i) key[i] = uniform_random(seed, {i, variable, order_stream});
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key[a] < key[b]; });
  return order;
}

}  // namespace

UnitPoints monte_carlo_points(std::size_t count, std::size_t variables, std::uint64_t seed) {
  UnitPoints points(count, std::vector<double>(variables));
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < variables; ++j) {
      points[i][j] = uniform_random(seed, {i, static_cast<std::uint32_t>(j), points_stream});
    }
  }
  return points;
}

UnitPoints latin_hypercube_points(std::size_t count, std::size_t variables, std::uint64_t seed) {
  UnitPoints points = monte_carlo_points(count, variables, seed);
  for (std::size_t j = 0; j < variables; ++j) {
    const std::vector<std::size_t> interval = random_order(count, static_cast<std::uint32_t>(j), seed);
    for (std::size_t i = 0; i < count; ++i) {
      points[i][j] = (static_cast<double>(interval[i]) + points[i][j]) / static_cast<double>(count);
    }
  }
  return points;
}

}  // namespace railtab
