#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace railtab::report {

/// How finely a page stores a history.
struct Detail {
  /// Up to so many values it is stored whole; of a longer one, the smallest and the largest of every so many records
  /// that no more are left.
  std::size_t most_values = 2000;
};

/// Histories that the charts of a page draw, each stored once and with 16 bits a value: 65 534 steps from its smallest
/// to its largest value. The page's script reads them (assets/charts.js).
class HistoryStore {
 public:
  /// @param time, position one value per record, not decreasing [s], [m]; stored with 32 bits
  /// @return number of the run
  std::size_t add_run(std::string_view name, std::span<const double> time, std::span<const double> position);
  /// @param values one per record of the run; NaN is a gap
  /// @return number of the history
  std::size_t add(std::span<const double> values, Detail detail);

  /// Records of which one pair of values is left, of the history that was thinned most; 1: all are stored whole.
  [[nodiscard]] std::size_t coarsest() const noexcept { return coarsest_; }
  [[nodiscard]] bool empty() const noexcept { return histories_.empty(); }
  /// {"runs": [...], "histories": [...]} as text for a script element. Empty where nothing is stored.
  [[nodiscard]] std::string json() const;

 private:
  std::vector<std::string> runs_, histories_;  // JSON objects
  std::size_t coarsest_ = 1;
};

/// Values as 16-bit numbers in base64, with {"low": ..., "step": ...} of value = low + step·number; 65535 is a gap.
/// Little-endian. @return a JSON object
[[nodiscard]] std::string quantised_json(std::span<const double> values);
/// Values as 32-bit floating-point numbers in base64, little-endian.
[[nodiscard]] std::string float_base64(std::span<const double> values);
[[nodiscard]] std::string base64(std::span<const unsigned char> bytes);

/// A text as a JSON string that may stand in a script element of a page.
[[nodiscard]] std::string json_string(std::string_view text);

}  // namespace railtab::report
