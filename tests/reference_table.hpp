#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace railtab::testing {

/// Columns of a committed reference CSV by name; lines that begin with '#' tell the origin and are skipped.
/// Fields that are not numbers are rejected: a reference file has numbers only.
inline std::map<std::string, std::vector<double>> read_reference(const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(RAILTAB_REFERENCE_DIR) / name;
  std::ifstream in(file);
  if (!in) throw std::runtime_error("missing reference file " + file.string());
  std::vector<std::string> columns;
  std::map<std::string, std::vector<double>> table;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    std::string field;
    if (columns.empty()) {
      while (std::getline(fields, field, ',')) columns.push_back(field);
      continue;
    }
    for (std::size_t i = 0; std::getline(fields, field, ','); ++i) table[columns.at(i)].push_back(std::stod(field));
  }
  return table;
}

}  // namespace railtab::testing
