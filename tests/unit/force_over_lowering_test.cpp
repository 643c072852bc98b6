// The work of a contact force over the lowering, against closed forms.
#include "railtab/tablegen/force_over_lowering.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace railtab {
namespace {

constexpr double stiffness = 8e10, second_begins = 43e-6;

/// A Hertzian contact, and a second one that begins later.
double force_of(double d) {
  return stiffness * (std::pow(d, 1.5) + 0.5 * std::pow(std::max(d - second_begins, 0.0), 1.5));
}
double work_of(double d) {
  return 0.4 * stiffness * (std::pow(d, 2.5) + 0.5 * std::pow(std::max(d - second_begins, 0.0), 2.5));
}

ForceOverLowering through_solutions(int count) {
  std::vector<double> lowering, force;
  for (int i = 0; i < count; ++i) {
    lowering.push_back(150e-6 * std::pow(i / (count - 1.0), 2));
    force.push_back(force_of(lowering.back()));
  }
  return {lowering, force};
}

TEST(ForceOverLowering, HasTheWorkOfTheForce) {
  const ForceOverLowering over = through_solutions(33);
  for (std::size_t i = 1; i < 33; ++i) {
    const double d = 150e-6 * std::pow(static_cast<double>(i) / 32.0, 2);
    EXPECT_NEAR(over.work(i) / work_of(d), 1.0, 2e-4) << i;
  }
  for (double d = 3e-6; d < 150e-6; d += 1.7e-6) {
    EXPECT_NEAR(over.force(d) / force_of(d), 1.0, 2e-3) << d;
    EXPECT_NEAR(over.lowering_at(work_of(d)) / d, 1.0, 2e-4) << d;
  }
}

TEST(ForceOverLowering, LoweringIsTheInverseOfTheWork) {
  const ForceOverLowering over = through_solutions(12);
  for (std::size_t i = 1; i < 12; ++i) {
    const double d = 150e-6 * std::pow(static_cast<double>(i) / 11.0, 2);
    EXPECT_NEAR(over.lowering_at(over.work(i)) / d, 1.0, 1e-9);
    // the force is the derivative of the work
    const double step = 1e-4 * over.work(i);
    const double rise = over.lowering_at(over.work(i) + step) - over.lowering_at(over.work(i) - step);
    EXPECT_NEAR(2.0 * step / rise / over.force(d), 1.0, 1e-4);
  }
}

}  // namespace
}  // namespace railtab
