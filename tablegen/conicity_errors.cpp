#include "railtab/tablegen/conicity_errors.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "parallel_failure.hpp"

namespace railtab {

namespace {

WheelRailPair with_errors(const WheelRailPair& exact, ErrorBearer bearer, const ConicityErrorOptions& options,
                          std::mt19937_64& generator) {
  const auto measured = [&](const ProfileCurve& profile, ErrorBearer other) {
    return bearer == other
               ? profile
               : ProfileCurve(measured_profile(profile.knots(), options.errors, options.smoothing, generator));
  };
  ProfileCurve wheel = measured(exact.wheel(), ErrorBearer::rails);
  ProfileCurve rail = measured(exact.rail(), ErrorBearer::wheels);
  PairDimensions dimensions = exact.dimensions();
  dimensions.track_gauge = track_gauge(rail, exact.rail_offset(), dimensions.gauge_height);
  return {std::move(wheel), std::move(rail), dimensions};
}

std::vector<double> conicities(const WheelsetPair& pair, const ConicityErrorOptions& options) {
  const std::vector<WheelsetContact> contacts = searched_contacts(pair, options.contact);
  std::vector<double> values(options.amplitudes.size(), std::numeric_limits<double>::quiet_NaN());
  if (contacts.size() < 2) return values;
  const RadiusDifferenceCurve curve(contacts);
  std::transform(options.amplitudes.begin(), options.amplitudes.end(), values.begin(),
                 [&](double amplitude) { return conicity_of_wave(curve, amplitude).tan_gamma; });
  return values;
}

}  // namespace

std::vector<WheelsetContact> searched_contacts(const WheelsetPair& pair, const WheelsetContactOptions& options) {
  const ContactSearch right(pair.right), left(pair.left);
  return wheelset_contacts(searched_side(right), searched_side(left), options);
}

ConicityRuns conicity_with_errors(const WheelsetPair& exact, ErrorBearer bearer, const ConicityErrorOptions& options,
                                  const Progress& progress) {
  assert(options.runs >= 1);
  options.errors.validate();
  ConicityRuns runs(static_cast<std::size_t>(options.runs));
  ParallelFailure failure;
  int done = 0;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t run = 0; run < runs.size(); ++run) {
    failure.guard([&] {
      std::seed_seq seeds{options.seed & 0xffffffffU, options.seed >> 32U, static_cast<std::uint64_t>(run),
                          static_cast<std::uint64_t>(bearer)};
      std::mt19937_64 generator(seeds);
      WheelRailPair right = with_errors(exact.right, bearer, options, generator);
      WheelRailPair left = with_errors(exact.left, bearer, options, generator);
      runs[run] = conicities({std::move(right), std::move(left)}, options);
#pragma omp critical(conicity_errors_progress)
      if (progress) progress(static_cast<double>(++done) / options.runs);
    });
  }
  failure.rethrow();
  return runs;
}

RunStatistics run_statistics(const ConicityRuns& runs, std::size_t amplitude) {
  std::vector<double> values;
  for (const std::vector<double>& run : runs) {
    if (std::isfinite(run[amplitude])) values.push_back(run[amplitude]);
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {0, none, none, none, none};
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double v : values) mean += v / n;
  double squares = 0.0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  return {static_cast<int>(values.size()), mean, values.size() < 2 ? none : std::sqrt(squares / (n - 1.0)), *least,
          *greatest};
}

}  // namespace railtab
