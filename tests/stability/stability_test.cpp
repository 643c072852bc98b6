// The reduced matrix of stiff and extreme cases; bin/stability runs the whole one (docs/validation/stability.md).

#include "stability_case.hpp"

#include <gtest/gtest.h>

#include <map>

namespace railtab::stability {
namespace {

std::map<std::string, std::vector<StabilityCase>> quick_cases() {
  std::map<std::string, std::vector<StabilityCase>> groups;
  for (StabilityCase& one : all_cases()) {
    if (one.quick) groups[one.group].push_back(std::move(one));
  }
  return groups;
}

class Stability : public ::testing::TestWithParam<std::string> {};

TEST_P(Stability, EveryCaseEndsAsItShould) {
  const auto groups = quick_cases();
  for (const StabilityCase& one : groups.at(GetParam())) {
    const CaseResult result = outcome_of(one);
    EXPECT_TRUE(as_expected(one, result))
        << outcome_name(result.outcome) << " instead of " << outcome_name(one.expected) << ": " << one.setting << ": "
        << one.measure << ' ' << result.error << ", stated " << one.allowed << "; " << result.note;
  }
}

std::vector<std::string> groups() {
  std::vector<std::string> names;
  for (const auto& [name, cases] : quick_cases()) names.push_back(name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Matrix, Stability, ::testing::ValuesIn(groups()), [](const auto& instance) {
  std::string name = instance.param;
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return name;
});

}  // namespace
}  // namespace railtab::stability
