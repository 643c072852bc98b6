#include "study_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "railtab/runtime/assessment/measure_kind.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/toml_text.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/toml_leaves.hpp"
#include "railtab/runtime/vehicle/toml_kind.hpp"
#include "railtab/runtime/vehicle/toml_section.hpp"
#include "sweep_plan.hpp"

namespace railtab::vsi {

std::string without_number(const std::string& key) {
  const std::size_t first = key.find('.'), second = key.find('.', first + 1);
  if (first == key.npos || second == key.npos) return key;
  const std::string entry = key.substr(first + 1, second - first - 1);
  const bool number = !entry.empty() && entry.find_first_not_of("0123456789") == entry.npos;
  return number ? key.substr(0, first) + key.substr(second) : key;
}

namespace {

constexpr double any = 1e15, tiny = 1e-12;
constexpr int most_samples = 1000000;

/// "load.1.Fy" of "load.Fy", which is the key of the only [[load]].
std::string with_number(const std::string& key) {
  const std::size_t point = key.find('.');
  if (point == key.npos || !scene::is_list_section(key.substr(0, point)) || without_number(key) != key) return key;
  return key.substr(0, point) + ".1" + key.substr(point);
}

/// The row of the table of keys; null where there is none, which the scene's reader says better.
const SceneKey* known_key(const std::string& key) {
  static const std::vector<SceneKey> keys = scene_keys();
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const SceneKey& known) { return known.path == without_number(key); });
  return found == keys.end() ? nullptr : &*found;
}

/// Of the section's member "key". @throws InputError where no run depends on it
StudyKey study_key(TomlSection& s) {
  const std::string key = s.text("key");
  constexpr std::array of_assessments{"assessment.line_speed_kmh", "assessment.track", "assessment.trains",
                                      "assessment.seeds", "assessment.rules"};
  if (std::find(of_assessments.begin(), of_assessments.end(), key) != of_assessments.end()) {
    throw s.error("key", fmt::format("'{}'", key), "a key that runs of a study depend on");
  }
  const SceneKey* known = known_key(key);
  StudyKey result;
  result.key = key;
  result.whole = known && known->type == "integer";
  return result;
}

/// [[x, key], …] with rising x.
std::vector<std::array<double, 2>> read_table(const TomlSection& set, const toml::node& node) {
  constexpr const char* expected = "two points [[x, value], [x, value]] at least, x rising";
  const toml::array* list = node.as_array();
  if (!list || list->size() < 2) throw set.error("table", found_text(node), expected);
  std::vector<std::array<double, 2>> points;
  for (const toml::node& entry : *list) {
    const toml::array* point = entry.as_array();
    std::optional<double> x, y;
    if (point && point->size() == 2) {
      x = point->get(0)->value<double>();
      y = point->get(1)->value<double>();
    }
    const bool valid = x && y && std::abs(*x) < any && std::abs(*y) < any;
    if (!valid || (!points.empty() && !(*x > points.back()[0]))) {
      throw set.error("table", found_text(entry) + " in the list", expected);
    }
    points.push_back({*x, *y});
  }
  return points;
}

/// A [[vary.set]]: a key by a formula or a table of the variable.
StudyKey read_set(TomlSection& set, const toml::table& table) {
  constexpr NumberKind factor{"", -1e12, 1e12}, power{"", -10.0, 10.0}, offset{"", -any, any};
  StudyKey key = study_key(set);
  if (set.has("table")) {
    for (const char* other : {"factor", "power", "offset"}) {
      if (set.has(other)) throw set.error(other, "a table too", "a table, or factor, power and offset");
    }
    key.table = read_table(set, *table.get("table"));
  } else {
    key.factor = set.number("factor", factor, 1.0);
    key.power = set.number("power", power, 1.0);
    key.offset = set.number("offset", offset, 0.0);
  }
  set.reject_others();
  return key;
}

