#pragma once

#include <filesystem>
#include <vector>

#include "work_point.hpp"

namespace railtab::work_precision {

/// Tables of the scenes; without one its points are left out.
struct SceneTables {
  std::filesystem::path geometry;     ///< of S1002 on 60E1 1:40
  std::filesystem::path paper_creep;  ///< creep table in the published layout
};

/// A whole scene, a coach led by its flanges over a bridge: contact (table, online, published) and creep law, and
/// smaller steps, against the online search with the exact creep table in steps of a 16th, by wheel forces, car-body
/// and deck acceleration. One figure each.
[[nodiscard]] std::vector<WorkFigure> scene_figures(const SceneTables& tables, bool quick);

}  // namespace railtab::work_precision
