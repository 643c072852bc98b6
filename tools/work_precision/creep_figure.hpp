#pragma once

#include <filesystem>
#include <vector>

#include "work_point.hpp"

namespace railtab::work_precision {

/// Creep force against exact rolling contact at random cases: the creep tables given, FASTSIM, Polach, linear theory.
/// @throws InputError where a table cannot be read
[[nodiscard]] WorkFigure creep_figure(const std::vector<std::filesystem::path>& tables, bool quick);

}  // namespace railtab::work_precision