/// Tables hold for all that the variable takes: there is no value beyond their ends.
void check_tables(const StudyVariable& v, const TomlSection& s) {
  for (const StudyKey& key : v.keys) {
    if (key.table.empty()) continue;
    const double first = key.table.front()[0], last = key.table.back()[0];
    double low = v.random() ? quantile(*v.distribution, Probability{0.0, 1.0}) : v.values.front().number;
    double high = v.random() ? quantile(*v.distribution, Probability{1.0, 0.0}) : low;
    for (const StudyValue& value : v.values) {
      low = std::min(low, value.number);
      high = std::max(high, value.number);
    }
    if (low >= first && high <= last) continue;
    throw s.error(
        "set",
        fmt::format("a table of {} from {:g} to {:g} for values from {:g} to {:g}", key.key, first, last, low, high),
        v.random() ? "a table as far as the distribution, which at_least and at_most cut off"
                   : "a table as far as the values");
  }
}

/// Names of all measures of runs.
std::vector<std::string> measure_names() {
  std::vector<std::string> names;
  for (const MeasureKind& kind : measure_kinds()) {
    if (std::count(kind.stages.begin(), kind.stages.end(), AssessmentStage::contact) > 0) names.emplace_back(kind.name);
  }
  return names;
}

/// The table of the runs has a column of each name once.
void check_column(const StudyVariable& v, const TomlSection& s) {
  std::vector<std::string> taken = measure_names();
  taken.insert(taken.end(), {"run", "complete", "simulated_time", "message"});
  if (std::find(taken.begin(), taken.end(), v.name) == taken.end()) return;
  throw s.error("name", fmt::format("\"{}\"", v.name), "another name: runs.csv has a column of this one");
}

std::string unit_of(const StudyKey& key) {
  const SceneKey* known = known_key(key.key);
  return !known || known->unit.empty() || known->unit == "1" ? "-" : known->unit;
}

StudyValue value_of(const toml::node& node, const TomlSection& s) {
  constexpr const char* expected = "numbers, texts without comma, quote or line break, or truth values";
  if (const auto* text = node.as_string()) {
    if (text->get().empty() || text->get().find_first_of(",\"'\\\n\r") != std::string::npos) {
      throw s.error("values", found_text(node), expected);
    }
    return {0.0, fmt::format("\"{}\"", text->get())};
  }
  if (const auto* flag = node.as_boolean()) return {0.0, flag->get() ? "true" : "false"};
  const std::optional<double> number = node.is_number() ? node.value<double>() : std::nullopt;
  if (!number || !(std::abs(*number) < any)) throw s.error("values", found_text(node), expected);
  return {*number, std::nullopt};
}

std::vector<StudyValue> read_values(const toml::table& table, const TomlSection& s) {
  const toml::array* list = table.get("values")->as_array();
  if (!list || list->empty()) {
    throw s.error("values", list ? "an empty list" : found_text(*table.get("values")), "a list, [0.1, 0.2, 0.3]");
  }
  std::vector<StudyValue> values;
  std::set<std::string> cells;
  for (const toml::node& node : *list) {
    values.push_back(value_of(node, s));
    if (values.back().other.has_value() != values.front().other.has_value()) {
      throw s.error("values", found_text(node) + " among others", "numbers alone, or texts and truth values alone");
    }
    if (!cells.insert(values.back().cell()).second) throw s.error("values", found_text(node) + " twice", "each once");
  }
  return values;
}

std::vector<StudyValue> read_range(TomlSection& s) {
  const std::string text = s.text("range");
  try {
    std::vector<StudyValue> values;
    for (const double number : values_of_range("range", text)) values.push_back({number, std::nullopt});
    return values;
  } catch (const InputError&) {
    throw s.error("range", fmt::format("the text \"{}\"", text),
                  "\"LO:HI:STEP\", three numbers, LO <= HI and STEP > 0, at most 100000 values");
  }
}

