#include "railtab/runtime/drawing/grid.hpp"

namespace railtab::drawing {

void Grid::add_cell(Cell kind, std::span<const std::int64_t> corners) {
  connectivity.insert(connectivity.end(), corners.begin(), corners.end());
  offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  types.push_back(static_cast<std::uint8_t>(kind));
}

}  // namespace railtab::drawing
