#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string_view>

namespace railtab {

/// What the keys of a TOML file show it to be.
enum class TomlKind { unknown, scene, study_plan, vehicle, clauses, pair_list };
[[nodiscard]] TomlKind toml_kind(const toml::table& table);        ///< vehicle: also a joint of vehicles
[[nodiscard]] std::string_view kind_name(TomlKind kind) noexcept;  ///< "a scene"

/// @throws InputError naming the file where it is seen to be of another kind than `expected`
void check_toml_kind(const toml::table& table, const std::filesystem::path& file, TomlKind expected);

}  // namespace railtab