/// Mean and `std`, the standard deviation, or `cov`, which is that over the mean.
std::pair<double, double> moments_of(TomlSection& s, double least_mean) {
  const double mean = s.number("mean", {"", least_mean, any});
  if (s.has("std") == s.has("cov"))
    throw s.error("std", s.has("std") ? "std and cov" : "neither std nor cov", "one of them");
  if (s.has("std")) return {mean, s.number("std", {"", tiny, any})};
  return {mean, std::abs(mean) * s.number("cov", {"", tiny, 10.0})};
}

Distribution read_distribution(TomlSection& s) {
  using enum DistributionKind;
  const std::string kind = s.text_of("distribution", {"normal", "lognormal", "uniform", "weibull", "gumbel"});
  if (kind == "uniform") {
    const double low = s.number("low", {"", -any, any}), high = s.number("high", {"", -any, any});
    if (!(low < high)) throw s.error("high", fmt::format("{}", high), fmt::format("more than low = {}", low));
    return {uniform, low, high};
  }
  if (kind == "weibull") return {weibull, s.number("scale", {"", tiny, any}), s.number("shape", {"", 0.05, 1000.0})};
  if (kind == "gumbel" && s.has("mode"))
    return {gumbel, s.number("mode", {"", -any, any}), s.number("scale", {"", tiny, any})};
  if (kind == "lognormal" && s.has("median")) {
    return {lognormal, s.number("median", {"", tiny, any}), s.number("log_std", {"", tiny, 10.0})};
  }
  const auto [mean, deviation] = moments_of(s, kind == "lognormal" ? tiny : -any);
  if (!(deviation > 0.0)) throw s.error("cov", "a mean of 0", "std");
  if (kind == "lognormal") return lognormal_of_moments(mean, deviation);
  return kind == "gumbel" ? gumbel_of_moments(mean, deviation) : Distribution{normal, mean, deviation};
}

/// at_least and at_most cut a distribution off.
Distribution read_bounded(TomlSection& s) {
  Distribution d = read_distribution(s);
  const Distribution whole = d;
  if (s.has("at_least")) d.low = s.number("at_least", {"", -any, any});
  if (s.has("at_most")) d.high = s.number("at_most", {"", -any, any});
  if (!(d.low < d.high)) {
    throw s.error("at_most", fmt::format("{}", d.high), fmt::format("more than at_least = {}", d.low));
  }
  const double between = probability(whole, d.high).below - probability(whole, d.low).below;
  constexpr double least = 1e-6;
  if (!(between > least)) {
    throw s.error(s.has("at_most") ? "at_most" : "at_least",
                  fmt::format("a probability of {:.3g} between the bounds", between),
                  fmt::format("bounds with more than {} between them", least));
  }
  return d;
}

StudyVariable read_variable(TomlSection& s, const toml::table& table) {
  StudyVariable v;
  v.place = s.place();
  if (s.has("key") == s.has("set")) {
    throw s.error("key", s.has("key") ? "key and set" : "neither key nor set",
                  "key = \"SECTION.KEY\", or [[vary.set]] with a key and factor, power, offset or a table, and a name "
                  "for the variable");
  }
  if (s.has("key")) v.keys.push_back(study_key(s));
  std::vector<TomlSection> sets = s.sections("set");
  for (std::size_t i = 0; i < sets.size(); ++i) {
    v.keys.push_back(read_set(sets[i], *table.get("set")->as_array()->get(i)->as_table()));
  }
  v.name = s.has("name") ? s.text("name") : v.keys.front().key;
  v.unit = s.has("unit") ? s.text("unit") : s.has("key") ? unit_of(v.keys.front()) : "-";
  if ((v.name + v.unit).find_first_of(",\"'[]\n\r") != std::string::npos || v.name.find('/') != std::string::npos) {
    throw s.error("name", fmt::format("\"{}\" in \"{}\"", v.name, v.unit),
                  "name and unit without comma, quote or bracket, a name without slash");
  }
  check_column(v, s);
  const int ways = s.has("values") + s.has("range") + s.has("distribution");
  if (ways == 0) s.reject_others();  // a slip in one of them
  if (ways != 1) throw s.error("values", fmt::format("{} of values, range, distribution", ways), "one of them");
  if (s.has("values")) v.values = read_values(table, s);
  if (s.has("range")) v.values = read_range(s);
  if (s.has("distribution")) v.distribution = read_bounded(s);
  const bool shaped = std::any_of(v.keys.begin(), v.keys.end(), [](const auto& k) { return !k.as_it_is(); });
  if (shaped && !v.numeric()) throw s.error("values", "texts with a formula or table", "numbers");
  check_tables(v, s);
  s.reject_others();
  return v;
}

