#include "railtab/runtime/base/interval_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace railtab {
namespace {

std::vector<double> nodes_with(int count, auto&& step) {
  std::vector<double> nodes{-3.0};
  for (int i = 1; i < count; ++i) nodes.push_back(nodes.back() + step(i));
  return nodes;
}

TEST(IntervalSearch, HoldsThePlaceHoweverTheNodesAreSpaced) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const std::vector<std::vector<double>> spaced{
      nodes_with(2, [](int) { return 2.0; }),
      nodes_with(400, [](int) { return 0.6; }),
      nodes_with(400, [](int i) { return i % 53 == 0 ? 0.2 : 0.6; }),
      nodes_with(60, [](int i) { return std::exp(0.3 * i); }),
      nodes_with(60, [](int i) { return std::exp(-0.3 * i); }),
      nodes_with(300, [&](int) { return 1e-6 + std::pow(share(random), 8.0); }),
      nodes_with(90, [](int i) { return i == 45 ? 1e6 : 1e-3; }),
  };
  for (const std::vector<double>& nodes : spaced) {
    std::vector<double> places = nodes;
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      places.push_back(nodes[i - 1] + share(random) * (nodes[i] - nodes[i - 1]));
      places.push_back(std::nextafter(nodes[i], nodes[i - 1]));
    }
    for (const double x : places) {
      const std::size_t i = interval_at(nodes, x);
      ASSERT_LT(i + 1, nodes.size()) << x;
      EXPECT_LE(nodes[i], x);
      EXPECT_LE(x, nodes[i + 1]);
    }
  }
}

}  // namespace
}  // namespace railtab
