#include "batch_list.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "geometry_options.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/vehicle/toml_kind.hpp"
#include "railtab/runtime/vehicle/toml_section.hpp"

namespace railtab {

namespace po = boost::program_options;

namespace {

/// Text of an option and where it was said.
struct Setting {
  std::string text;
  unsigned line = 0;
};
using Settings = std::map<std::string, Setting, std::less<>>;

std::vector<std::string> option_names() {
  const po::options_description described = geometry_options();
  std::vector<std::string> names;
  for (const auto& option : described.options()) {
    // a pair of a list is always a whole table
    if (option->long_name() != "shard") names.push_back(option->long_name());
  }
  return names;
}

/// "pairs.toml:12"
std::string place(const std::filesystem::path& file, unsigned line) {
  return fmt::format("{}:{}", file.string(), line);
}

/// As it would stand on the command line. @throws InputError
std::string option_text(const toml::node& node, const std::string& where) {
  if (const toml::value<std::string>* text = node.as_string()) return text->get();
  if (const auto number = node.value<double>(); number && node.is_number()) return fmt::format("{}", *number);
  if (const toml::array* list = node.as_array(); list && list->size() == 2) {
    const auto low = (*list)[0].value<double>(), high = (*list)[1].value<double>();
    if (low && high) return fmt::format("{}:{}", *low, *high);
  }
  std::ostringstream found;
  found << node.type();
  throw input_error(where, "a value of type " + found.str(), "a number, a text, or [low, high]");
}

/// @param settings the defaults, overwritten by what `table` says
void read_settings(const toml::table& table, const std::filesystem::path& file, bool defaults, Settings& settings) {
  static const std::vector<std::string> names = option_names();
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    const std::string where = fmt::format("{}: {}", place(file, key.source().begin.line), name);
    if (std::find(names.begin(), names.end(), name) == names.end() || (defaults && name == "output")) {
      std::string known;
      for (const std::string& n : names) {
        if (!defaults || n != "output") known += (known.empty() ? "" : ", ") + n;
      }
      throw input_error(where, "an unknown key", "one of " + known);
    }
    settings[name] = {option_text(node, where), key.source().begin.line};
  }
}

/// A profile as `tablegen geometry` takes it: files beside the list come first.
std::string profile_of(const Settings& settings, const char* name, const std::filesystem::path& folder) {
  const auto setting = settings.find(name);
  if (setting == settings.end()) return {};
  const std::string& text = setting->second.text;
  return is_file(folder / text) ? (folder / text).string() : text;
}

/// Whether an option acts on a pair's profiles: built-in rails are inclined, files are smoothed.
bool acts_on_pair(std::string_view option, const Settings& settings, const std::filesystem::path& folder) {
  const bool built_in_rail = is_standard_profile(ProfileKind::rail, profile_of(settings, "rail", folder));
  if (option == "rail-inclination") return built_in_rail;
  return !built_in_rail || !is_standard_profile(ProfileKind::wheel, profile_of(settings, "wheel", folder));
}

/// Drops a default from pairs on whose profiles it does not act, if it acts on those of another pair. One that acts on
/// no pair stays, for the checks of `tablegen geometry` to reject, as do those that a pair names itself.
void keep_defaults_that_act(const Settings& defaults, const std::filesystem::path& folder,
                            std::vector<Settings>& pairs) {
  for (const char* option : {"rail-inclination", "smoothing"}) {
    const auto common = defaults.find(option);
    const auto acts = [&](const Settings& pair) { return acts_on_pair(option, pair, folder); };
    if (common == defaults.end() || std::none_of(pairs.begin(), pairs.end(), acts)) continue;
    for (Settings& pair : pairs) {
      if (!acts(pair) && pair.at(option).line == common->second.line) pair.erase(option);
    }
  }
}

BatchPair batch_pair(const Settings& settings, const std::filesystem::path& file, unsigned line) {
  for (const char* needed : {"wheel", "rail", "output"}) {
    if (!settings.contains(needed)) throw input_error(place(file, line), fmt::format("no {}", needed), "one per pair");
  }
  const std::filesystem::path folder = file.parent_path();
  BatchPair pair{place(file, line), folder / settings.at("output").text, {}};
  for (const std::string& name : option_names()) {
    const auto setting = settings.find(name);
    if (setting == settings.end() || name == "output") continue;
    const bool profile = name == "wheel" || name == "rail";
    pair.arguments.push_back(
        fmt::format("--{}={}", name, profile ? profile_of(settings, name.c_str(), folder) : setting->second.text));
  }
  pair.arguments.push_back("--output=" + pair.output.string());
  return pair;
}

/// "1e-8" and "0.00000001" alike; what is no number stays.
std::string shortest(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) return shortest(text.substr(0, colon)) + ":" + shortest(text.substr(colon + 1));
  double value = 0.0;
  return parse(text, value) ? fmt::format("{}", value) : text;
}

}  // namespace

std::vector<BatchPair> read_batch_list(const std::filesystem::path& file) {
  const toml::table root = read_toml(file, "a list of pairs in TOML");
  check_toml_kind(root, file, TomlKind::pair_list);
  Settings defaults;
  const toml::array* list = nullptr;
  for (const auto& [key, node] : root) {
    const std::string where = fmt::format("{}: {}", place(file, key.source().begin.line), key.str());
    if (key.str() == "defaults" && node.is_table()) {
      read_settings(*node.as_table(), file, true, defaults);
    } else if (key.str() == "pair" && node.is_array() && node.as_array()->is_homogeneous(toml::node_type::table)) {
      list = node.as_array();
    } else {
      throw input_error(where, "something else", "[defaults] and one [[pair]] per table");
    }
  }
  if (!list || list->empty()) throw input_error(file.string(), "no [[pair]]", "one [[pair]] per table");
  std::vector<Settings> all;
  for (const toml::node& entry : *list) {
    read_settings(*entry.as_table(), file, false, all.emplace_back(defaults));
  }
  keep_defaults_that_act(defaults, file.parent_path(), all);
  std::vector<BatchPair> pairs;
  std::map<std::filesystem::path, std::string> outputs;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Settings& settings = all[i];
    pairs.push_back(batch_pair(settings, file, list->get(i)->source().begin.line));
    const BatchPair& pair = pairs.back();
    const auto [first, fresh] = outputs.emplace(std::filesystem::absolute(pair.output).lexically_normal(), pair.place);
    if (!fresh) {
      throw input_error(place(file, settings.at("output").line) + ": output", pair.output.string(),
                        fmt::format("another file than that of the pair at {}", first->second));
    }
  }
  return pairs;
}

std::string geometry_options_text(const std::vector<std::string>& arguments) {
  const po::options_description options = geometry_options();
  po::variables_map values;
  po::store(po::command_line_parser(arguments).options(options).allow_unregistered().run(), values);
  std::string text;
  for (const std::string& name : option_names()) {
    const bool of_profiles = name == "wheel" || name == "rail" || name == "smoothing" || name == "rail-inclination";
    if (of_profiles || name == "output" || !values.count(name)) continue;
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, shortest(values[name].as<std::string>()));
  }
  return text;
}

}  // namespace railtab