std::size_t whole(TomlSection& s, std::string_view key, int low, int high, std::size_t absent) {
  return static_cast<std::size_t>(s.whole_number(key, low, high, static_cast<int>(absent)));
}

void read_sampling(TomlSection& s, StudyPlan& plan) {
  if (s.has("method")) {
    const bool random = s.text_of("method", {"monte-carlo", "latin-hypercube"}) == "monte-carlo";
    plan.sampling.method = random ? SamplingMethod::monte_carlo : SamplingMethod::latin_hypercube;
  }
  if (!s.has("samples")) throw s.error("samples", "nothing", fmt::format("an integer 1 to {}", most_samples));
  plan.sampling.samples = whole(s, "samples", 1, most_samples, 1);
  plan.sampling.seed = whole(s, "seed", 0, 2147483647, 1);
  s.reject_others();
}

void read_measure(TomlSection& s, StudyPlan& plan) {
  plan.measure = s.text_of("measure", measure_names());
  plan.measure_place = s.place();
}

/// The variable with numbers as values that a key names.
std::size_t read_gridded(TomlSection& s, std::string_view key, const StudyPlan& plan) {
  std::vector<std::string> names;
  for (const StudyVariable& v : plan.variables) {
    if (!v.random() && v.numeric()) names.push_back(v.name);
  }
  if (names.empty()) {
    throw s.error(key, "no [[vary]] with values or a range", "the name of one: it is what the study goes along");
  }
  const std::string name = s.text_of(key, names);
  const auto found =
      std::find_if(plan.variables.begin(), plan.variables.end(), [&](const auto& v) { return v.name == name; });
  return static_cast<std::size_t>(found - plan.variables.begin());
}

void read_subset(TomlSection& s, StudyPlan& plan) {
  plan.sampling.samples = whole(s, "samples", 20, 100000, 1000);
  plan.sampling.seed = whole(s, "seed", 0, 2147483647, 1);
  plan.level_probability = s.number("level_probability", {"", 0.05, 0.5}, plan.level_probability);
  plan.most_levels = whole(s, "most_levels", 1, 20, plan.most_levels);
  const double seeds = plan.level_probability * static_cast<double>(plan.sampling.samples);
  const auto chains = static_cast<std::size_t>(std::llround(seeds));
  if (std::abs(seeds - std::round(seeds)) > 1e-9 * seeds || chains < 2 || plan.sampling.samples % chains != 0) {
    throw s.error("samples",
                  fmt::format("{} at a level_probability of {}", plan.sampling.samples, plan.level_probability),
                  "samples · level_probability chains, at least 2, of one whole length");
  }
}

