#pragma once

// What studies share that compare with CONTACT's loaded cases (contact_loaded/, README.md there).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace railtab::contact_reference {

constexpr double friction = 0.3, shear_modulus = 82e9, poisson = 0.28;

/// A row of a reference CSV by column; numbers as they are written.
class Row {
 public:
  explicit Row(std::map<std::string, std::string> fields) : fields_(std::move(fields)) {}
  [[nodiscard]] const std::string& text(const std::string& column) const { return fields_.at(column); }
  [[nodiscard]] double operator[](const std::string& column) const { return std::stod(fields_.at(column)); }

 private:
  std::map<std::string, std::string> fields_;
};

inline std::vector<Row> read_rows(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  std::vector<std::string> columns;
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    std::vector<std::string> values;
    for (std::string field; std::getline(fields, field, ',');) values.push_back(field);
    if (columns.empty()) {
      columns = values;
      continue;
    }
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < columns.size(); ++i) row[columns[i]] = values.at(i);
    rows.emplace_back(std::move(row));
  }
  return rows;
}

/// Absolute values of a difference over the cases of a class.
class Differences {
 public:
  void add(const std::string& set, const std::string& kind, const std::string& quantity, double value) {
    if (std::isfinite(value)) values_[{set, kind, quantity}].push_back(std::abs(value));
  }
  [[nodiscard]] std::string csv() const {
    std::string text;
    for (auto [key, values] : values_) {
      std::sort(values.begin(), values.end());
      double sum = 0.0;
      for (const double v : values) sum += v;
      const std::size_t p95 = std::min(values.size() - 1, values.size() * 95 / 100);
      text += fmt::format("{},{},{},{},{:.4g},{:.4g},{:.4g}\n", key[0], key[1], key[2], values.size(),
                          sum / static_cast<double>(values.size()), values[p95], values.back());
    }
    return text;
  }

 private:
  std::map<std::array<std::string, 3>, std::vector<double>> values_;
};

inline std::string kind_of(double angle, double bands) {
  if (bands > 1.5) return "several bands";
  if (std::abs(angle) <= 0.13) return "tread";
  return std::abs(angle) <= 0.5 ? "root" : "flange";
}

}  // namespace railtab::contact_reference
