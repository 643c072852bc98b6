#include "railtab/runtime/moving_load/axle_train.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "railtab/runtime/base/column_file.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

struct Axle {
  double behind, load;
};

/// The axles of a train in the order in which they come.
void set_axles(std::vector<Axle> axles, AxleTrain& train) {
  std::stable_sort(axles.begin(), axles.end(), [](const Axle& a, const Axle& b) { return a.behind < b.behind; });
  train.behind.clear();
  train.load.clear();
  for (const Axle& axle : axles) {
    train.behind.push_back(axle.behind);
    train.load.push_back(axle.load);
  }
}

}  // namespace

double AxleTrain::total_load() const noexcept { return std::accumulate(load.begin(), load.end(), 0.0); }

AxleTrain hslm_a_train(int coaches, double coach_length, double wheelbase, double axle_load) {
  constexpr double power_car[] = {0.0, 3.0, 14.0, 17.0}, to_end_coach = 3.525;  // [m]
  const double first_bogie = power_car[3] + 0.5 * to_end_coach;
  const double reach = 2.0 * first_bogie + (coaches + 2) * coach_length;
  std::vector<Axle> axles;
  for (const double x : power_car) axles.insert(axles.end(), {{x, axle_load}, {reach - x, axle_load}});
  for (const double x : {power_car[3] + to_end_coach, power_car[3] + to_end_coach + wheelbase}) {
    axles.insert(axles.end(), {{x, axle_load}, {reach - x, axle_load}});
  }
  for (int i = 1; i <= coaches + 1; ++i) {
    const double bogie = first_bogie + i * coach_length;
    axles.insert(axles.end(), {{bogie - 0.5 * wheelbase, axle_load}, {bogie + 0.5 * wheelbase, axle_load}});
  }
  AxleTrain train;
  set_axles(std::move(axles), train);
  return train;
}

AxleTrain repeated(const AxleTrain& unit, int count) {
  if (count == 1) return unit;
  if (!(unit.length > 0.0)) {
    throw input_error(
        "axle train", fmt::format("'{}*{}'", unit.name, count),
        fmt::format("'{}' once: its length over buffers is not known; wagons (en15528-…) may be repeated", unit.name));
  }
  AxleTrain train = unit;
  train.name = fmt::format("{}*{}", unit.name, count);
  for (int i = 1; i < count; ++i) {
    for (std::size_t k = 0; k < unit.behind.size(); ++k) {
      train.behind.push_back(unit.behind[k] + i * unit.length);
      train.load.push_back(unit.load[k]);
    }
  }
  train.length = count * unit.length;
  return train;
}

AxleTrain spread_over_sleepers(const AxleTrain& train, double sleeper_spacing) {
  std::vector<Axle> forces;
  for (std::size_t k = 0; k < train.behind.size(); ++k) {
    forces.push_back({train.behind[k] - sleeper_spacing, 0.25 * train.load[k]});
    forces.push_back({train.behind[k], 0.5 * train.load[k]});
    forces.push_back({train.behind[k] + sleeper_spacing, 0.25 * train.load[k]});
  }
  AxleTrain spread = train;
  set_axles(std::move(forces), spread);
  return spread;
}

AxleTrain read_axle_file(const std::filesystem::path& file) {
  constexpr double longest = 1e4, heaviest = 1000.0;  // [m], [kN]
  constexpr std::size_t most = 5000;
  const NumberRows table = read_number_rows(file, {"x[m]", "P[kN]"});
  if (table.rows.size() > most) {
    throw input_error(file.string(), fmt::format("{} axles", table.rows.size()), fmt::format("at most {}", most));
  }
  AxleTrain train;
  train.name = file.stem().string();
  train.provenance.source = file.string();
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const double x = table.rows[k][0], load = table.rows[k][1];
    if (k > 0 && !(x > table.rows[k - 1][0])) {
      throw input_error(table.places[k] + ": x[m]", fmt::format("{:.6g} after {:.6g}", x, table.rows[k - 1][0]),
                        "places behind the first axle, rising");
    }
    if (x - table.rows[0][0] > longest) {
      throw input_error(table.places[k] + ": x[m]", fmt::format("{:.6g} m behind the first axle", x - table.rows[0][0]),
                        fmt::format("at most {:g} m; the column is in m", longest));
    }
    if (!(load > 0.0 && load <= heaviest)) {
      throw input_error(table.places[k] + ": P[kN]", fmt::format("{:.6g}", load),
                        fmt::format("an axle load above 0 and up to {:g}; the column is in kN", heaviest));
    }
    train.behind.push_back(x - table.rows[0][0]);
    train.load.push_back(1e3 * load);
  }
  return train;
}

}  // namespace railtab
