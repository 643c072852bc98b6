#include "study_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/version.hpp"
#include "railtab/tables/files/array_file.hpp"

namespace railtab::vsi {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* json_mark = "{\n \"study\"";
constexpr int study_format_version = 1;

/// Name of the table of a method, and its first line; none of StudyMethod::table and peak.
struct MethodTable {
  const char* file;
  std::string columns, rows;
};

std::string exceedance_columns(const StudyPlan& plan) {
  std::string text;
  for (const StudyVariable& v : plan.variables) {
    const bool shown = plan.method == StudyMethod::fragility ? &v == &plan.variables[plan.intensity] : !v.random();
    if (shown) text += fmt::format("{}[{}],", v.name, v.unit);
  }
  return text + "runs,exceeded,ended_early,probability[-],probability_low[-],probability_high[-]";
}

std::string exceedance_cells(const StudyPlan& plan, const ExceedanceCount& e) {
  std::string text;
  for (std::size_t j = 0; j < plan.variables.size(); ++j) {
    const bool shown = plan.method == StudyMethod::fragility ? j == plan.intensity : !plan.variables[j].random();
    if (shown) text += e.point[j].cell() + ",";
  }
  return text + fmt::format("{},{},{},{:.8g},{:.8g},{:.8g}", e.runs, e.exceeded, e.ended_early, e.probability.value,
                            e.probability.low, e.probability.high);
}

MethodTable exceedance_table(const StudyPlan& plan, const StudyResult& result) {
  MethodTable table{"probability.csv", exceedance_columns(plan), ""};
  const bool curve = plan.method == StudyMethod::fragility;
  if (curve) {
    table.file = "fragility.csv";
    table.columns += ",curve[-],curve_low[-],curve_high[-]";
  }
  for (std::size_t i = 0; i < result.exceedance.size(); ++i) {
    const ExceedanceCount& e = result.exceedance[i];
    table.rows += exceedance_cells(plan, e);
    if (curve && result.fragility->curve) {
      table.rows += fmt::format(",{:.8g}", result.fragility->curve->probability(e.point[plan.intensity].number));
      const auto& bounds = result.fragility->at_levels;
      table.rows += bounds.empty() ? ",," : fmt::format(",{:.8g},{:.8g}", bounds[i].low, bounds[i].high);
    } else if (curve) {
      table.rows += ",,,";
    }
    table.rows += "\n";
  }
  return table;
}

std::string_view unit_of_measure(const StudyPlan& plan) {
  const auto& all = study_measures();
  return (*std::find_if(all.begin(), all.end(), [&](const auto* kind) { return kind->name == plan.measure; }))->unit;
}

MethodTable threshold_table(const StudyPlan& plan, const StudyResult& result) {
  const StudyVariable& along = plan.variables[plan.intensity];
  MethodTable table{"threshold.csv", "", ""};
  const auto others = [&](const auto& add) {
    for (std::size_t j = 0; j < plan.variables.size(); ++j) {
      if (j != plan.intensity) add(j);
    }
  };
  others(
      [&](std::size_t j) { table.columns += fmt::format("{}[{}],", plan.variables[j].name, plan.variables[j].unit); });
  table.columns += fmt::format("{0}[{1}],{0}_below[{1}],{0}_reached[{1}],{2}_below[{3}],{2}_reached[{3}]", along.name,
                               along.unit, plan.measure, unit_of_measure(plan));
  const auto cell = [](std::optional<double> value) {
    return value && std::isfinite(*value) ? fmt::format("{:.8g}", *value) : std::string();
  };
  for (const StudyThreshold& t : result.thresholds) {
    others([&](std::size_t j) { table.rows += t.point[j].cell() + ","; });
    const auto value = [](const auto& place) { return place ? std::optional(place->value) : std::nullopt; };
    const auto response = [](const auto& place) { return place ? std::optional(place->response) : std::nullopt; };
    table.rows += fmt::format("{},{},{},{},{}\n", cell(t.crossing(plan.limit)), cell(value(t.below)),
                              cell(value(t.reached)), cell(response(t.below)), cell(response(t.reached)));
  }
  return table;
}

MethodTable method_table(const StudyPlan& plan, const StudyResult& result) {
  MethodTable table{nullptr, "", ""};
  switch (plan.method) {
    case StudyMethod::probability:
    case StudyMethod::fragility:
      table = exceedance_table(plan, result);
      break;
    case StudyMethod::subset:
      table = {"subset.csv", "level,threshold,probability[-],variation[-],correlation[-],acceptance[-],runs", ""};
      if (!result.subset) break;
      for (std::size_t i = 0; i < result.subset->levels.size(); ++i) {
        const SubsetLevel& l = result.subset->levels[i];
        table.rows += fmt::format("{},{:.8g},{:.8g},{:.4g},{:.4g},{:.4g},{}\n", i + 1, l.threshold, l.probability,
                                  l.variation, l.correlation, l.acceptance, l.evaluations);
      }
      break;
    case StudyMethod::importance:
      table = {"importance.csv", "variable,first[-],first_low[-],first_high[-],total[-],total_low[-],total_high[-]",
               ""};
      if (!result.importance) break;
      for (std::size_t j = 0; j < plan.variables.size(); ++j) {
        const ConfidenceInterval &f = result.importance->first[j], &t = result.importance->total[j];
        table.rows += fmt::format("{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", plan.variables[j].name, f.value,
                                  f.low, f.high, t.value, t.low, t.high);
      }
      break;
    case StudyMethod::threshold:
      table = threshold_table(plan, result);
      break;
    case StudyMethod::table:
    case StudyMethod::peak:
      break;
  }
  table.columns += "\n";
  return table;
}

std::string unit_of_file(const std::string& unit) { return unit == "-" ? "1" : unit; }

void write_variable(const StudyReport& report, std::size_t j, ArrayFileWriter& file) {
  const StudyVariable& v = report.plan.variables[j];
  const std::string path = "variables/" + v.name;
  if (!v.numeric()) {
    std::vector<std::string> texts;
    for (const StudyPoint& point : report.points) texts.push_back(point[j].cell());
    file.write(path, texts, "value of each run");
    return;
  }
  std::vector<double> values;
  for (const StudyPoint& point : report.points) values.push_back(point[j].number);
  file.write(path, values, {values.size()}, unit_of_file(v.unit), "value of each run");
}

void write_arrays(const StudyReport& report, const fs::path& name) {
  ArrayFileWriter file(name, study_filetype, study_format_version);
  file.attribute("", "plan", std::string_view(report.plan.text));
  file.attribute("", "scene", std::string_view(report.scene_text));
  file.attribute("", "program_version", std::string_view(version()));
  if (const std::optional<double> cut_off = report.runs.deck_cut_off()) file.attribute("", "deck_cut_off", *cut_off);
  for (std::size_t j = 0; j < report.plan.variables.size(); ++j) write_variable(report, j, file);
  for (std::size_t k = 0; k < study_measures().size(); ++k) {
    const MeasureKind& kind = *study_measures()[k];
    std::vector<double> values;
    for (const StudyRow& row : report.rows) {
      values.push_back(row.measures[k].value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    file.write(fmt::format("measures/{}", kind.name), values, {values.size()}, unit_of_file(std::string(kind.unit)),
               fmt::format("{}; NaN: the run has none", kind.meaning));
  }
  std::vector<double> complete, time;
  std::vector<std::string> messages;
  for (const StudyRow& row : report.rows) {
    complete.push_back(row.complete ? 1.0 : 0.0);
    time.push_back(row.simulated_time);
    messages.push_back(row.message);
  }
  file.write("runs/name", report.names, "of each run");
  file.write("runs/complete", complete, {complete.size()}, "1", "1: came to its end, 0: ended early");
  file.write("runs/simulated_time", time, {time.size()}, "s", "time of the last record");
  file.write("runs/message", messages, "why a run ended early");
  file.close();
}

Json interval_json(const ConfidenceInterval& interval) {
  return {{"value", interval.value}, {"low", interval.low}, {"high", interval.high}};
}

// A limit that the first level reaches is a matter of its independent samples alone.
ConfidenceInterval subset_interval(const StudyPlan& plan, const SubsetResult& subset) {
  if (subset.outcome == SubsetOutcome::found && subset.levels.size() == 1) {
    const std::size_t samples = subset.levels.front().evaluations;
    const auto beyond = std::lround(subset.probability * static_cast<double>(samples));
    return wilson_interval(static_cast<std::size_t>(beyond), samples, plan.confidence);
  }
  return lognormal_interval(subset.probability, subset.variation, plan.confidence);
}

const char* subset_outcome(SubsetOutcome outcome) {
  if (outcome == SubsetOutcome::found) return "found";
  return outcome == SubsetOutcome::stalled ? "stalled" : "too rare";
}

Json probability_json(const StudyPlan& plan, const StudyResult& result) {
  Json json{{"measure", plan.measure}, {"limit", plan.limit}, {"confidence", plan.confidence}};
  if (result.subset) {
    const SubsetResult& s = *result.subset;
    json["method"] = "subset";
    json["outcome"] = subset_outcome(s.outcome);
    json["probability"] = interval_json(subset_interval(plan, s));
    json["variation"] = s.variation;
    json["evaluations"] = s.evaluations;
    return json;
  }
  json["method"] = result.fragility ? "fragility" : "monte-carlo";
  Json counts = Json::array();
  for (const ExceedanceCount& e : result.exceedance) {
    Json entry;
    for (std::size_t j = 0; j < e.point.size(); ++j) {
      const bool shown = result.fragility ? j == plan.intensity : !plan.variables[j].random();
      if (!shown) continue;
      entry[plan.variables[j].name] = e.point[j].other ? Json(e.point[j].cell()) : Json(e.point[j].number);
    }
    entry.update({{"runs", e.runs}, {"exceeded", e.exceeded}, {"ended_early", e.ended_early}});
    entry["probability"] = interval_json(e.probability);
    counts.push_back(entry);
  }
  json["levels"] = counts;
  if (!result.fragility) return json;
  json["intensity"] = plan.variables[plan.intensity].name;
  const FragilityFit& f = *result.fragility;
  json["replicates"] = f.replicates;
  if (f.curve && !f.at_levels.empty()) {
    json["median"] = interval_json(f.median);
    json["deviation"] = interval_json(f.deviation);
  } else if (f.curve) {
    json["median"] = {{"value", f.curve->median}};
    json["deviation"] = {{"value", f.curve->deviation}};
  }
  return json;
}

Json importance_json(const StudyPlan& plan, const SobolIndices& indices) {
  Json json{{"measure", plan.measure}, {"mean", indices.mean}, {"variance", indices.variance}};
  for (std::size_t j = 0; j < plan.variables.size(); ++j) {
    json["variables"][plan.variables[j].name] = {{"first", interval_json(indices.first[j])},
                                                 {"total", interval_json(indices.total[j])}};
  }
  return json;
}

/// Extremes of a measure over the complete runs, and its mean over their points.
struct MeasureSpread {
  std::size_t count = 0, greatest_at = 0;
  double least = INFINITY, greatest = -INFINITY, mean = 0.0;
};

/// Searches choose their points by the values: a mean of these says nothing.
bool has_means(StudyMethod method) {
  return method != StudyMethod::subset && method != StudyMethod::peak && method != StudyMethod::threshold;
}

MeasureSpread spread_of(const StudyReport& report, std::size_t measure) {
  MeasureSpread s;
  double points = 0.0;
  for (std::size_t i = 0; i < report.rows.size(); ++i) {
    const std::optional<double> value = report.rows[i].measures[measure];
    if (!report.rows[i].complete || !value) continue;
    ++s.count;
    points += report.weights[i];
    s.mean += (*value - s.mean) * report.weights[i] / points;
    s.least = std::min(s.least, *value);
    if (*value > s.greatest) {
      s.greatest = *value;
      s.greatest_at = i;
    }
  }
  return s;
}

std::string point_text(const StudyPlan& plan, const StudyPoint& point) {
  std::string text;
  for (std::size_t j = 0; j < point.size(); ++j) {
    const std::string cell = point[j].other ? point[j].cell() : fmt::format("{:.6g}", point[j].number);
    text += fmt::format("{}{} = {}", j == 0 ? "" : ", ", plan.variables[j].name, cell);
  }
  return text;
}

std::string exceedance_text(const StudyPlan& plan, const StudyResult& result) {
  std::string text = fmt::format("{} >= {}, {:g} % confidence:\n", plan.measure, plan.limit, 100.0 * plan.confidence);
  for (const ExceedanceCount& e : result.exceedance) {
    std::string at;
    for (std::size_t j = 0; j < e.point.size(); ++j) {
      const bool shown = result.fragility ? j == plan.intensity : !plan.variables[j].random();
      if (shown) at += fmt::format("{} = {}: ", plan.variables[j].name, e.point[j].cell());
    }
    text += fmt::format("  {}{} of {} runs, probability {:.4g} ({:.4g} to {:.4g})\n", at, e.exceeded, e.runs,
                        e.probability.value, e.probability.low, e.probability.high);
  }
  if (!result.fragility) return text;
  const FragilityFit& f = *result.fragility;
  const std::string unit = plan.variables[plan.intensity].unit;
  if (!f.curve) {
    const auto no_run = [&](auto of) { return std::none_of(result.exceedance.begin(), result.exceedance.end(), of); };
    const bool none = no_run([](const ExceedanceCount& e) { return e.exceeded > 0; });
    const bool all = no_run([](const ExceedanceCount& e) { return e.exceeded < e.runs; });
    std::vector<FragilityLevel> levels;
    for (const ExceedanceCount& e : result.exceedance) {
      levels.push_back({e.point[plan.intensity].number, e.runs, e.exceeded});
    }
    if (levels_overlap(levels)) {
      return text + "  no fragility curve: exceedances do not grow with the intensity\n";
    }
    return text + fmt::format("  no fragility curve: the likelihood has no finite maximum; {}\n",
                              none  ? "no run exceeds the limit: higher intensities, or a lower limit"
                              : all ? "every run exceeds the limit: lower intensities, or a higher limit"
                                    : "runs at intensities between those without and those with nothing but "
                                      "exceedances are missing");
  }
  text += fmt::format("  lognormal curve: median {:.5g} {}, logarithmic deviation {:.4g}\n", f.curve->median, unit,
                      f.curve->deviation);
  if (f.at_levels.empty()) {
    return text + "  no bounds: there is one sample alone, or too few replicates of the bootstrap have a curve\n";
  }
  return text + fmt::format("  bounds: median {:.5g} to {:.5g} {}, deviation {:.4g} to {:.4g} ({} replicates)\n",
                            f.median.low, f.median.high, unit, f.deviation.low, f.deviation.high, f.replicates);
}

std::string subset_text(const StudyPlan& plan, const SubsetResult& subset) {
  const ConfidenceInterval p = subset_interval(plan, subset);
  std::string text = fmt::format(
      "{} >= {}: probability {:.4g} ({:.3g} to {:.3g} at {:g} % confidence), coefficient of variation "
      "{:.3g}, {} levels, {} runs asked for\n",
      plan.measure, plan.limit, p.value, p.low, p.high, 100.0 * plan.confidence, subset.variation, subset.levels.size(),
      subset.evaluations);
  if (subset.outcome == SubsetOutcome::too_rare) {
    text += "  the limit was not reached: this is the probability of the last level; most_levels allows more\n";
  }
  if (subset.outcome == SubsetOutcome::stalled) {
    text += "  all runs of a level have the same value: no level can follow, the probability is at most this\n";
  }
  constexpr double few = 20.0;
  if (const double chains = plan.level_probability * static_cast<double>(plan.sampling.samples);
      subset.levels.size() > 1 && chains < few) {
    text += fmt::format(
        "  only {:.0f} chains per level: they may miss a region beyond the limit, of which the interval knows nothing; "
        "take {:.0f} samples or more, and compare seeds\n",
        chains, few / plan.level_probability);
  }
  return text;
}

std::string importance_text(const StudyPlan& plan, const SobolIndices& indices) {
  std::string text = fmt::format("{}: mean {:.5g}, variance {:.5g}; shares of the variance, {:g} % confidence:\n",
                                 plan.measure, indices.mean, indices.variance, 100.0 * plan.confidence);
  for (std::size_t j = 0; j < plan.variables.size(); ++j) {
    const ConfidenceInterval &f = indices.first[j], &t = indices.total[j];
    text += fmt::format("  {}: first {:.3f} ({:.3f} to {:.3f}), total {:.3f} ({:.3f} to {:.3f})\n",
                        plan.variables[j].name, f.value, f.low, f.high, t.value, t.low, t.high);
  }
  const auto is_no_share = [](const ConfidenceInterval& index) { return index.value < 0.0 || index.value > 1.0; };
  if (std::ranges::any_of(indices.first, is_no_share) || std::ranges::any_of(indices.total, is_no_share)) {
    text += fmt::format(
        "  shares below 0 or above 1 are errors of sampling: {} samples are too few; four times as many halve the "
        "intervals in brackets\n",
        plan.sampling.samples);
  }
  return text;
}

/// "train.speed_kmh = 200, " of all variables but that of the threshold.
std::string others_text(const StudyPlan& plan, const StudyPoint& point) {
  std::string text;
  for (std::size_t j = 0; j < point.size(); ++j) {
    if (j != plan.intensity) text += fmt::format("{} = {}: ", plan.variables[j].name, point[j].cell());
  }
  return text;
}

std::string threshold_text(const StudyPlan& plan, const StudyResult& result) {
  const StudyVariable& along = plan.variables[plan.intensity];
  std::string text = fmt::format("{} >= {}:\n", plan.measure, plan.limit);
  for (const StudyThreshold& t : result.thresholds) {
    text += "  " + others_text(plan, t.point);
    if (!t.reached) {
      text += fmt::format("not reached up to {} = {} {}\n", along.name, t.below->value, along.unit);
    } else if (!t.below) {
      text += fmt::format("reached from the first value, {} = {} {}\n", along.name, t.reached->value, along.unit);
    } else if (const std::optional<double> crossing = t.crossing(plan.limit)) {
      text += fmt::format("{} = {:.5g} {}\n", along.name, *crossing, along.unit);
    } else {
      text += fmt::format("between {} = {} and {} {}, where the run ends early\n", along.name, t.below->value,
                          t.reached->value, along.unit);
    }
  }
  return text;
}

Json threshold_json(const StudyPlan& plan, const StudyResult& result) {
  Json json{{"measure", plan.measure}, {"limit", plan.limit}, {"variable", plan.variables[plan.intensity].name}};
  Json places = Json::array();
  for (const StudyThreshold& t : result.thresholds) {
    Json entry = Json::object();
    for (std::size_t j = 0; j < t.point.size(); ++j) {
      if (j != plan.intensity)
        entry[plan.variables[j].name] = t.point[j].other ? Json(t.point[j].cell()) : Json(t.point[j].number);
    }
    if (const std::optional<double> crossing = t.crossing(plan.limit)) entry["value"] = *crossing;
    if (t.below) entry["below"] = t.below->value;
    if (t.reached) entry["reached"] = t.reached->value;
    if (t.reached) entry["ended_early"] = !std::isfinite(t.reached->response);
    places.push_back(entry);
  }
  json["thresholds"] = places;
  return json;
}

/// Why a search has not come to one step.
std::string unresolved_text(const StudyPlan& plan, const PeakSearch& peak) {
  if (peak.resolved) return "";
  return fmt::format("; not resolved to one step: {}",
                     peak.values.size() > plan.variables.front().values.size() / 4
                         ? "the points that it begins with are more than a quarter of the grid"
                         : "a quarter of the grid is used up");
}

/// The least point whose run ended early.
std::optional<std::size_t> first_early_end(const PeakSearch& peak) {
  for (const auto& [point, value] : peak.values) {
    if (!std::isfinite(value)) return point;
  }
  return std::nullopt;
}

std::string peak_text(const StudyPlan& plan, const PeakSearch& peak) {
  const StudyVariable& v = plan.variables.front();
  if (const std::optional<std::size_t> first = first_early_end(peak)) {
    const bool all = std::none_of(peak.values.find(*first), peak.values.end(),
                                  [](const auto& p) { return std::isfinite(p.second); });
    return fmt::format("{}: runs end early {} {} = {}{}{}: no largest value\n", plan.measure, all ? "from" : "at",
                       v.name, v.values[*first].cell(), v.unit == "-" ? "" : " " + v.unit,
                       all ? " on, as far as computed" : ", but not at every higher value computed");
  }
  return fmt::format("largest {}: {:.6g} at {} = {} {}, {} of {} points of the grid{}\n", plan.measure,
                     peak.values.at(peak.highest), v.name, v.values[peak.highest].cell(), v.unit == "-" ? "" : v.unit,
                     peak.values.size(), v.values.size(), unresolved_text(plan, peak));
}

Json peak_json(const StudyPlan& plan, const PeakSearch& peak) {
  const StudyVariable& v = plan.variables.front();
  const std::optional<std::size_t> early = first_early_end(peak);
  Json json{{"measure", plan.measure}, {v.name, v.values[early.value_or(peak.highest)].number}};
  if (!early) json["value"] = peak.values.at(peak.highest);
  json.update({{"ended_early", early.has_value()},
               {"points", peak.values.size()},
               {"grid", v.values.size()},
               {"resolved", peak.resolved}});
  return json;
}

}  // namespace

void require_study_places(const StudyPlan& plan, const StudyRuns& runs, const fs::path& folder) {
  require_replaceable_text(folder / "runs.csv", runs.columns());
  require_replaceable_text(folder / "study.json", json_mark);
  require_replaceable(folder / "study.h5", {study_filetype});
  const MethodTable table = method_table(plan, {});
  if (table.file) require_replaceable_text(folder / table.file, table.columns);
}

void write_study(const StudyReport& report, const std::string& run_rows, const fs::path& folder) {
  write_text_file(folder / "runs.csv", report.runs.columns() + run_rows, report.runs.columns());
  write_arrays(report, folder / "study.h5");
  const MethodTable table = method_table(report.plan, report.result);
  if (table.file) write_text_file(folder / table.file, table.columns + table.rows, table.columns);
  write_text_file(folder / "study.json",
                  study_json(report).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n", json_mark);
}

Json study_json(const StudyReport& report) {
  Json json{{"study", report.plan.file.filename().string()},
            {"scene", report.scene_name},
            {"version", version()},
            {"runs", report.count.finished},
            {"ended_early", report.count.ended_early}};
  if (const std::optional<double> cut_off = report.runs.deck_cut_off()) json["deck_cut_off"] = *cut_off;
  Json measures = Json::object();
  for (std::size_t k = 0; k < study_measures().size(); ++k) {
    const MeasureSpread s = spread_of(report, k);
    if (s.count == 0) continue;
    Json& measure = measures[std::string(study_measures()[k]->name)];
    measure = {{"unit", study_measures()[k]->unit}, {"runs", s.count}, {"least", s.least}};
    if (has_means(report.plan.method)) measure["mean"] = s.mean;
    measure.update({{"greatest", s.greatest}, {"greatest_run", report.names[s.greatest_at]}});
  }
  json["measures"] = measures;
  const StudyResult& result = report.result;
  if (result.subset || !result.exceedance.empty()) json["probability"] = probability_json(report.plan, result);
  if (!result.thresholds.empty()) json["threshold"] = threshold_json(report.plan, result);
  if (result.importance) json["importance"] = importance_json(report.plan, *result.importance);
  if (result.peak) json["peak"] = peak_json(report.plan, *result.peak);
  return json;
}

std::string study_text(const StudyReport& report) {
  std::string text;
  for (std::size_t k = 0; k < study_measures().size(); ++k) {
    const MeasureSpread s = spread_of(report, k);
    if (s.count == 0) continue;
    const MeasureKind& kind = *study_measures()[k];
    const std::string mean = has_means(report.plan.method) ? fmt::format(", mean {:>10.4g}", s.mean) : "";
    text += fmt::format("{:28} {:>10.4g} to {:>10.4g}{} {}; largest at {}\n", kind.name, s.least, s.greatest, mean,
                        kind.unit == "-" ? "" : kind.unit, point_text(report.plan, report.points[s.greatest_at]));
  }
  const StudyResult& result = report.result;
  if (result.subset) text += subset_text(report.plan, *result.subset);
  if (!result.exceedance.empty()) text += exceedance_text(report.plan, result);
  if (result.importance) text += importance_text(report.plan, *result.importance);
  if (!result.thresholds.empty()) text += threshold_text(report.plan, result);
  if (result.peak) text += peak_text(report.plan, *result.peak);
  return text;
}

}  // namespace railtab::vsi
