#pragma once

#include "work_point.hpp"

namespace railtab::work_precision {

/// Contact geometry of S1002 on 60E1 1:40, y ±12 mm, yaw ±30 mrad, no roll, 0..0.3 mm below first touch: tables of
/// several sizes of cells, by the error of their starts, with the pair polished on the profiles and without
/// (polynomials alone), the online search, the published search with discretised profiles.
[[nodiscard]] WorkFigure geometry_figure(bool quick);

}  // namespace railtab::work_precision
