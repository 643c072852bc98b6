#include "study_runs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "assess_contact.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/reliability/sampling.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "run_measures.hpp"
#include "scene_decks.hpp"

namespace railtab::vsi {
namespace fs = std::filesystem;
namespace {

StudyValue sampled(const StudyVariable& variable, Probability p) {
  const double value = quantile(*variable.distribution, p);
  const bool whole = std::all_of(variable.keys.begin(), variable.keys.end(),
                                 [](const StudyKey& k) { return k.whole && k.as_it_is(); });
  return {whole ? std::floor(value) : value, std::nullopt};
}

UnitPoints unit_points(const StudyPlan& plan, std::size_t variables) {
  const StudySampling& s = plan.sampling;
  return s.method == SamplingMethod::monte_carlo ? monte_carlo_points(s.samples, variables, s.seed)
                                                 : latin_hypercube_points(s.samples, variables, s.seed);
}

/// All values of the grid; random variables have the value 0.
std::vector<StudyPoint> grid_of(const StudyPlan& plan) {
  std::vector<StudyPoint> points{StudyPoint(plan.variables.size())};
  for (std::size_t j = 0; j < plan.variables.size(); ++j) {
    if (plan.variables[j].random()) continue;
    std::vector<StudyPoint> longer;
    for (const StudyPoint& point : points) {
      for (const StudyValue& value : plan.variables[j].values) longer.emplace_back(point)[j] = value;
    }
    points = std::move(longer);
  }
  return points;
}

/// The largest of each measure, whatever limit its values have.
std::string measure_cells(const assess::RunMeasures& measures) {
  std::string cells;
  for (const MeasureKind* kind : study_measures()) {
    std::optional<double> largest;
    for (const MeasuredValue& value : measures.values) {
      if (value.measure == kind->name) largest = std::max(largest.value_or(value.value), value.value);
    }
    cells += largest ? fmt::format(",{}", *largest) : ",";
  }
  return cells;
}

double cut_off_of(const SceneParameters& scene) {
  double cut_off = assess::RunWindow{}.deck_cut_off;
  if (scene.spans.empty() && scene.structure.files.nodes.empty()) return cut_off;
  for (const ModalDeck& deck : decks_of_scene(scene, DynamicModes{})) {
    cut_off = std::max(cut_off, deck.cut_off());
  }
  return cut_off;
}

/// The vehicles of "a+b*8", a value of train.consist, with their numbers.
std::vector<std::string_view> vehicles_of(std::string_view train) {
  std::vector<std::string_view> vehicles;
  cut(train, '+', vehicles);
  return vehicles;
}

/// Whether a variable may change the natural frequencies of the decks, and with them their cut-off.
bool varies_decks(const StudyPlan& plan) {
  const auto of_deck = [](const StudyKey& key) {
    return key.key.starts_with("bridge.") || key.key.starts_with("structure.") || key.key.starts_with("support.");
  };
  return std::any_of(plan.variables.begin(), plan.variables.end(), [&](const StudyVariable& variable) {
    return std::any_of(variable.keys.begin(), variable.keys.end(), of_deck);
  });
}

/// A value of a variable as TOML writes it in the scene: that of train.consist, "a+b*8", is a list there.
std::string in_scene(const StudyVariable& variable, const StudyKey& key, const StudyValue& value) {
  if (!value.other) {
    const double number = key.as_it_is() ? value.number : key.value(value.number);
    return fmt::format("{}", key.whole && variable.random() ? std::floor(number) : number);
  }
  if (key.key != "train.consist") return *value.other;
  const std::string train = value.cell();
  return fmt::format("[\"{}\"]", fmt::join(vehicles_of(train), "\", \""));
}

/// @throws InputError where no run could have the measure
void require_measure(const StudyPlan& plan, const SceneParameters& scene) {
  const auto begins = [&](auto... of) { return (plan.measure.starts_with(of) || ...); };
  const bool lateral = begins("derailment", "track_shift", "guiding_force", "weinstock");
  if (lateral && scene.contact.normal == NormalContact::rigid) {
    throw input_error(plan.measure_place + ".measure", fmt::format("\"{}\"", plan.measure),
                      fmt::format("one without lateral forces, or a scene with them: {} has contact.normal = \"rigid\"",
                                  plan.scene_file.string()));
  }
  const bool of_deck =
      plan.measure.starts_with("deck_") || plan.measure == "track_twist" || plan.measure == "horizontal_rotation";
  if (!of_deck || !scene.spans.empty() || scene.structure.files.given()) return;
  throw input_error(plan.measure_place + ".measure", fmt::format("\"{}\"", plan.measure),
                    fmt::format("a measure of wheels or car bodies, or a scene with a bridge: {} has none",
                                plan.scene_file.string()));
}

/// A message about a key without the line of the scene: its value stands in the plan.
std::string_view without_scene_line(std::string_view message, const std::string& scene_file) {
  if (!message.starts_with(scene_file + ":")) return message;
  return message.substr(message.find(": ", scene_file.size()) + 2);
}

/// Whether a message is of a key: "KEY: found", "KEY[2]: found" or "unknown key 'KEY'".
bool is_of_key(std::string_view message, const std::string& key) {
  constexpr std::string_view unknown = "unknown key '";
  if (message.starts_with(unknown)) return message.substr(unknown.size()).starts_with(key + "'");
  return message.starts_with(key + ":") || message.starts_with(key + "[");
}

/// With the variable whose key the message is of, and its line of the plan; none where several may be meant.
InputError with_plan_line(const InputError& wrong, const StudyPlan& plan) {
  const std::string message = wrong.what();
  if (message.starts_with(plan.file.string() + ":")) return wrong;
  const std::string rest(without_scene_line(message, plan.scene_file.string()));
  std::vector<std::string> named;
  for (const StudyVariable& variable : plan.variables) {
    for (const StudyKey& key : variable.keys) {
      const std::string place = fmt::format("{}.{}", variable.place, key.key);
      for (const std::string& written : {key.key, without_number(key.key)}) {
        if (!is_of_key(rest, written)) continue;
        named.push_back(place + (rest.starts_with(written) ? rest.substr(written.size()) : ": " + rest));
        break;
      }
    }
  }
  if (named.size() == 1) return InputError(named.front());
  return InputError(fmt::format("{}: {}", plan.file.string(), named.empty() ? message : rest));
}

}  // namespace

std::vector<StudyPoint> planned_points(const StudyPlan& plan) {
  const std::vector<StudyPoint> grid = grid_of(plan);
  if (plan.sampling.samples == 0) return grid;
  std::vector<std::size_t> random;
  for (std::size_t j = 0; j < plan.variables.size(); ++j) {
    if (plan.variables[j].random()) random.push_back(j);
  }
  const UnitPoints samples = unit_points(plan, random.size());
  std::vector<StudyPoint> points;
  for (const StudyPoint& of_grid : grid) {
    for (const std::vector<double>& sample : samples) {
      StudyPoint& point = points.emplace_back(of_grid);
      for (std::size_t k = 0; k < random.size(); ++k) {
        point[random[k]] = sampled(plan.variables[random[k]], {sample[k], 1.0 - sample[k]});
      }
    }
  }
  return points;
}

StudyPoint point_at(const StudyPlan& plan, const std::vector<Probability>& probabilities) {
  StudyPoint point;
  for (std::size_t j = 0; j < plan.variables.size(); ++j) {
    point.push_back(sampled(plan.variables[j], probabilities[j]));
  }
  return point;
}

const std::vector<const MeasureKind*>& study_measures() {
  static const std::vector<const MeasureKind*> measures = [] {
    std::vector<const MeasureKind*> list;
    for (const MeasureKind& kind : measure_kinds()) {
      if (std::count(kind.stages.begin(), kind.stages.end(), AssessmentStage::contact) > 0) list.push_back(&kind);
    }
    return list;
  }();
  return measures;
}

StudyRuns::StudyRuns(const StudyPlan& plan, const SceneParameters& scene, StudyRunsOptions options)
    : plan_(plan), scene_(scene), options_(std::move(options)) {
  if (plan.deck_cut_off) {
    deck_cut_off_ = plan.deck_cut_off;
  } else if (!varies_decks(plan)) {
    deck_cut_off_ = cut_off_of(scene);
  }
}

void StudyRuns::bind_folder() const {
  std::vector<fs::path> files = scene_.files;
  for (const StudyVariable& variable : plan_.variables) {  // a vehicle of a file, say
    for (const StudyValue& value : variable.values) {
      if (!value.other) continue;
      const std::string cell = value.cell();
      for (const std::string_view vehicle : vehicles_of(cell)) {
        const std::string_view name = vehicle.substr(0, vehicle.find('*'));
        const fs::path named = plan_.scene_file.parent_path() / name.substr(name.starts_with('-') ? 1 : 0);
        if (is_file(named)) files.push_back(named);
      }
    }
  }
  const std::string cut_off =
      deck_cut_off_ ? fmt::format("{} Hz", *deck_cut_off_) : std::string("the cut-off of each run's decks");
  check_same_scene(
      plan_.scene_file,
      scene_.text + "\n# vsi study: decks judged at all their nodes, acceleration low-passed at " + cut_off, files,
      options_.folder);
}

std::vector<KeyChange> StudyRuns::changes_of(const StudyPoint& point) const {
  std::vector<KeyChange> changes;
  for (std::size_t j = 0; j < point.size(); ++j) {
    for (const StudyKey& key : plan_.variables[j].keys) {
      if (key.key == "train.speed") changes.push_back({"train.speed_kmh", ""});
      if (key.key == "train.speed_kmh") changes.push_back({"train.speed", ""});
      if (key.key == "train.consist") changes.insert(changes.end(), {{"train.vehicle", ""}, {"train.count", ""}});
      changes.push_back({key.key, in_scene(plan_.variables[j], key, point[j])});
    }
  }
  return changes;
}

RunRow StudyRuns::row_of(const StudyPoint& point) const {
  std::string cells, content;
  for (const StudyValue& value : point) cells += value.cell() + ",";
  for (const KeyChange& change : changes_of(point)) content += fmt::format("{}={}\n", change.key, change.value);
  content += cells;
  const std::uint64_t sum = checksum_of_bytes(std::as_bytes(std::span(content)), checksum_seed);
  const std::string name = fmt::format("r{:016x}", sum);
  return {name, fmt::format("{},{}", name, cells)};
}

std::vector<RunRow> StudyRuns::rows_of(const std::vector<StudyPoint>& points) const {
  std::vector<RunRow> runs;
  std::set<std::string> names;
  for (const StudyPoint& point : points) {
    RunRow run = row_of(point);
    if (names.insert(run.name).second) runs.push_back(std::move(run));
  }
  return runs;
}

/// The scene as it was when the study began, with the values of a point.
SceneParameters StudyRuns::changed_scene(const StudyPoint& point) const {
  SceneParameters scene = read_scene(plan_.scene_file, changes_of(point));
  if (!scene.text.starts_with(scene_.text)) {
    throw input_error(plan_.scene_file.string(), "another scene than when the study began", "the same scene");
  }
  for (std::size_t j = 0; j < point.size(); ++j) {
    scene.name += fmt::format(", {} = {}", plan_.variables[j].name, point[j].cell());
  }
  return scene;
}

/// A run asks twice, for its scene and for its row: frequencies of an imported bridge take their time.
double StudyRuns::cut_off_at(const StudyPoint& point) const {
  if (deck_cut_off_) return *deck_cut_off_;
  const std::string name = name_of(point);
  if (last_cut_off_.first != name) last_cut_off_ = {name, cut_off_of(changed_scene(point))};
  return last_cut_off_.second;
}

/// With what is judged recorded.
SceneParameters StudyRuns::scene_of(const StudyPoint& point) const {
  SceneParameters scene = changed_scene(point);
  record_what_is_judged(scene);
  scene.text += "# vsi study: what is judged is recorded";
  const double cut_off = cut_off_at(point);
  if (follow_deck(scene, cut_off)) scene.text += fmt::format(", output.deck_cut_off = {}", cut_off);
  scene.text += "\n";
  return scene;
}

void StudyRuns::check(const std::vector<StudyPoint>& points) const {
  for (const StudyPoint& point : points) {
    try {
      SceneParameters scene = changed_scene(point);
      record_what_is_judged(scene);
      require_measure(plan_, scene);
    } catch (const InputError& wrong) {
      throw with_plan_line(wrong, plan_);
    }
  }
}

void StudyRuns::tidy(const std::vector<StudyPoint>& points) const {
  std::vector<RunRow> runs;
  for (const StudyPoint& point : points) runs.push_back(row_of(point));
  remove_abandoned_runs(runs,
                        {"scene.toml", "runs.csv", "study.h5", "study.json", "probability.csv", "fragility.csv",
                         "subset.csv", "importance.csv", "threshold.csv"},
                        options_.folder);
}

RunPool StudyRuns::pool(const std::function<void(double)>& progress) const {
  return {plan_.scene_file,
          options_.folder,
          {"vsi study", options_.quiet, progress, plan_.keep_results ? PooledResults::kept : PooledResults::removed}};
}

PooledRun StudyRuns::pooled_at(const StudyPoint& point) const {
  const RunRow row = row_of(point);
  const auto text = [this, row, point](const report::Headline& headline, const RunSummary& summary,
                                       const fs::path& results) {
    assess::RunWindow window = judged_window(scene_of(point));
    window.deck_cut_off = cut_off_at(point);
    const assess::RunMeasures measures = assess::run_measures(read_results(results), window);
    return fmt::format("{}{}{},{:.6g},{}\n", row.begin, summary.complete ? 1 : 0, measure_cells(measures),
                       headline.simulated_time, summary.complete ? "" : message_cell(summary.message));
  };
  const auto scene = [this, point] {
    try {
      return scene_of(point);
    } catch (const InputError& wrong) {
      throw with_plan_line(wrong, plan_);
    }
  };
  return {row.name, scene, text};
}

int StudyRuns::make(const std::vector<StudyPoint>& points, const std::function<void(double)>& progress) {
  const double all = static_cast<double>(points.size());
  double before = 0.0;
  RunPool runs = pool([&](double share) {
    if (progress) progress(before + (1.0 - before) * share);
  });
  std::vector<PooledRun> missing;
  std::set<std::string> names;
  for (const StudyPoint& point : points) {
    PooledRun run = pooled_at(point);
    const bool there = !plan_.keep_results && runs.finished(run.name) && !fs::exists(runs.file(run.name, ".h5"));
    if (!there && names.insert(run.name).second) missing.push_back(std::move(run));
  }
  before = all > 0.0 ? 1.0 - static_cast<double>(missing.size()) / all : 0.0;
  return runs.run(missing, options_.processes);
}

std::vector<StudyRow> StudyRuns::rows(const std::vector<StudyPoint>& points,
                                      const std::function<void(double)>& progress) {
  const int code = make(points, progress);
  if (code > exit_code::failed) throw StudyStopped{code};
  std::vector<StudyRow> rows;
  for (const StudyPoint& point : points) {
    std::optional<StudyRow> row = find_row(point);
    if (!row) {
      throw ComputationError(
          fmt::format("run {} is not finished, see above; the same command goes on from what is", name_of(point)));
    }
    rows.push_back(std::move(*row));
  }
  return rows;
}

std::string StudyRuns::columns() const {
  std::string text = "run";
  for (const StudyVariable& variable : plan_.variables) text += fmt::format(",{}[{}]", variable.name, variable.unit);
  text += ",complete";
  for (const MeasureKind* kind : study_measures()) text += fmt::format(",{}[{}]", kind->name, kind->unit);
  return text + ",simulated_time[s],message\n";
}

RunCount StudyRuns::table(const std::vector<StudyPoint>& points, std::string& rows) const {
  return count_rows(pool({}), rows_of(points), columns(), rows);
}

std::vector<std::string> StudyRuns::warnings(const std::vector<StudyPoint>& points) const {
  return warnings_of_runs(pool({}), rows_of(points));
}

std::optional<StudyRow> StudyRuns::find_row(const StudyPoint& point) const {
  const RunRow run = row_of(point);
  const RunPool runs = pool({});
  if (!runs.finished(run.name)) return std::nullopt;
  const std::string text = read_row(runs, run, columns());
  std::vector<std::string_view> cells;
  const std::string_view behind = std::string_view(text).substr(run.begin.size());
  cut(behind.substr(0, behind.size() - 1), ',', cells);
  StudyRow row;
  row.complete = cells.front() == "1";
  for (std::size_t k = 0; k < study_measures().size(); ++k) row.measures.push_back(parse_number(cells[1 + k]));
  row.simulated_time = parse_number(cells[cells.size() - 2]).value_or(0.0);
  row.message = std::string(cells.back());
  return row;
}

}  // namespace railtab::vsi
