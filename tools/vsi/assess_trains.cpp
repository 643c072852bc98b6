#include "assess_trains.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"

namespace railtab::vsi {
namespace {

namespace fs = std::filesystem;
constexpr const char* train_options = "--train, assessment.trains";

/// The vehicles of "a+b*8"; none where one of them is no vehicle.
std::vector<ConsistEntry> vehicles_of(const std::string& name, const fs::path& folder) {
  const std::vector<std::string> known = vehicle_names();
  std::vector<std::string_view> parts;
  cut(name, '+', parts);
  std::vector<ConsistEntry> entries;
  for (const std::string_view part : parts) {
    std::optional<ConsistEntry> entry = parse_consist_entry(part);
    if (!entry) return {};
    const bool file = entry->vehicle.ends_with(".toml");
    if (!file && std::find(known.begin(), known.end(), entry->vehicle) == known.end()) return {};
    if (file) entry->vehicle = (folder / entry->vehicle).string();
    entries.push_back(*std::move(entry));
  }
  return entries;
}

SceneParameters with_train(const SceneParameters& scene, const std::string& name, std::vector<ConsistEntry> entries) {
  SceneParameters result = scene;
  for (const ConsistEntry& entry : entries) {
    if (entry.vehicle.ends_with(".toml")) result.files.emplace_back(entry.vehicle);
  }
  result.train.vehicle = entries.front().vehicle;
  result.train.count = 1;
  result.train.consist = std::move(entries);
  result.name += ", " + name;
  result.text += fmt::format("\n# vsi assess: train \"{}\"", name);
  result.validate();
  return result;
}

/// @throws InputError that names the train, not the line of the scene's own one
AssessTrain train_of_vehicles(const SceneParameters& scene, const std::string& name,
                              std::vector<ConsistEntry> entries) {
  try {
    AssessTrain train{name, {}, with_train(scene, name, std::move(entries)), false};
    train.axles = axle_train_of(*train.scene);
    train.axles.name = name;
    return train;
  } catch (const InputError& wrong) {
    throw InputError(fmt::format("{}: '{}': {}", train_options, name, without_scene(wrong.what())));
  }
}

/// @throws InputError where a train is neither a file nor one of the library
void require_known_axles(const std::string& name) {
  const std::vector<std::string> known = train_names();
  const std::string once = name.substr(0, name.rfind('*'));
  if (name.ends_with(".csv") || std::find(known.begin(), known.end(), once) != known.end()) return;
  throw input_error(train_options, fmt::format("'{}'", name),
                    fmt::format("a vehicle (vsi vehicle lists them) or VEHICLE.toml, several as VEHICLE*N+VEHICLE; "
                                "axle loads AXLES.csv; hslm-a for all ten; or one of {}, of which wagons (en15528-…) "
                                "also as NAME*N",
                                fmt::join(known, ", ")));
}

AssessTrain find_train(const SceneParameters& scene, const std::string& name, const fs::path& folder) {
  if (std::vector<ConsistEntry> entries = vehicles_of(name, folder); !entries.empty()) {
    return train_of_vehicles(scene, name, std::move(entries));
  }
  require_known_axles(name);
  constexpr double any_deck = 1.0;  // static load models alone depend on it
  AssessTrain train{
      name, find_axle_train(name.ends_with(".csv") ? (folder / name).string() : name, any_deck), {}, false};
  train.axles.name = name;
  if (train.axles.only_static) {
    throw input_error(train_options, fmt::format("'{}', a load model at rest", name),
                      "trains that move; stage check takes lm71");
  }
  return train;
}

}  // namespace

std::vector<AssessTrain> assess_trains(const SceneParameters& scene, const std::vector<std::string>& names,
                                       const fs::path& folder) {
  std::vector<AssessTrain> trains;
  for (const std::string& name : expanded_names(names)) {
    const bool known = std::any_of(trains.begin(), trains.end(), [&](const auto& train) { return train.name == name; });
    if (!known) trains.push_back(find_train(scene, name, folder));
  }
  const AxleTrain own = axle_train_of(scene);
  trains.push_back({own.name, own, scene, true});
  return trains;
}

std::vector<GoverningTrain> governing_trains(const std::vector<AssessTrain>& trains,
                                             const std::vector<assess::DeckAssessment>& decks, double highest) {
  std::vector<GoverningTrain> runs;
  for (const AssessTrain& train : trains) {
    if (train.scene) runs.push_back({&train, {}});
  }
  if (runs.size() == 1) return runs;
  for (GoverningTrain& run : runs) run.responses = largest_responses(run.train->axles, decks, highest);
  std::vector<bool> governs(runs.size(), false);
  for (std::size_t d = 0; d < decks.size(); ++d) {
    for (const auto member :
         {&LargestResponse::acceleration, &LargestResponse::displacement, &LargestResponse::end_rotation}) {
      const auto largest =
          std::ranges::max_element(runs, {}, [&](const GoverningTrain& run) { return run.responses[d].*member; }) -
          runs.begin();
      governs[static_cast<std::size_t>(largest)] = true;
    }
  }
  std::vector<GoverningTrain> governing;
  for (std::size_t t = 0; t < runs.size(); ++t) {
    if (governs[t]) governing.push_back(std::move(runs[t]));
  }
  return governing;
}

}  // namespace railtab::vsi
