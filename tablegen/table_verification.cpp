#include "railtab/tablegen/table_verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <random>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/hertz.hpp"
#include "railtab/runtime/contact/paper_search.hpp"
#include "railtab/tablegen/intersection/outline_overlap.hpp"
#include "railtab/tablegen/parallel_failure.hpp"
#include "railtab/tablegen/random_number.hpp"

namespace railtab {

namespace {

/// Two patches are the same if they are nearer than this along the wheel profile [m].
constexpr double same_patch = 0.5e-3;
/// Normal-force errors are relative to the force, but to no less than this [N].
constexpr double force_floor = 1000.0;

double uniform_in(std::mt19937_64& generator, const Interval& interval) {
  return interval.low + (interval.high - interval.low) * uniform(generator);
}

struct Query {
  WheelsetPose pose;
  bool touches = false;
  bool answered = false;
  bool searched = false;
};

/// Draws poses and lowers each wheel below its first touch; the latter in parallel.
std::vector<Query> draw_queries(const ContactSearch& search, const VerificationOptions& options, int count,
                                std::mt19937_64& generator) {
  std::vector<Query> queries(static_cast<std::size_t>(count));
  for (Query& q : queries) {
    q.pose.y = uniform_in(generator, options.lateral);
    q.pose.yaw = uniform_in(generator, options.yaw);
    q.pose.roll = uniform_in(generator, options.roll);
    q.pose.z = uniform_in(generator, options.lowering);
  }
  ParallelFailure failure;
#pragma omp parallel for schedule(dynamic, 64)
  for (std::size_t n = 0; n < queries.size(); ++n) {
    failure.guard([&] {
      Query& q = queries[n];
      const double first = search.touch_height(q.pose.y, q.pose.roll, q.pose.yaw);
      q.touches = std::isfinite(first);
      q.pose.z += first;
    });
  }
  failure.rethrow();
  return queries;
}

/// NaN where the profiles' own curvatures make no ellipse: with yaw a pair can be a minimum of the distance while they
/// nearly conform.
double normal_force(const ContactPatch& patch) {
  const double d = std::max(0.0, patch.penetration);
  const double A = 0.5 * patch.curv_rolling;
  const double B = 0.5 * (patch.curv_wheel + patch.curv_rail);
  if (!(A > 0 && B > 0)) return std::numeric_limits<double>::quiet_NaN();
  const HertzContact hertz = hertz_contact(A, B, ElasticMaterial{});
  return hertz.stiffness * d * std::sqrt(d);
}

struct PatchError {
  double penetration, position_rail, position_wheel, contact_angle, rolling_radius, normal_force_relative;
};

PatchError patch_error(const ContactPatch& table, const ContactPatch& online) {
  const double force = normal_force(online);
  return {std::abs(table.penetration - online.penetration),
          std::hypot(table.y_rail - online.y_rail, table.z_rail - online.z_rail),
          std::hypot(table.y_wheel - online.y_wheel, table.z_wheel - online.z_wheel),
          std::abs(table.angle - online.angle),
          std::abs(table.rolling_radius - online.rolling_radius),
          std::abs(normal_force(table) - force) / std::max(force, force_floor)};
}

/// Pairs the patches of both answers, nearest first come; true where a patch deeper than `deep` has no partner.
bool compare_patches(const ContactPatches& table, const ContactPatches& online, double deep,
                     std::vector<PatchError>& errors) {
  std::array<bool, ContactPatches::capacity> used{};
  bool mismatch = false;
  for (const ContactPatch& truth : online) {
    int best = -1;
    double nearest = same_patch;
    for (int n = 0; n < table.count; ++n) {
      const double distance = std::abs(table.patch[n].s_wheel - truth.s_wheel);
      if (used[n] || distance > nearest) continue;
      nearest = distance;
      best = n;
    }
    if (best < 0) {
      mismatch = mismatch || truth.penetration > deep;
      continue;
    }
    used[best] = true;
    errors.push_back(patch_error(table.patch[best], truth));
  }
  for (int n = 0; n < table.count; ++n) {
    mismatch = mismatch || (!used[n] && table.patch[n].penetration > deep);
  }
  return mismatch;
}

/// Scan of the search that judges where table and online search differ [m].
constexpr double finer_spacing = 0.02e-3;
/// Points per profile of the published search that is timed for comparison.
constexpr int paper_points = 1000;

struct Differences {
  std::vector<PatchError> patches;
  int online = 0;                ///< queries at which the table differs from the online search
  int finer = 0;                 ///< of these, from the search with the finer scan as well
  int outline = 0, in_band = 0;  ///< from the exact overlap of the outlines (RegionComparison)
};

/// Answers the queries by table and online search, in parallel.
void compare_queries(const TableContact& contact, const ContactSearch& finer, const OutlineOverlap& outlines,
                     double deep, std::vector<Query>& queries, Differences& sum) {
  const auto compare_query = [&](Query& q, Differences& own) {
    if (!q.touches) return;
    ContactPatches answer;
    const TableAnswer way = contact.answer(q.pose, 0.0, answer);
    q.answered = way != TableAnswer::none;
    q.searched = way == TableAnswer::searched;
    if (!q.answered) return;
    const RegionComparison regions = compare(outlines.regions(q.pose), answer);
    own.outline += static_cast<int>(regions.mismatch);
    own.in_band += static_cast<int>(regions.in_band);
    if (!compare_patches(answer, contact.search().patches(q.pose), deep, own.patches)) return;
    ++own.online;
    std::vector<PatchError> unused;
    own.finer += compare_patches(answer, finer.patches(q.pose), deep, unused);
  };
  ParallelFailure failure;
  std::mutex one_at_a_time;
#pragma omp parallel
  {
    Differences own;
#pragma omp for schedule(dynamic, 64)
    for (std::size_t n = 0; n < queries.size(); ++n) failure.guard([&] { compare_query(queries[n], own); });
    failure.guard([&] {
      const std::scoped_lock lock(one_at_a_time);
      sum.patches.insert(sum.patches.end(), own.patches.begin(), own.patches.end());
      sum.online += own.online;
      sum.finer += own.finer;
      sum.outline += own.outline;
      sum.in_band += own.in_band;
    });
  }
  failure.rethrow();
}

/// Least mean time of several passes over the same poses: the machine's other work only ever adds.
template <typename Function>
double nanoseconds_per_query(const std::vector<WheelsetPose>& poses, int passes, const Function& patches) {
  if (poses.empty()) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  int total = 0;
  for (int pass = 0; pass < passes; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    for (const WheelsetPose& pose : poses) total += patches(pose);
    const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
    least = std::min(least, elapsed.count() / static_cast<double>(poses.size()));
  }
  // The patches must be wanted by someone, or the compiler may drop the calls.
  return total >= 0 ? least : 0.0;
}

void measure_time(const TableContact& contact, const std::vector<Query>& queries, GeometryVerification& result) {
  std::vector<WheelsetPose> all, answered;
  for (const Query& q : queries) {
    if (q.touches) all.push_back(q.pose);
    if (q.answered) answered.push_back(q.pose);
  }
  const auto from_table = [&](const WheelsetPose& pose) { return contact.patches(pose).count; };
  const auto online = [&](const WheelsetPose& pose) { return contact.search().patches(pose).count; };
  result.time_table_ns = nanoseconds_per_query(answered, 10, from_table);
  result.time_online_ns = nanoseconds_per_query(answered, 2, online);
  result.time_with_fallback_ns = nanoseconds_per_query(all, 5, from_table);
  // A thousand queries of it take as long as a hundred thousand of the table.
  answered.resize(std::min<std::size_t>(answered.size(), 1000));
  const PaperSearch paper(contact.search().pair(), paper_points);
  result.time_paper_ns =
      nanoseconds_per_query(answered, 2, [&](const WheelsetPose& pose) { return paper.patches(pose).count; });
}

void set_errors(const std::vector<PatchError>& errors, GeometryVerification& result) {
  const auto column = [&](double PatchError::*member) {
    std::vector<double> values;
    values.reserve(errors.size());
    for (const PatchError& e : errors) {
      // Only a force can be NaN, see normal_force().
      if (!std::isnan(e.*member)) values.push_back(e.*member);
    }
    return error_statistics(std::move(values));
  };
  result.patches_compared = static_cast<int>(errors.size());
  result.penetration = column(&PatchError::penetration);
  result.position_rail = column(&PatchError::position_rail);
  result.position_wheel = column(&PatchError::position_wheel);
  result.contact_angle = column(&PatchError::contact_angle);
  result.rolling_radius = column(&PatchError::rolling_radius);
  result.normal_force_relative = column(&PatchError::normal_force_relative);
}

void validate(const VerificationOptions& o) {
  if (o.samples < 1 || o.samples > 100'000'000) {
    throw input_error("verification: samples", fmt::format("{}", o.samples), "a number in 1..100000000");
  }
  if (!(o.lowering.low >= 0 && o.lowering.low <= o.lowering.high && o.lowering.high <= 0.01)) {
    throw input_error("verification: dz [m]", fmt::format("{}:{}", o.lowering.low, o.lowering.high),
                      "low:high with 0 <= low <= high <= 0.01");
  }
}

}  // namespace

ErrorStatistics error_statistics(std::vector<double> errors) {
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  double sum = 0;
  for (double e : errors) sum += e;
  const auto quantile = [&](double p) {
    const double rank = std::ceil(p * static_cast<double>(errors.size()) - 1e-9);
    return errors[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
  };
  return {sum / static_cast<double>(errors.size()),
          quantile(0.5),
          quantile(0.95),
          quantile(0.99),
          quantile(0.999),
          errors.back()};
}

VerificationOptions verification_options(const GeometryTableData& table) {
  const auto option = [&](std::string_view name) {
    for (const auto& [key, value] : table.statistics) {
      if (key == name) return value;
    }
    throw input_error(fmt::format("geometry table: {}", name), "nothing",
                      "the range for which the table was generated");
  };
  VerificationOptions options;
  options.lateral = {option("option.lateral_low"), option("option.lateral_high")};
  options.yaw = {option("option.yaw_low"), option("option.yaw_high")};
  options.roll = {option("option.roll_low"), option("option.roll_high")};
  options.tolerance = table.tolerance;
  return options;
}

GeometryVerification verify_geometry_table(const TableContact& contact, const VerificationOptions& options,
                                           const Progress& progress) {
  validate(options);
  const ContactSearch& search = contact.search();
  std::mt19937_64 generator(options.seed);
  GeometryVerification result;
  result.bytes = contact.table().bytes();
  Differences differences;
  int searched = 0;
  const ContactSearch finer(search.pair(), finer_spacing);
  const OutlineOverlap outlines(search.pair());
  // In portions, so that progress can be told and positions where the wheel does not touch are drawn again.
  const int portion = std::min(options.samples, 5000);
  std::vector<Query> timed;
  while (result.samples < options.samples) {
    std::vector<Query> queries =
        draw_queries(search, options, std::min(portion, options.samples - result.samples), generator);
    compare_queries(contact, finer, outlines, 10 * options.tolerance, queries, differences);
    for (const Query& q : queries) {
      result.samples += q.touches;
      result.never_touching += !q.touches;
      result.answered_by_table += q.answered;
      searched += q.searched;
    }
    if (result.never_touching > 20 * (result.samples + portion)) {
      throw ComputationError("verification: the wheel does not meet the rail in more than 95 % of the range");
    }
    if (progress) progress(static_cast<double>(result.samples) / options.samples);
    if (queries.size() > timed.size()) timed = std::move(queries);
  }
  result.searched_share = static_cast<double>(searched) / result.samples;
  result.fallback_share = 1.0 - static_cast<double>(result.answered_by_table) / result.samples;
  if (result.answered_by_table > 0) {
    result.patch_mismatch_share = static_cast<double>(differences.online) / result.answered_by_table;
    result.finer_mismatch_share = static_cast<double>(differences.finer) / result.answered_by_table;
    result.outline_mismatch_share = static_cast<double>(differences.outline) / result.answered_by_table;
    result.outline_in_band_share = static_cast<double>(differences.in_band) / result.answered_by_table;
  }
  set_errors(differences.patches, result);
  if (options.timing) measure_time(contact, timed, result);
  return result;
}

}  // namespace railtab
