#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace railtab::testing {

/// A measured number that pages quote, in the unit in which they do. `tools/regenerate numbers` collects these and
/// writes them where a page has `1.23<!--name %.2f-->`.
inline void measured(const std::string& name, double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  ::testing::Test::RecordProperty("measured." + name, text);
}

}  // namespace railtab::testing