void read_probability(TomlSection& s, StudyPlan& plan) {
  const std::string method = s.text_of("method", {"monte-carlo", "subset", "fragility"});
  plan.method = method == "subset"      ? StudyMethod::subset
                : method == "fragility" ? StudyMethod::fragility
                                        : StudyMethod::probability;
  read_measure(s, plan);
  plan.limit = s.number("limit", {"", -any, any});
  plan.confidence = s.number("confidence", {"", 0.5, 0.9999}, plan.confidence);
  if (plan.method == StudyMethod::subset) read_subset(s, plan);
  if (plan.method == StudyMethod::fragility) {
    plan.intensity = read_gridded(s, "intensity", plan);
    const std::vector<StudyValue>& values = plan.variables[plan.intensity].values;
    const bool positive = std::all_of(values.begin(), values.end(), [](const auto& v) { return v.number > 0.0; });
    if (values.size() < 2 || !positive)
      throw s.error("intensity", "fewer than two values, or one that is not > 0", "at least two values > 0");
    plan.replicates = whole(s, "replicates", 100, 100000, plan.replicates);
  }
  s.reject_others();
}

void read_peak(TomlSection& s, StudyPlan& plan) {
  plan.method = StudyMethod::peak;
  read_measure(s, plan);
  plan.coarse_step = whole(s, "coarse_step", 2, 1000, plan.coarse_step);
  s.reject_others();
}

bool rises(const StudyVariable& variable) {
  const auto falls = [](const StudyValue& a, const StudyValue& b) { return a.number >= b.number; };
  return std::adjacent_find(variable.values.begin(), variable.values.end(), falls) == variable.values.end();
}

void read_threshold(TomlSection& s, StudyPlan& plan) {
  plan.method = StudyMethod::threshold;
  read_measure(s, plan);
  plan.limit = s.number("limit", {"", -any, any});
  plan.intensity = read_gridded(s, "variable", plan);
  if (!rises(plan.variables[plan.intensity])) {
    throw s.error("variable", fmt::format("values of {} that do not rise", plan.variables[plan.intensity].name),
                  "values that rise, from where the limit is not reached");
  }
  s.reject_others();
}

void read_importance(TomlSection& s, StudyPlan& plan) {
  plan.method = StudyMethod::importance;
  read_measure(s, plan);
  if (!s.has("samples"))
    throw s.error("samples", "nothing", "an integer 8 to 100000: runs are samples · (variables + 2)");
  plan.sampling.samples = whole(s, "samples", 8, 100000, 8);
  plan.sampling.seed = whole(s, "seed", 0, 2147483647, 1);
  plan.confidence = s.number("confidence", {"", 0.5, 0.9999}, plan.confidence);
  plan.replicates = whole(s, "replicates", 100, 100000, plan.replicates);
  s.reject_others();
}

/// What a method asks of the variables, and who chooses the samples.
void check_variables(TomlSection& root, const StudyPlan& plan) {
  const auto random =
      std::count_if(plan.variables.begin(), plan.variables.end(), [](const auto& v) { return v.random(); });
  const bool all = random == static_cast<std::ptrdiff_t>(plan.variables.size());
  const bool samples = plan.method == StudyMethod::subset || plan.method == StudyMethod::importance;
  const bool sampled = root.has("sampling");
  if (samples && !all) throw root.error("vary", "a variable with values", "a distribution for each variable");
  if (samples && sampled) throw root.error("sampling", "a section", "samples and seed in the section of the method");
  if (plan.method == StudyMethod::peak && (plan.variables.size() != 1 || all || !plan.variables.front().numeric())) {
    throw root.error("vary", fmt::format("{} variables, {} of them random", plan.variables.size(), random),
                     "one [[vary]] with numbers as values or a range");
  }
  if (plan.method == StudyMethod::peak && !rises(plan.variables.front())) {
    throw input_error(plan.variables.front().place + ".values", "values that do not rise",
                      "values that rise, as [peak] needs them");
  }
  if (plan.method == StudyMethod::threshold && random > 0)
    throw root.error("vary", "a random variable", "variables with values, as [threshold] needs them");
  if (!samples && random > 0 && !sampled)
    throw root.error("sampling", "nothing", "[sampling] with samples, since a variable is random");
  if (!samples && random == 0 && sampled)
    throw root.error("sampling", "a section, and no variable is random", "a [[vary]] with a distribution");
}

