#pragma once

#include <toml++/toml.h>

#include <array>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/vehicle/provenance.hpp"

namespace railtab {

/// @throws InputError with the file and line of what is no TOML, or exceeds TomlBounds
[[nodiscard]] toml::table parse_toml(const std::string& text, const std::filesystem::path& place);
/// The same of a file. @param what  the file is, for messages ("a plan in TOML")
/// @throws InputError as parse_toml(), and where there is no such file
[[nodiscard]] toml::table read_toml(const std::filesystem::path& file, std::string_view what);

/// What a message shows of a value.
[[nodiscard]] std::string found_text(const toml::node& node);
/// The same where an integer is expected: 1.0 is none, and says so.
[[nodiscard]] std::string found_not_integer(const toml::node& node);

/// What a key accepts.
struct NumberKind {
  std::string_view unit;
  double low, high;
};

/// A table of a vehicle file, read key by key. Its own source, date, standing and note hold for all of its numbers; a
/// number may be written as { value = 1.2e6, standing = "suspect", note = "…" }, which has what it names for itself.
/// Functions throw InputError with file, line and key, what was found and what is allowed.
class TomlSection {
 public:
  /// @param values receives every number that is read, and this section
  TomlSection(const std::filesystem::path& file, std::string path, const toml::table& table, Provenance outer,
              SourcedValues& values);

  [[nodiscard]] bool has(std::string_view key);
  [[nodiscard]] double number(std::string_view key, const NumberKind& kind);
  [[nodiscard]] double number(std::string_view key, const NumberKind& kind, double absent);
  /// A list, or one number.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, const NumberKind& kind);
  /// [[1, 2], [3, 4]]: the points of a line, the first of both rising.
  [[nodiscard]] std::vector<std::array<double, 2>> points(std::string_view key, std::string_view units);
  /// [low, high]
  [[nodiscard]] std::array<double, 2> interval(std::string_view key, const NumberKind& kind);
  [[nodiscard]] int whole_number(std::string_view key, int low, int high, int absent);
  [[nodiscard]] bool flag(std::string_view key);
  [[nodiscard]] std::string text(std::string_view key);
  [[nodiscard]] std::string text_of(std::string_view key, const std::vector<std::string>& allowed);
  /// [["a", "b"], ["c", "d"]]
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> pairs(std::string_view key);
  /// A table below this one. @throws InputError where there is none
  [[nodiscard]] TomlSection section(std::string_view key);
  [[nodiscard]] std::optional<TomlSection> find_section(std::string_view key);
  /// [[key]]; none: no entries
  [[nodiscard]] std::vector<TomlSection> sections(std::string_view key);

  /// Keys that another value makes idle, which reject_others() names then. @param cause that value: motion = "vertical"
  void without_effect(std::initializer_list<std::string_view> keys, std::string_view cause);
  /// To be called last. @throws InputError where the table has a key that was not asked for
  void reject_others() const;
  [[nodiscard]] InputError error(std::string_view key, std::string_view found, std::string_view expected) const;
  [[nodiscard]] const Provenance& provenance() const noexcept { return provenance_; }
  /// "file:line: path"
  [[nodiscard]] std::string place() const;

 private:
  [[nodiscard]] const toml::node* find(std::string_view key);
  [[nodiscard]] const toml::node& require(std::string_view key, std::string_view expected);
  [[nodiscard]] std::string key_path(std::string_view key) const;
  void read_provenance(const toml::table& table, std::string_view key, Provenance& provenance) const;
  [[nodiscard]] double checked(std::string_view key, const toml::node& node, const NumberKind& kind) const;

  const std::filesystem::path* file_;
  std::string path_;
  const toml::table* table_;
  Provenance provenance_;
  SourcedValues* values_;
  std::vector<std::string> known_;
  std::map<std::string, std::string, std::less<>> idle_;  // keys without effect, and why
};

}  // namespace railtab
