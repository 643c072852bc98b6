#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "conicity_request.hpp"
#include "wheelset_functions.hpp"

namespace railtab {

/// What `tablegen conicity` has computed at one amplitude of the curve.
struct ConicityPoint {
  double amplitude = 0.0;  ///< [m]
  EquivalentConicity wave, regression;
  double narrow = 0.0, wide = 0.0;        ///< position in the bands, NaN without a reference or a wave
  std::array<RunStatistics, 3> errors;    ///< by ErrorBearer
  std::array<int, 3> inside_narrow = {};  ///< number of runs inside, likewise
  std::array<int, 3> inside_wide = {};
};

/// The curve, and the runs with errors where there are any, [ErrorBearer].
[[nodiscard]] std::vector<ConicityPoint> conicity_points(const ConicityRequest& request,
                                                         const WheelsetFunctions& functions,
                                                         const std::array<ConicityRuns, 3>& runs);

/// "reference" and "errors", as far as they were asked for.
[[nodiscard]] nlohmann::ordered_json points_json(const ConicityRequest& request,
                                                 const std::vector<ConicityPoint>& points);

/// The same as tables of text.
[[nodiscard]] std::string points_text(const ConicityRequest& request, const std::vector<ConicityPoint>& points);

/// One row per amplitude, SI units.
[[nodiscard]] std::string points_csv(const ConicityRequest& request, const std::vector<ConicityPoint>& points);

}  // namespace railtab
