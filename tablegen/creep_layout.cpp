#include "railtab/tablegen/creep_layout.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/full_sliding.hpp"
#include "railtab/tables/creep_coordinates.hpp"

namespace railtab {

namespace {

using std::numbers::pi;

constexpr double smallest_ratio = 1e-3, largest_ratio = 1e3;
constexpr double linear_creepage = 1e-6;  // in scaled creepage: adhesion everywhere but at the trailing edge

// What the layout's measured errors decided; see docs/theory/creep_table.md.
constexpr double ratio_stretch = 4.0;
constexpr double radius_unit = 2.0;

std::vector<double> uniform_nodes(double first, double last, int count) {
  std::vector<double> nodes(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) nodes[static_cast<std::size_t>(i)] = first + (last - first) * i / (count - 1);
  return nodes;
}

/// Ten linear values up to 1 and ten logarithmic ones from there to 10³ [MontenegroCalcada2023, Sec. 3.4.2].
std::vector<double> paper_nodes(double first) {
  std::vector<double> nodes = uniform_nodes(first, 1.0, 10);
  for (int i = 1; i <= 10; ++i) nodes.push_back(std::pow(10.0, 0.3 * i));
  return nodes;
}

CreepTableData empty_table(const CreepLayoutOptions& options) {
  options.validate();
  CreepTableData table;
  table.layout = options.layout;
  table.poisson = options.poisson;
  table.elements = options.elements;
  if (options.layout == CreepTableLayout::paper) {
    const std::vector<double> positive = paper_nodes(0.0);
    table.nodes = {paper_nodes(smallest_ratio), positive, positive, {}};
    for (auto node = positive.rbegin(); *node > 0.0; ++node) table.nodes[3].push_back(-*node);
    table.nodes[3].insert(table.nodes[3].end(), positive.begin(), positive.end());
    return table;
  }
  const std::array<int, 4>& n = options.nodes;
  table.ratio_stretch = ratio_stretch;
  table.radius_unit = radius_unit;
  for (const double x : uniform_nodes(squeezed_ratio(smallest_ratio, ratio_stretch),
                                      squeezed_ratio(largest_ratio, ratio_stretch), n[0])) {
    table.nodes[0].push_back(ratio_at(x, ratio_stretch));
  }
  table.nodes[0].front() = smallest_ratio;  // to the last bit
  table.nodes[0].back() = largest_ratio;
  table.nodes[1] = uniform_nodes(0.0, 1.0, n[1]);
  table.nodes[2] = uniform_nodes(0.0, 0.5 * pi, n[2]);
  table.nodes[3] = uniform_nodes(0.0, pi * (n[3] - 1) / n[3], n[3]);
  return table;
}

Creepage creepage_at_node(const CreepTableData& table, std::size_t ratio, double t, double alpha, double beta) {
  const auto u = creepage_at({t, alpha, beta}, creep_scale(table.nodes[0][ratio]), table.radius_unit);
  return {u[0], u[1], u[2]};
}

/// Calls `visit(ratio, t, alpha, beta)`, indices of nodes, for every place of the smooth layout that is solved for, in
/// the order of the cases: neither zero nor infinite creepage, and pure longitudinal creepage once for all β.
template <typename Visit>
void for_each_solved_node(const CreepTableData& table, const Visit& visit) {
  for (std::size_t t = 1; t + 1 < table.nodes[1].size(); ++t) {
    for (std::size_t alpha = 0; alpha < table.nodes[2].size(); ++alpha) {
      const std::size_t betas = alpha == 0 ? 1 : table.nodes[3].size();
      for (std::size_t beta = 0; beta < betas; ++beta) visit(t, alpha, beta);
    }
  }
}

/// Fills the values of one a/b.
class RatioSlab {
 public:
  RatioSlab(CreepTableData& table, std::size_t ratio)
      : table_(table), ratio_(ratio), moment_unit_(creep_scale(table.nodes[0][ratio]).moment) {}

  /// At t = 0: V = lim F/t, from the responses to the three creepages alone.
  void set_linear(std::span<const CreepForce> response) {
    // response[j] is to a scaled creepage of linear_creepage; the components that symmetry forbids are left out.
    const CreepScale scale = creep_scale(table_.nodes[0][ratio_]);
    for (std::size_t alpha = 0; alpha < table_.nodes[2].size(); ++alpha) {
      for (std::size_t beta = 0; beta < table_.nodes[3].size(); ++beta) {
        const Creepage u = creepage_at_node(table_, ratio_, 0.5, table_.nodes[2][alpha], table_.nodes[3][beta]);
        // At t = 1/2 the scaled creepages are as long as the radius' unit, to which V refers.
        const double by_length = 1.0 / linear_creepage;
        const double x = by_length * scale.x * u.x, y = by_length * scale.y * u.y,
                     spin = by_length * scale.spin * u.spin;
        set(0, alpha, beta,
            {x * response[0].x, y * response[1].y + spin * response[2].y,
             y * response[1].moment + spin * response[2].moment});
      }
    }
  }

