#pragma once

namespace railtab {

/// Displacement difference at the centre of one rectangular element by a unit tangential traction on another, for two
/// half-spaces of the same material with G = 1. Symmetric: xy couples both ways.
struct InfluenceNumber {
  double xx, xy, yy;
};

/// Boussinesq-Cerruti, integrated in closed form over an element dx·dy [Kalker1990, App. C]: with r the distance,
///   A_xx = ∫∫ [(1−ν)/r + ν x²/r³]/π,  A_yy likewise with y²,  A_xy = ∫∫ ν xy/(π r³).
/// @param x, y from the loaded element's centre to the observed one's. No element's corner may lie on the axes through
/// the observed centre: true on a grid, where offsets are whole elements.
/// @param dx, dy > 0 sizes of the element; @param nu Poisson's ratio
[[nodiscard]] InfluenceNumber influence_number(double x, double y, double dx, double dy, double nu) noexcept;

}  // namespace railtab
