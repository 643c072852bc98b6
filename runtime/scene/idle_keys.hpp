#pragma once

#include <filesystem>
#include <vector>

#include "railtab/runtime/scene/key_table.hpp"
#include "railtab/runtime/scene/toml_leaves.hpp"

namespace railtab::scene {

/// A key that would be read and not used is a misunderstanding: it is refused, with what stands against it or is
/// missing. @throws InputError with file and line
void refuse_idle_keys(const SceneDraft& draft, const std::filesystem::path& file, const std::vector<Leaf>& leaves);

}  // namespace railtab::scene
