#include "assess_stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>

#include "over_speed.hpp"
#include "railtab/runtime/moving_load/speed_search.hpp"
#include "railtab/runtime/moving_load/static_deflection.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "scene_decks.hpp"

namespace railtab::vsi {
namespace {

using assess::Assessment;
using assess::DeckAssessment;

/// EN 1991-2 asks for moving loads from 40 m/s on: lines that are hardly faster begin at half their speed.
double lowest_speed(double highest) {
  constexpr double standard = 40.0, hardly = 1.25;
  return highest > hardly * standard ? standard : 0.5 * highest;
}

const BridgeParameters* span_at(const SceneParameters& scene, double start) {
  double at = 0.0;
  for (const BridgeParameters& span : scene.spans) {
    if (std::abs(at - start) < 1e-9 * (1.0 + at)) return &span;
    at += span.length;
  }
  return nullptr;
}

void check_span(const BridgeParameters& span, DeckAssessment& deck, Assessment& assessment) {
  using std::numbers::pi;
  deck.span = span.length;
  deck.lateral_frequency = 0.5 * pi / (span.length * span.length) * std::sqrt(span.E * span.Iz / span.mass);
  const double standing = largest_static_deflection(deck.deck, find_axle_train("lm71", deck.deck.length())).value;
  const auto add = [&](const char* measure, double value) {
    assessment.values.push_back(assess::value_of_deck(deck, measure, AssessmentStage::check, value));
  };
  add("lateral_frequency", *deck.lateral_frequency);
  add("deflection_lm71", dynamic_factor_2(span.length) * standing);
}

/// With the line speed, up to which values are told apart.
std::vector<double> even_speeds(double low, double high, double line_speed) {
  constexpr double step = 2.0 / 3.6;  // 2 km/h
  const int intervals = std::clamp(static_cast<int>(std::ceil((high - low) / step)), 40, 300);
  std::vector<double> speeds;
  for (int i = 0; i <= intervals; ++i) speeds.push_back(low + (high - low) * i / intervals);
  constexpr double alike = 1e-9;
  const auto place = std::ranges::lower_bound(speeds, line_speed * (1.0 - alike));
  if (place == speeds.end() || *place > line_speed * (1.0 + alike)) speeds.insert(place, line_speed);
  return speeds;
}

/// Passages of both lists by speed.
std::vector<PassagePeaks> merged(std::vector<PassagePeaks> a, const std::vector<PassagePeaks>& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::sort(a.begin(), a.end(), [](const auto& x, const auto& y) { return x.speed < y.speed; });
  a.erase(std::unique(a.begin(), a.end(), [](const auto& x, const auto& y) { return x.speed == y.speed; }), a.end());
  return a;
}

LargestResponse largest_response(const AxleTrain& train, const ModalDeck& deck, double highest) {
  LargestResponse largest;
  largest.speed = highest;
  for (const PassagePeaks& p : search_critical_speeds(deck, train, lowest_speed(highest), highest)) {
    if (p.acceleration.value > largest.acceleration) {
      largest.acceleration = p.acceleration.value;
      largest.speed = p.speed;
    }
    largest.displacement = std::max(largest.displacement, p.displacement.value);
    largest.end_rotation = std::max(largest.end_rotation, p.end_rotation.value);
  }
  return largest;
}

}  // namespace

void check_decks(const SceneParameters& scene, Assessment& assessment) {
  for (ModalDeck& modal : decks_of_scene(scene, {})) {
    DeckAssessment& deck = assessment.decks.emplace_back();
    deck.deck = std::move(modal);
    const double first = deck.deck.first_frequency();
    deck.cut_off = deck.deck.cut_off();
    const BridgeParameters* span = scene.structure.files.nodes.empty() ? span_at(scene, deck.deck.start) : nullptr;
    if (span) {
      check_span(*span, deck, assessment);
    } else {
      for (const char* measure : {"deflection_lm71", "lateral_frequency"}) {
        assessment.missing.push_back(
            {measure, AssessmentStage::check, "spans and lateral modes of an imported bridge are not known", false});
      }
    }
    assessment.values.push_back(assess::value_of_deck(deck, "first_frequency", AssessmentStage::check, first));
    deck.need = dynamic_need(assessment.facts.line_speed, deck.span, first, span != nullptr);
  }
}

std::string own_train_name(const TrainParameters& train) {
  std::string vehicles;
  for (const ConsistEntry& entry : train.entries()) {
    const std::filesystem::path vehicle(entry.vehicle);
    fmt::format_to(std::back_inserter(vehicles), "{}{}{}{}", vehicles.empty() ? "" : "+", entry.reversed ? "-" : "",
                   vehicle.extension() == ".toml" ? vehicle.stem().string() : entry.vehicle,
                   entry.count > 1 ? fmt::format("*{}", entry.count) : "");
  }
  return fmt::format("the scene's train ({})", vehicles);
}

AxleTrain axle_train_of(const SceneParameters& scene) {
  const VsiModel model = train_model(scene);
  std::vector<std::pair<double, double>> axles;  // behind, load
  for (int w = 0; w < model.wheelsets(); ++w) {
    axles.emplace_back(model.wheelset_x(0, 0.0) - model.wheelset_x(w, 0.0),
                       2.0 * static_wheel_load(model.vehicle, w % model.wheelsets_per_vehicle()));
  }
  std::sort(axles.begin(), axles.end());
  AxleTrain train;
  train.name = own_train_name(scene.train);
  for (const auto& [behind, load] : axles) {
    train.behind.push_back(behind);
    train.load.push_back(load);
  }
  return train;
}

void run_moving_loads(const std::vector<AxleTrain>& trains, int threads, const std::function<void(double)>& progress,
                      Assessment& assessment) {
  assessment.high_speed = 1.2 * assessment.facts.line_speed;
  assessment.low_speed = lowest_speed(assessment.high_speed);
  const SpeedRange search{assessment.low_speed, assessment.high_speed, {}};
  const SpeedRange grid{search.low, search.high, even_speeds(search.low, search.high, assessment.facts.line_speed)};
  double done = 0.0;
  const double parts = 2.0 * static_cast<double>(assessment.decks.size());
  for (DeckAssessment& deck : assessment.decks) {
    deck.trains = trains;
    const auto show = [&](double share) {
      if (progress) progress((done + share) / parts);
    };
    deck.responses = train_responses(deck.deck, deck.trains, grid, threads, show);
    done += 1.0;
    const std::vector<TrainResponse> critical = train_responses(deck.deck, deck.trains, search, threads, show);
    done += 1.0;
    for (std::size_t t = 0; t < critical.size(); ++t) {
      deck.responses[t].passages = merged(std::move(deck.responses[t].passages), critical[t].passages);
    }
    for (const assess::PassageMeasure& measure : assess::passage_measures) {
      for (MeasuredValue& largest : largest_of_passages(deck, measure)) assessment.values.push_back(std::move(largest));
    }
  }
}

std::vector<LargestResponse> largest_responses(const AxleTrain& train, const std::vector<DeckAssessment>& decks,
                                               double highest) {
  std::vector<LargestResponse> responses;
  for (const DeckAssessment& deck : decks) responses.push_back(largest_response(train, deck.deck, highest));
  return responses;
}

}  // namespace railtab::vsi
