#pragma once

#include <string>
#include <vector>

#include "stability_case.hpp"

namespace railtab::stability {

struct Row {
  StabilityCase one;
  CaseResult result;
};

[[nodiscard]] std::string text_line(const Row& row);
/// stability.csv, from which docs/validation/stability.md takes its tables.
[[nodiscard]] std::string csv_text(const std::vector<Row>& rows);

}  // namespace railtab::stability
