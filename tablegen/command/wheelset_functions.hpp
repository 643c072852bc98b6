#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "railtab/runtime/contact/equivalent_conicity.hpp"
#include "railtab/runtime/contact/table_contact.hpp"

namespace railtab {

/// A wheelset without yaw on straight track: contact of both wheels over the lateral shift.
struct WheelsetFunctions {
  WheelsetRoll roll;
  double diameter_difference;  ///< right minus left [m]
  std::vector<WheelsetContact> contacts;
  RadiusDifferenceCurve radius_difference;
};

/// Nothing where the centred wheelset does not touch both rails.
[[nodiscard]] std::optional<WheelsetFunctions> wheelset_functions(std::vector<WheelsetContact> contacts,
                                                                  const WheelsetContactOptions& options);

/// Over the table's lateral range, not the one of the options; nothing where that does not contain 0, or the centred
/// wheelset does not touch both rails.
[[nodiscard]] std::optional<WheelsetFunctions> wheelset_functions(const TableContact& table,
                                                                  WheelsetContactOptions options = {});

/// Amplitudes of a conicity curve [m]: 0.5 to 10 mm, every 0.5 mm, as far as the wave fits into the samples.
[[nodiscard]] std::vector<double> conicity_amplitudes(const RadiusDifferenceCurve& curve);

/// The sample nearest to a lateral shift.
[[nodiscard]] const WheelsetContact& nearest_contact(const WheelsetFunctions& functions, double y);

/// A number, or null where it is not finite.
[[nodiscard]] nlohmann::ordered_json number_or_null(double value);

/// "found", or why there is no conicity.
[[nodiscard]] const char* status_word(ConicityStatus status);

/// "0.1234", or why there is none.
[[nodiscard]] std::string conicity_text(const EquivalentConicity& conicity);

/// tan γe or null, ends of the wave, status in words.
[[nodiscard]] nlohmann::ordered_json conicity_json(const EquivalentConicity& conicity);

/// Rolling radius difference and conicities over amplitude, as `info` and `conicity` print them in JSON.
[[nodiscard]] nlohmann::ordered_json functions_json(const WheelsetFunctions& functions,
                                                    const std::vector<double>& amplitudes);

/// The same as tables of text, one row per millimetre of shift and per amplitude.
[[nodiscard]] std::string functions_text(const WheelsetFunctions& functions, const std::vector<double>& amplitudes);

}  // namespace railtab
