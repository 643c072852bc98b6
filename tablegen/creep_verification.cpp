#include "railtab/tablegen/creep_verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <random>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/creep_layout.hpp"
#include "railtab/tablegen/parallel_failure.hpp"
#include "railtab/tablegen/random_number.hpp"
#include "railtab/tablegen/rolling_contact.hpp"

namespace railtab {

namespace {

using std::numbers::pi;

double log_uniform(std::mt19937_64& generator, const Interval& interval) {
  return interval.low * std::pow(interval.high / interval.low, uniform(generator));
}

std::vector<CreepCase> random_cases(const CreepVerificationOptions& options, double nu) {
  std::mt19937_64 generator(options.seed);
  std::vector<CreepCase> cases(static_cast<std::size_t>(options.samples));
  for (CreepCase& c : cases) {
    c.ratio = log_uniform(generator, options.ratio);
    const double size = log_uniform(generator, options.creepage);
    const double z = 2.0 * uniform(generator) - 1.0, around = 2.0 * pi * uniform(generator);
    const double across = std::sqrt(1.0 - z * z);
    const KalkerCoefficients k = kalker_coefficients(c.ratio, nu);
    c.creepage = {3.0 * size * across * std::cos(around) / k.c11, 3.0 * size * across * std::sin(around) / k.c22,
                  size * z / k.c23};
  }
  return cases;
}

/// The exact solutions; a new ellipse for every case.
std::vector<CreepForce> solve_exactly(const std::vector<CreepCase>& cases, const CreepTableData& table,
                                      const Progress& progress, CreepVerification& result) {
  RollingContactOptions options;
  options.elements = table.elements;
  static_cast<void>(ExtrapolatedRollingContact(1.0, table.poisson, options));  // rejects the table's before the threads
  std::vector<CreepForce> forces(cases.size());
  std::vector<double> extrapolated(cases.size());
  int failed = 0, done = 0;
  ParallelFailure failure;
  std::mutex one_at_a_time;
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t i = 0; i < cases.size(); ++i) {
    failure.guard([&] {
      ExtrapolatedRollingContact contact(cases[i].ratio, table.poisson, options);
      const ExtrapolatedContactSolution s = contact.solve(cases[i].creepage);
      forces[i] = s.force;
      extrapolated[i] = std::hypot(s.force.x - s.fine.force.x, s.force.y - s.fine.force.y);
      const std::scoped_lock lock(one_at_a_time);
      failed += !(s.coarse.converged && s.fine.converged);
      result.safe_method += s.coarse.safe_method || s.fine.safe_method;
      result.worst_residual = std::max({result.worst_residual, s.coarse.residual, s.fine.residual});
      ++done;
      if (progress && done % 64 == 0) progress(static_cast<double>(done) / static_cast<double>(cases.size()));
    });
  }
  failure.rethrow();
  if (failed > 0) throw ComputationError(fmt::format("creep verification: {} exact solutions do not converge", failed));
  result.extrapolated_p99 = error_statistics(std::move(extrapolated)).p99;
  return forces;
}

/// Least mean time of several passes: the machine's other work only ever adds.
template <typename Function>
double nanoseconds(const std::vector<CreepCase>& cases, int passes, const Function& force) {
  double least = std::numeric_limits<double>::infinity(), sum = 0.0;
  for (int pass = 0; pass < passes; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    for (const CreepCase& c : cases) sum += force(c);
    const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
    least = std::min(least, elapsed.count() / static_cast<double>(cases.size()));
  }
  // The forces must be wanted by someone, or the compiler may drop the calls.
  return std::isfinite(sum) ? least : 0.0;
}

CreepLawErrors law_errors(std::string_view name, const CreepLaw& law, const std::vector<CreepCase>& cases,
                          const std::vector<CreepForce>& exact, int timing_passes) {
  std::vector<double> force, moment;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const CreepForce f = creep_force(law, cases[i].ratio, cases[i].creepage);
    force.push_back(std::hypot(f.x - exact[i].x, f.y - exact[i].y));
    moment.push_back(std::abs(f.moment - exact[i].moment));
  }
  CreepLawErrors errors{name, error_statistics(std::move(force)), error_statistics(std::move(moment)), 0.0};
  if (timing_passes > 0) {
    const std::vector<CreepCase> some(cases.begin(), cases.begin() + std::min<long>(2000, std::ssize(cases)));
    errors.time_ns =
        nanoseconds(some, timing_passes, [&](const CreepCase& c) { return creep_force(law, c.ratio, c.creepage).x; });
  }
  return errors;
}

