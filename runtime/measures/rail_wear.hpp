#pragma once

#include <optional>
#include <vector>

namespace railtab {

/// Energy that the wheels of a train leave in each metre of one rail, from their wear numbers T·γ [J/m] along the way.
/// Memory grows with the way alone.
class RailWear {
 public:
  /// A wheel goes from one position to another [m], with T·γ as a line between the two values [J/m].
  /// @pre to >= from, both within ±1e6 m
  void add(double from, double value_from, double to, double value_to);

  struct Metre {
    double begin;   ///< whole metres [m]
    double energy;  ///< of all wheels [J]
  };
  /// The metre with the largest energy; none before a wheel has gone anywhere.
  [[nodiscard]] std::optional<Metre> largest() const;

 private:
  [[nodiscard]] double& energy_at(long metre);

  long first_ = 0;              ///< metre of the first entry
  std::vector<double> energy_;  ///< [J]
};

}  // namespace railtab
