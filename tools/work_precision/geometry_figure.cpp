#include "geometry_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include "interleaved_timing.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/paper_search.hpp"
#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"

namespace railtab::work_precision {

namespace {

struct Query {
  WheelsetPose pose;
  double penetration;  ///< of the deepest patch, by the search with a scan of 0.02 mm [m]
};

double deepest(const ContactPatches& patches) {
  double d = 0.0;
  for (const ContactPatch& p : patches) d = std::max(d, p.penetration);
  return d;
}

std::vector<Query> random_queries(const WheelRailPair& pair, int count) {
  const ContactSearch reference(pair, 0.02e-3);
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Query> queries;
  const long most_draws = 1000L * count;
  for (long draw = 0; static_cast<int>(queries.size()) < count; ++draw) {
    if (draw == most_draws)
      throw ComputationError("work_precision: hardly any position where the wheel meets the rail");
    WheelsetPose pose{-12e-3 + 24e-3 * uniform(generator), 0.0, 0.0, -0.03 + 0.06 * uniform(generator)};
    const double lowering = 3e-4 * uniform(generator);
    const double touch = reference.touch_height(pose.y, pose.roll, pose.yaw);
    if (!std::isfinite(touch)) continue;
    pose.z = touch + lowering;
    queries.push_back({pose, deepest(reference.patches(pose))});
  }
  return queries;
}

/// A way to the deepest patch's penetration.
struct Method {
  std::string name, setting, note;
  std::function<double(const WheelsetPose&)> penetration;
  bool standard = false;
};

/// Polynomials alone: the largest height below the touch curves of a leaf's branches, seen along the normal of the rail
/// profile at their pairs.
double polynomial_penetration(const TableContact& contact, const WheelsetPose& pose) {
  const GeometryTable::Lookup lookup = contact.table().lookup(pose.y, pose.z, pose.yaw, pose.roll);
  double d = 0.0;
  for (int n = 0; n < lookup.count; ++n) {
    const BranchStart& start = lookup.branch[static_cast<std::size_t>(n)];
    const CurvePoint C = contact.search().pair().rail().at(start.s_rail);
    d = std::max(d, (pose.z - start.z_touch) * C.dy / std::hypot(C.dy, C.dz));
  }
  return d;
}

std::vector<Method> methods(const ContactSearch& search, bool quick) {
  std::vector<Method> result;
  const auto online = std::make_shared<const ContactSearch>(search);
  struct Cells {
    double start_error;    // [m]
    double iterated_cell;  // share of queries
  };
  const GeometrySweepOptions standard;
  std::vector<Cells> all{{standard.start_error, standard.iterated_cell}};
  if (!quick) all = {{1e-4, 2e-4}, all.front(), {8e-6, 2e-5}, {2e-6, 4e-6}};
  for (const Cells& cells : all) {
    GeometrySweepOptions options;
    options.start_error = cells.start_error;
    options.iterated_cell = cells.iterated_cell;
    const auto table = std::make_shared<const TableContact>(GeometryTable(generate_geometry_table(search, options)));
    const std::string setting = fmt::format("{:g} µm", cells.start_error * 1e6);
    const std::string note = fmt::format("{:.0f} KiB", static_cast<double>(table->table().bytes()) / 1024.0);
    result.push_back({"table: polynomials alone", setting, note,
                      [table](const WheelsetPose& p) { return polynomial_penetration(*table, p); }});
    result.push_back({"table: pair polished", setting, note,
                      [table](const WheelsetPose& p) { return deepest(table->patches(p)); },
                      cells.start_error == standard.start_error});
  }
  result.push_back(
      {"online search", "0.25 mm scan", "", [online](const WheelsetPose& p) { return deepest(online->patches(p)); }});
  for (const int points : {500, 1000, 2000}) {
    const auto paper = std::make_shared<const PaperSearch>(search.pair(), points);
    result.push_back({"published search", fmt::format("{} points", points), "",
                      [paper](const WheelsetPose& p) { return deepest(paper->patches(p)); }});
  }
  return result;
}

}  // namespace

WorkFigure geometry_figure(bool quick) {
  WorkFigure figure;
  figure.name = "geometry";
  figure.title = "Contact geometry: penetration of the deepest patch";
  figure.y_label = "error of penetration, 99.9 % point [m]";
  figure.least_error = 2e-12;
  figure.advice =
      "Take the default table (32 µm): its penetration agrees with the online search's to two picometres, in a small "
      "fraction of the time. Where the default is drawn hollow, another size of cells has the same error in less "
      "time. The size hardly matters because the contact pair is polished on the stored profiles; the polynomials "
      "alone show the effect of the polishing. The published search with discretised profiles is slower than the "
      "online search, and its error is that of the spacing of its points.";
  const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)),
                                           PairDimensions{}));
  const std::vector<Query> queries = random_queries(search.pair(), quick ? 4000 : 50000);
  const std::vector<Method> all = methods(search, quick);
  std::vector<std::function<double()>> passes;
  for (const Method& method : all) {
    passes.push_back([&] {
      double sum = 0.0;
      for (const Query& query : queries) sum += method.penetration(query.pose);
      return sum;
    });
  }
  const std::vector<double> seconds = interleaved_medians(passes, quick ? 3 : 9);
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<double> errors;
    for (const Query& query : queries) errors.push_back(std::abs(all[i].penetration(query.pose) - query.penetration));
    std::sort(errors.begin(), errors.end());
    const auto at = static_cast<std::size_t>(0.999 * static_cast<double>(errors.size() - 1));
    figure.points.push_back({all[i].name, all[i].setting, 1e9 * seconds[i] / static_cast<double>(queries.size()),
                             errors[at], errors.back(), all[i].note, all[i].standard});
  }
  return figure;
}

}  // namespace railtab::work_precision