  /// At t = 1: complete sliding.
  void set_sliding() {
    for (std::size_t alpha = 0; alpha < table_.nodes[2].size(); ++alpha) {
      for (std::size_t beta = 0; beta < table_.nodes[3].size(); ++beta) {
        const Creepage direction = creepage_at_node(table_, ratio_, 0.5, table_.nodes[2][alpha], table_.nodes[3][beta]);
        set(table_.nodes[1].size() - 1, alpha, beta, full_sliding_force(table_.nodes[0][ratio_], direction));
      }
    }
  }

  /// Between: V = F/t.
  void set_solved(std::size_t t, std::size_t alpha, std::size_t beta, const CreepForce& force) {
    const double inverse = 1.0 / table_.nodes[1][t];
    const CreepForce value{inverse * force.x, inverse * force.y, inverse * force.moment};
    if (alpha > 0) {
      set(t, alpha, beta, value);
      return;
    }
    for (std::size_t every = 0; every < table_.nodes[3].size(); ++every) set(t, 0, every, value);
  }

 private:
  /// Components that vanish by symmetry do so exactly.
  void set(std::size_t t, std::size_t alpha, std::size_t beta, const CreepForce& value) {
    const std::size_t node =
        ((ratio_ * table_.nodes[1].size() + t) * table_.nodes[2].size() + alpha) * table_.nodes[3].size() + beta;
    const bool longitudinal = alpha == 0, across = alpha + 1 == table_.nodes[2].size();
    table_.values[3 * node] = across ? 0.0 : value.x;
    table_.values[3 * node + 1] = longitudinal ? 0.0 : value.y;
    table_.values[3 * node + 2] = longitudinal ? 0.0 : value.moment / moment_unit_;
  }

  CreepTableData& table_;
  std::size_t ratio_;
  double moment_unit_;
};

std::vector<CreepCase> paper_cases(const CreepTableData& table) {
  std::vector<CreepCase> cases;
  for (const double ratio : table.nodes[0]) {
    for (const double x : table.nodes[1]) {
      for (const double y : table.nodes[2]) {
        for (const double spin : table.nodes[3]) cases.push_back({ratio, {x, y, spin}});
      }
    }
  }
  return cases;
}

void require_finite(std::span<const CreepForce> solved) {
  for (std::size_t i = 0; i < solved.size(); ++i) {
    const CreepForce& f = solved[i];
    if (!(std::isfinite(f.x) && std::isfinite(f.y) && std::isfinite(f.moment))) {
      throw input_error(fmt::format("creep table: case {}", i), fmt::format("{}, {}, {}", f.x, f.y, f.moment),
                        "finite forces");
    }
  }
}

}  // namespace

void CreepLayoutOptions::validate() const {
  if (!(poisson >= 0.0 && poisson <= 0.5)) throw input_error("Poisson's ratio", fmt::format("{}", poisson), "0..0.5");
  for (const int n : nodes) {
    if (n < 5 || n > 200) throw input_error("creep table: nodes of an axis", fmt::format("{}", n), "5..200");
  }
}

std::vector<CreepCase> creep_cases(const CreepLayoutOptions& options) {
  const CreepTableData table = empty_table(options);
  if (options.layout == CreepTableLayout::paper) return paper_cases(table);
  std::vector<CreepCase> cases;
  for (std::size_t i = 0; i < table.nodes[0].size(); ++i) {
    const double ratio = table.nodes[0][i];
    const CreepScale scale = creep_scale(ratio);
    cases.push_back({ratio, {linear_creepage / scale.x, 0.0, 0.0}});
    cases.push_back({ratio, {0.0, linear_creepage / scale.y, 0.0}});
    cases.push_back({ratio, {0.0, 0.0, linear_creepage / scale.spin}});
    for_each_solved_node(table, [&](std::size_t t, std::size_t alpha, std::size_t beta) {
      cases.push_back(
          {ratio, creepage_at_node(table, i, table.nodes[1][t], table.nodes[2][alpha], table.nodes[3][beta])});
    });
  }
  return cases;
}

CreepTableData assemble_creep_table(const CreepLayoutOptions& options, std::span<const CreepForce> solved) {
  CreepTableData table = empty_table(options);
  const std::size_t wanted = creep_cases(options).size();
  if (solved.size() != wanted) {
    throw input_error("creep table", fmt::format("{} solved cases", solved.size()), fmt::format("{}", wanted));
  }
  require_finite(solved);
  if (options.layout == CreepTableLayout::paper) {
    for (const CreepForce& f : solved) table.values.insert(table.values.end(), {f.x, f.y, f.moment});
    return table;
  }
  table.values.resize(3 * table.nodes[0].size() * table.nodes[1].size() * table.nodes[2].size() *
                      table.nodes[3].size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < table.nodes[0].size(); ++i) {
    RatioSlab slab(table, i);
    slab.set_linear(solved.subspan(next, 3));
    next += 3;
    for_each_solved_node(table, [&](std::size_t t, std::size_t alpha, std::size_t beta) {
      slab.set_solved(t, alpha, beta, solved[next++]);
    });
    slab.set_sliding();
  }
  return table;
}

}  // namespace railtab
