#pragma once

#include <cstdint>

#include "railtab/runtime/contact/hertz.hpp"
#include "railtab/tablegen/table_verification.hpp"
#include "railtab/tables/loaded_table.hpp"

namespace railtab {

/// Random poses, uniform over the table's ranges less its margin and over the lowering.
struct LoadedVerificationOptions {
  int samples = 500;  ///< 1..10^7
  std::uint64_t seed = 20261122;
  Interval approach{5e-6, 150e-6};  ///< lowering below first touch along the contact's normal, >= 0 [m]
  int elements = 40;                ///< across the narrowest part of a contact, 4..1000
  ElasticMaterial material;         ///< of wheel and rail

  /// @throws InputError
  void validate() const;
};

/// A loaded table held against half-space solutions. Errors of the force on the rail are those of its vector in the
/// track's cross section, over the normal force; those of stiffness are of ∂F_z/∂z against a difference of solutions.
struct LoadedVerification {
  int samples = 0;
  int answered = 0;             ///< by the table alone
  ErrorStatistics force;        ///< above 5 kN [-]
  ErrorStatistics light_force;  ///< from 1 to 5 kN [-]
  ErrorStatistics stiffness;    ///< above 5 kN [-]
  ErrorStatistics pressure;     ///< largest pressure, above 5 kN [-]
  int above_5_kn = 0, from_1_to_5_kn = 0;
  double time_ns = 0.0;  ///< per look-up [ns]

  [[nodiscard]] std::array<std::pair<std::string_view, const ErrorStatistics*>, 4> errors() const {
    return {{{"force", &force}, {"light_force", &light_force}, {"stiffness", &stiffness}, {"pressure", &pressure}}};
  }
};

/// @throws InputError for options out of range
[[nodiscard]] LoadedVerification verify_loaded_table(const ContactSearch& search, const LoadedTable& table,
                                                     const LoadedVerificationOptions& options,
                                                     const Progress& progress = {});

}  // namespace railtab
