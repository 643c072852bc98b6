#pragma once

#include <boost/program_options.hpp>
#include <optional>
#include <string>
#include <vector>

#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/tablegen/conicity_bands.hpp"
#include "railtab/tablegen/conicity_errors.hpp"
#include "table_command_line.hpp"

namespace railtab {

/// What `tablegen conicity` was asked for, read and checked.
struct ConicityRequest {
  std::string name;                   ///< of the table, or of the profiles
  std::optional<TableContact> table;  ///< or a pair
  std::optional<WheelsetPair> pair;
  WheelsetContactOptions contact;
  double amplitude = 0.0;                      ///< [m]
  std::vector<double> amplitudes;              ///< of the curve [m]; empty: those that the samples allow
  std::string output;                          ///< CSV file; may be empty
  std::vector<ConicityBand> reference;         ///< may be empty
  std::optional<ConicityErrorOptions> errors;  ///< for the pair without smoothing:
  std::optional<WheelsetPair> exact;
};

/// First column names of the CSV.
inline constexpr const char* conicity_csv_mark = "amplitude,wave,regression";

/// The options of `tablegen conicity`.
[[nodiscard]] boost::program_options::options_description conicity_options();

/// @throws InputError
[[nodiscard]] ConicityRequest conicity_request(const TableCommandLine& line);

}  // namespace railtab
