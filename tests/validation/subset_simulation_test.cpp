// Repetitions of subset simulation on limit states of known probability, 1e-3 to 1e-5.
#include <gtest/gtest.h>

#include "subset_limit_states.hpp"

namespace railtab {
namespace {

class KnownProbability : public ::testing::TestWithParam<KnownLimitState> {};

// What docs/validation/many_runs.md promises, and that the method's own estimate of the coefficient of variation can be
// relied on.
TEST_P(KnownProbability, IsFoundInFiveThousandEvaluations) {
  const int repetitions = GetParam().variables > 10 ? 50 : 300;  // more take too long
  const SubsetRepetitions r = repeat_subset(GetParam(), repetitions);
  EXPECT_LE(r.most_evaluations, 5000U);
  EXPECT_LT(r.variation, 0.3);
  EXPECT_LT(std::abs(r.bias), 0.10);
  EXPECT_LT(std::abs(r.bias), 4.0 * r.variation / std::sqrt(repetitions));  // of the mean's standard errors
  EXPECT_NEAR(r.own_variation, r.variation, 0.3 * r.variation);
}

INSTANTIATE_TEST_SUITE_P(LimitStates, KnownProbability, ::testing::ValuesIn(known_limit_states()),
                         [](const auto& instance) {
                           std::string name = instance.param.name + "_" + std::to_string(instance.param.variables) +
                                              "_1em" +
                                              std::to_string(static_cast<int>(-std::log10(instance.param.exact) + 0.5));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace railtab
