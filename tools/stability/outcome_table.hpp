#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stability_case.hpp"

namespace railtab::stability {

struct Row {
  StabilityCase one;
  CaseResult result;
};

[[nodiscard]] std::string text_line(const Row& row);
[[nodiscard]] std::string csv_text(const std::vector<Row>& rows);
/// Puts the table between the lines "<!-- outcomes -->" and "<!-- end -->" of a page. @throws InputError where they are
/// missing.
void fill_page(const std::filesystem::path& page, const std::vector<Row>& rows);

}  // namespace railtab::stability
