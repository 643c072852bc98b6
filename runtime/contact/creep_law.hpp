#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <variant>

#include "railtab/tables/creep_table.hpp"

namespace railtab {

/// Kalker's creepage coefficients of linear theory for one ellipse.
struct KalkerCoefficients {
  double c11, c22, c23, c33;
};

/// Kalker's table [Kalker1990, Table E.3] (misprints corrected) interpolated smoothly in the ellipse ratio and in
/// Poisson's ratio; blended into the asymptotes outside a/b = 0.1..10. Continuous with continuous slope.
/// @param ratio a/b > 0; @param nu 0..0.5
[[nodiscard]] KalkerCoefficients kalker_coefficients(double ratio, double nu) noexcept;

/// Normalised creepages (G = 1, mu·F_n = 1, sqrt(ab) = 1): x = υx·G·ab/(μF_n), y likewise, spin =
/// φ·G·(ab)^{3/2}/(μF_n).
struct Creepage {
  double x = 0.0, y = 0.0, spin = 0.0;
};

/// Normalised creep force on the wheel: F_x/(μF_n), F_y/(μF_n), M_z/(μF_n·√(ab)). Positive υx gives negative F_x;
/// the sign of spin follows the right-hand rule about the contact normal into the rail.
struct CreepForce {
  double x = 0.0, y = 0.0, moment = 0.0;
};

/// Kalker's linear theory; with `saturated`, scaled to the friction bound by Vermeulen-Johnson's cubic.
struct LinearCreep {
  double nu = 0.28;
  bool saturated = false;
  /// In place of Kalker's table, for every ellipse; c23 = c33 = 0 leaves spin out.
  std::optional<KalkerCoefficients> coefficients{};
};

/// Polach [Polach1999]: the method has no moment; that of linear theory, saturated, is returned.
struct PolachCreep {
  double nu = 0.28;
  double k_adhesion = 1.0;  ///< k_A, 0 < k_S <= k_A <= 1
  double k_slip = 1.0;      ///< k_S
};

/// FASTSIM [Kalker1982], elliptic or parabolic traction bound; the three flexibilities of linear theory throughout, or
/// blended into one at large creepage (Vollebregt & Voltr 2023), where tractions must point along the slip.
struct FastsimCreep {
  double nu = 0.28;
  int strips = 20;    ///< across the rolling direction, 2..200
  int elements = 20;  ///< along each strip, 2..200
  enum class Bound { elliptic, parabolic } bound = Bound::parabolic;
  enum class Flexibility { three, blended } flexibility = Flexibility::blended;
};

/// Exact rolling contact from a creep table; Polach outside it, blended in over the table's outermost part so that the
/// force is continuous. One table may serve any number of laws and threads.
struct TableCreep {
  std::shared_ptr<const CreepTable> table;  ///< never null

  /// Share of the table in the force: 1 inside, 0 outside, between the two next to the border (a/b within a factor
  /// 1.25 of it; in the paper's layout also creepages within a fifth of it).
  [[nodiscard]] double share(double ratio, const Creepage& creepage) const noexcept;
};

using CreepLaw = std::variant<LinearCreep, PolachCreep, FastsimCreep, TableCreep>;

/// Normalised creep force on the wheel for an ellipse of ratio a/b. Finite for every finite input.
[[nodiscard]] CreepForce creep_force(const CreepLaw& law, double ratio, const Creepage& creepage) noexcept;

/// Creep force with its derivatives.
struct CreepForceJet {
  CreepForce force;
  /// [i][j]: of F_x, F_y, M_z with respect to a/b, υx, υy, φ.
  std::array<std::array<double, 4>, 3> derivative{};
};

/// creep_force() and its derivatives: from the table's own where the creep table answers, else by differences.
[[nodiscard]] CreepForceJet creep_force_jet(const CreepLaw& law, double ratio, const Creepage& creepage) noexcept;

[[nodiscard]] std::string_view creep_law_name(const CreepLaw& law) noexcept;

}  // namespace railtab
