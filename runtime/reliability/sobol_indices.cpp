#include "railtab/runtime/reliability/sobol_indices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/reliability/counter_random.hpp"
#include "railtab/runtime/reliability/replicates.hpp"

namespace railtab {
namespace {

constexpr std::uint32_t rows_stream = 9;
using Rows = std::vector<std::size_t>;

/// Responses of A, B and the AB_i, N each.
class Responses {
 public:
  Responses(std::vector<double> values, std::size_t samples) : values_(std::move(values)), samples_(samples) {
    const double count = 2.0 * static_cast<double>(samples);
    const auto both = values_.begin() + static_cast<std::ptrdiff_t>(2 * samples);
    mean_ = std::accumulate(values_.begin(), both, 0.0) / count;
    for (double& value : values_) value -= mean_;
  }
  [[nodiscard]] double mean() const { return mean_; }
  /// Whether the responses of A and B are more than one value, whose variance would be rounding alone.
  [[nodiscard]] bool vary(const Rows& rows) const {
    const double one = a(rows.front());
    return std::any_of(rows.begin(), rows.end(), [&](std::size_t k) { return a(k) != one || b(k) != one; });
  }
  [[nodiscard]] double variance(const Rows& rows) const {
    double sum = 0.0, square = 0.0;
    for (const std::size_t k : rows) {
      sum += a(k) + b(k);
      square += a(k) * a(k) + b(k) * b(k);
    }
    const double count = 2.0 * static_cast<double>(rows.size());
    return (square - sum * sum / count) / (count - 1.0);
  }
  [[nodiscard]] double first(std::size_t i, const Rows& rows) const {
    double sum = 0.0;
    for (const std::size_t k : rows) sum += b(k) * (ab(i, k) - a(k));
    return sum / (static_cast<double>(rows.size()) * variance(rows));
  }
  [[nodiscard]] double total(std::size_t i, const Rows& rows) const {
    double sum = 0.0;
    for (const std::size_t k : rows) sum += (a(k) - ab(i, k)) * (a(k) - ab(i, k));
    return sum / (2.0 * static_cast<double>(rows.size()) * variance(rows));
  }

 private:
  [[nodiscard]] double a(std::size_t k) const { return values_[k]; }
  [[nodiscard]] double b(std::size_t k) const { return values_[samples_ + k]; }
  [[nodiscard]] double ab(std::size_t i, std::size_t k) const { return values_[(2 + i) * samples_ + k]; }
  std::vector<double> values_;
  std::size_t samples_;
  double mean_ = 0.0;
};

UnitPoints all_points(const SobolOptions& options) {
  const UnitPoints both = latin_hypercube_points(options.samples, 2 * options.variables, options.seed);
  const auto half = static_cast<std::ptrdiff_t>(options.variables);
  UnitPoints points;
  for (const std::vector<double>& row : both) points.emplace_back(row.begin(), row.begin() + half);
  for (const std::vector<double>& row : both) points.emplace_back(row.begin() + half, row.end());
  for (std::size_t i = 0; i < options.variables; ++i) {
    for (const std::vector<double>& row : both) {
      points.emplace_back(row.begin(), row.begin() + half)[i] = row[options.variables + i];
    }
  }
  return points;
}

}  // namespace

SobolIndices sobol_indices(const SobolOptions& options, const ResponseOfUnitPoints& response) {
  const Responses responses(response(all_points(options)), options.samples);
  Rows rows(options.samples);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  if (!responses.vary(rows)) {
    throw ComputationError(fmt::format(
        "importance: all {} independent responses are {:.6g}: without variance there are no Sobol' indices; "
        "expected a measure that the variables change",
        2 * options.samples, responses.mean()));
  }
  SobolIndices indices;
  indices.mean = responses.mean();
  indices.variance = responses.variance(rows);
  std::vector<std::vector<double>> first(options.variables), total(options.variables);
  for (std::size_t r = 0; r < options.replicates; ++r) {
    Rows drawn(rows.size());
    for (std::size_t k = 0; k < drawn.size(); ++k) {
      const double u = uniform_random(options.seed, {r, static_cast<std::uint32_t>(k), rows_stream});
      drawn[k] = static_cast<std::size_t>(u * static_cast<double>(rows.size()));
    }
    if (!responses.vary(drawn)) continue;
    for (std::size_t i = 0; i < options.variables; ++i) {
      first[i].push_back(responses.first(i, drawn));
      total[i].push_back(responses.total(i, drawn));
    }
  }
  if (options.variables > 0 && first.front().empty()) {
    throw ComputationError(fmt::format(
        "importance: none of {} bootstrap replicates has variance; expected more samples", options.replicates));
  }
  for (std::size_t i = 0; i < options.variables; ++i) {
    indices.first.push_back(replicate_interval(responses.first(i, rows), first[i], options.confidence));
    indices.total.push_back(replicate_interval(responses.total(i, rows), total[i], options.confidence));
  }
  return indices;
}

}  // namespace railtab