/// A wheel that runs: everything changes by little from one case to the next.
std::vector<CreepCase> trajectory(const CreepVerificationOptions& options, double nu) {
  std::vector<CreepCase> path(4096);
  const KalkerCoefficients k = kalker_coefficients(1.2, nu);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double s = 2.0 * pi * static_cast<double>(i) / 1024.0;
    const double ratio = std::clamp(1.2 * std::exp(0.5 * std::sin(0.3 * s)), options.ratio.low, options.ratio.high);
    path[i] = {
        ratio,
        {0.6 * std::sin(s) / k.c11, 1.5 * std::sin(1.7 * s + 0.4) / k.c22, (0.3 + 0.2 * std::sin(0.7 * s)) / k.c23}};
  }
  return path;
}

void measure_table(const TableCreep& law, const std::vector<CreepCase>& cases, const CreepVerificationOptions& options,
                   CreepVerification& result) {
  const auto lookup = [&](const CreepCase& c) {
    const CreepLookup found = law.table->lookup(c.ratio, {c.creepage.x, c.creepage.y, c.creepage.spin});
    return found.force[0] + found.derivative[1][2];
  };
  result.table.time_ns = nanoseconds(cases, 20, lookup);
  result.time_trajectory_ns = nanoseconds(trajectory(options, law.table->data().poisson), 20, lookup);
}

void validate(const CreepVerificationOptions& o) {
  if (o.samples < 1 || o.samples > 10'000'000) {
    throw input_error("creep verification: samples", fmt::format("{}", o.samples), "a number in 1..10000000");
  }
  for (const auto& [name, interval] : {std::pair{"ratio", o.ratio}, std::pair{"creepage", o.creepage}}) {
    if (!(interval.low >= 1e-4 && interval.low <= interval.high && interval.high <= 1e4)) {
      throw input_error(fmt::format("creep verification: {}", name), fmt::format("{}:{}", interval.low, interval.high),
                        "low:high with 1e-4 <= low <= high <= 10000");
    }
  }
}

}  // namespace

CreepVerification verify_creep_table(const TableCreep& law, const CreepVerificationOptions& options,
                                     const Progress& progress) {
  validate(options);
  const CreepTableData& data = law.table->data();
  const double nu = data.poisson;
  const std::vector<CreepCase> cases = random_cases(options, nu);
  CreepVerification result;
  result.samples = options.samples;
  result.bytes = law.table->bytes();
  const auto start = std::chrono::steady_clock::now();
  const std::vector<CreepForce> exact = solve_exactly(cases, data, progress, result);
  const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
  result.time_exact_ns = options.timing ? elapsed.count() / static_cast<double>(cases.size()) : 0.0;
  for (const CreepCase& c : cases) result.outside += law.share(c.ratio, c.creepage) < 1.0;
  const int passes = options.timing ? 3 : 0;
  result.table = law_errors("table", law, cases, exact, 0);
  if (options.timing) measure_table(law, cases, options, result);
  const std::array<std::pair<std::string_view, CreepLaw>, 4> others{
      {{"fastsim_20", FastsimCreep{.nu = nu, .strips = 20, .elements = 20}},
       {"fastsim_50", FastsimCreep{.nu = nu, .strips = 50, .elements = 50}},
       {"polach", PolachCreep{.nu = nu}},
       {"linear_saturated", LinearCreep{.nu = nu, .saturated = true}}}};
  for (const auto& [name, other] : others) result.laws.push_back(law_errors(name, other, cases, exact, passes));
  return result;
}

}  // namespace railtab