void read_variables(TomlSection& root, const toml::table& table, StudyPlan& plan) {
  std::vector<TomlSection> sections = root.sections("vary");
  if (sections.empty()) throw root.error("vary", "nothing", "at least one [[vary]]");
  std::set<std::string> names, keys;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    StudyVariable v = read_variable(sections[i], *table.get("vary")->as_array()->get(i)->as_table());
    if (!names.insert(v.name).second)
      throw sections[i].error("name", fmt::format("\"{}\" twice", v.name), "another name");
    for (const StudyKey& key : v.keys) {
      const std::string one = key.key == "train.speed_kmh" ? "train.speed" : with_number(key.key);
      if (!keys.insert(one).second) {
        throw sections[i].error("key", fmt::format("{} twice", with_number(key.key)), "each key once");
      }
    }
    plan.variables.push_back(std::move(v));
  }
}

}  // namespace

std::string StudyValue::cell() const {
  if (!other) return fmt::format("{}", number);
  return other->starts_with('"') ? other->substr(1, other->size() - 2) : *other;
}

double StudyKey::value(double x) const noexcept {
  if (table.empty()) return factor * std::pow(x, power) + offset;
  std::size_t b = 1;
  while (b + 1 < table.size() && table[b][0] < x) ++b;
  const auto &p = table[b - 1], &q = table[b];
  return p[1] + (q[1] - p[1]) * (x - p[0]) / (q[0] - p[0]);
}

bool StudyVariable::numeric() const noexcept { return random() || !values.front().other; }

namespace {

void check_size(const StudyPlan& plan) {
  constexpr double most = 1e6;
  double points = static_cast<double>(std::max<std::size_t>(plan.sampling.samples, 1));
  for (const StudyVariable& variable : plan.variables) {
    if (!variable.random()) points *= static_cast<double>(variable.values.size());
  }
  if (points <= most) return;
  throw input_error(fmt::format("{}: [[vary]]", plan.file.string()),
                    fmt::format("{:.6g} points of all values together, times sampling.samples", points),
                    fmt::format("at most {:.0f}", most));
}

}  // namespace

StudyPlan read_study_plan(const std::filesystem::path& file) {
  if (file.empty()) throw input_error("plan", "an empty name", "the name of a plan in TOML");
  StudyPlan plan;
  plan.file = file;
  plan.text = read_toml_text(file, "a plan in TOML");
  const toml::table table = parse_toml(plan.text, file);
  check_toml_kind(table, file, TomlKind::study_plan);
  SourcedValues values;
  TomlSection root(file, "", table, {}, values);
  plan.scene_file = file.parent_path() / root.text("scene");
  if (!is_file(plan.scene_file)) {
    std::error_code unreadable;
    const bool none = !std::filesystem::exists(plan.scene_file, unreadable);
    throw root.error("scene",
                     fmt::format("{} {}", none ? "no file" : what_is_at(plan.scene_file), plan.scene_file.string()),
                     "the file of a scene, relative to the plan");
  }
  plan.keep_results = root.flag("keep_results");
  if (root.has("deck_cut_off")) plan.deck_cut_off = root.number("deck_cut_off", {"Hz", 1.0, 1000.0});
  read_variables(root, table, plan);
  int methods = 0;
  const auto method = [&](const char* name, void (*read)(TomlSection&, StudyPlan&)) {
    std::optional<TomlSection> section = root.find_section(name);
    if (!section) return;
    if (++methods > 1)
      throw section->error("", "a second method", "one of [probability], [peak], [threshold], [importance]");
    read(*section, plan);
  };
  method("probability", read_probability);
  method("peak", read_peak);
  method("threshold", read_threshold);
  method("importance", read_importance);
  check_variables(root, plan);
  std::optional<TomlSection> sampling = root.find_section("sampling");
  if (sampling) read_sampling(*sampling, plan);
  check_size(plan);
  root.reject_others();
  return plan;
}

}  // namespace railtab::vsi
