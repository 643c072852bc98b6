#include "railtab/runtime/vehicle/toml_kind.hpp"

#include <algorithm>
#include <initializer_list>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

TomlKind toml_kind(const toml::table& table) {
  const auto any_of = [&](std::initializer_list<std::string_view> keys) {
    return std::any_of(keys.begin(), keys.end(), [&](std::string_view key) { return table.contains(key); });
  };
  if (any_of({"vary"})) return TomlKind::study_plan;
  if (any_of({"clause"})) return TomlKind::clauses;
  if (any_of({"pair"})) return TomlKind::pair_list;
  if (any_of({"train", "contact", "track", "bridge", "structure", "integration", "irregularity"})) {
    return TomlKind::scene;
  }
  if (any_of({"body", "car_body", "bogie", "wheelset", "template", "connection"})) return TomlKind::vehicle;
  return TomlKind::unknown;
}

std::string_view kind_name(TomlKind kind) noexcept {
  switch (kind) {
    case TomlKind::scene:
      return "a scene";
    case TomlKind::study_plan:
      return "a plan of a study";
    case TomlKind::vehicle:
      return "a vehicle";
    case TomlKind::clauses:
      return "clauses of a standard";
    case TomlKind::pair_list:
      return "a list of wheel and rail pairs";
    case TomlKind::unknown:
      break;
  }
  return "TOML of no kind that railtab knows";
}

void check_toml_kind(const toml::table& table, const std::filesystem::path& file, TomlKind expected) {
  const TomlKind found = toml_kind(table);
  if (found == expected || found == TomlKind::unknown) return;
  throw input_error(file.string(), kind_name(found), kind_name(expected));
}

}  // namespace railtab
