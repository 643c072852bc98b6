#include "moving_load_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "command/json_text.hpp"
#include "command/print.hpp"

namespace railtab::vsi {
namespace {

using Json = nlohmann::ordered_json;

/// Whether a largest value lies at an end of the speeds, where a larger one may follow. One speed has no range.
bool is_at_end(const TrainResponse& response, const PassagePeaks& passage) {
  const std::vector<PassagePeaks>& all = response.passages;
  return all.size() > 1 && (passage.speed == all.front().speed || passage.speed == all.back().speed);
}

/// A train of a deck and its passage at which a quantity is largest.
struct Critical {
  const AxleTrain* train = nullptr;
  const PassagePeaks* passage = nullptr;
  bool at_end = false;  ///< of the speeds
};

Critical critical(const DeckResponse& deck, bool acceleration) {
  Critical best;
  double largest = -1.0;
  for (const TrainResponse& response : deck.responses) {
    if (response.passages.empty()) continue;
    const PassagePeaks& passage = acceleration ? response.critical_acceleration() : response.critical_displacement();
    const double value = acceleration ? passage.acceleration.value : passage.displacement.value;
    if (!(value > largest)) continue;
    largest = value;
    best = {&deck.trains[response.train], &passage, is_at_end(response, passage)};
  }
  return best;
}

bool any_at_end(const DeckResponse& deck) {
  return std::any_of(deck.responses.begin(), deck.responses.end(), [](const TrainResponse& r) {
    return !r.passages.empty() && (is_at_end(r, r.critical_acceleration()) || is_at_end(r, r.critical_displacement()));
  });
}

std::vector<double> frequencies(const ModalDeck& deck) {
  std::vector<double> hertz;
  for (int n = 0; n < deck.dynamic_modes; ++n) hertz.push_back(deck.frequency(n));
  return hertz;
}

void print_deck(const DeckResponse& deck) {
  const ModalDeck& d = deck.deck;
  print_formatted("{}: {:.6g} m from x = {:.6g} m\n", d.name, d.length(), d.start);
  for (int n = 0; n < d.dynamic_modes; ++n) {
    print_formatted("  {:3}. {:10.6f} Hz, damping {:.3f} %\n", n + 1, d.frequency(n), 100.0 * d.damping[n]);
  }
  print_formatted("  {} higher modes add to displacements as a static correction\n", d.modes() - d.dynamic_modes);
  print_formatted("  {:16} {:>10} {:>10} {:>8} {:>7} {:>8} {:>10} {:>8} {:>7} {:>8} {:>7}\n", "train", "static mm",
                  "a m/s2", "km/h", "x m", "t s", "w mm", "km/h", "x m", "t s", "w/stat");
  for (const TrainResponse& response : deck.responses) {
    const double standing = response.standing.value;
    print_formatted("  {:16} {:10.4f}", deck.trains[response.train].name, 1e3 * standing);
    if (!response.passages.empty()) {
      const PassagePeaks& a = response.critical_acceleration();
      const PassagePeaks& w = response.critical_displacement();
      print_formatted(" {:10.4f} {:8.2f}{} {:6.2f} {:8.3f} {:10.4f} {:8.2f}{} {:6.2f} {:8.3f} {:7.3f}",
                      a.acceleration.value, 3.6 * a.speed, is_at_end(response, a) ? '*' : ' ', a.acceleration.x,
                      a.acceleration.time, 1e3 * w.displacement.value, 3.6 * w.speed,
                      is_at_end(response, w) ? '*' : ' ', w.displacement.x, w.displacement.time,
                      w.displacement.value / standing);
    }
    print_formatted("\n");
  }
  if (any_at_end(deck)) print_formatted("  *: at an end of the speeds; a wider range may have a larger value\n");
}

Json peak_as_json(const DeckPeak& peak, double speed, bool at_end) {
  return {{"value", peak.value}, {"speed", speed}, {"x", peak.x}, {"time", peak.time}, {"at_end_of_speeds", at_end}};
}

Json train_as_json(const AxleTrain& train) {
  return {{"name", train.name},
          {"axles", train.behind.size()},
          {"reach", train.reach()},
          {"total_load", train.total_load()},
          {"only_static", train.only_static},
          {"standing", standing_name(train.provenance.standing)},
          {"source", train.provenance.source}};
}

Json response_as_json(const AxleTrain& train, const TrainResponse& response) {
  Json json = train_as_json(train);
  json["static_displacement"] = {
      {"value", response.standing.value}, {"x", response.standing.x}, {"front", response.standing.front}};
  if (response.passages.empty()) return json;
  const PassagePeaks& a = response.critical_acceleration();
  const PassagePeaks& w = response.critical_displacement();
  json["acceleration"] = peak_as_json(a.acceleration, a.speed, is_at_end(response, a));
  json["displacement"] = peak_as_json(w.displacement, w.speed, is_at_end(response, w));
  json["dynamic_amplification"] = w.displacement.value / response.standing.value;
  Json passages = Json::array();
  for (const PassagePeaks& p : response.passages) {
    passages.push_back(
        {{"speed", p.speed}, {"acceleration", p.acceleration.value}, {"displacement", p.displacement.value}});
  }
  json["passages"] = std::move(passages);
  return json;
}

std::size_t count_passages(const std::vector<DeckResponse>& responses) {
  std::size_t count = 0;
  for (const DeckResponse& deck : responses) {
    for (const TrainResponse& response : deck.responses) count += response.passages.size();
  }
  return count;
}

/// A name as a cell of a CSV: file names may have what separates cells and rows.
std::string cell(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ',' || c == '"' || static_cast<unsigned char>(c) < ' '; },
      '_');
  return name;
}

}  // namespace

void print_trains(bool json) {
  constexpr double deck_length = 25.0;  // to which unlimited line loads are cut here [m]
  Json trains = Json::array();
  for (const std::string& name : train_names()) {
    const AxleTrain train = find_axle_train(name, deck_length);
    if (json) {
      trains.push_back(train_as_json(train));
    } else if (train.only_static) {
      print_formatted("{:12} static load model, {}\n", name, standing_name(train.provenance.standing));
    } else {
      print_formatted("{:12} {:3} axles on {:8.3f} m, {:7.1f} kN, {}\n", name, train.behind.size(), train.reach(),
                      1e-3 * train.total_load(), standing_name(train.provenance.standing));
    }
  }
  if (json) print_json_line({{"trains", trains}});
}

void print_responses(const std::vector<DeckResponse>& responses, double seconds) {
  for (const DeckResponse& deck : responses) {
    print_deck(deck);
    const Critical a = critical(deck, true), w = critical(deck, false);
    if (!a.train) continue;
    print_formatted("  largest acceleration {:.4f} m/s2: {} at {:.2f} km/h, x = {:.2f} m\n",
                    a.passage->acceleration.value, a.train->name, 3.6 * a.passage->speed, a.passage->acceleration.x);
    print_formatted("  largest displacement {:.4f} mm: {} at {:.2f} km/h, x = {:.2f} m\n",
                    1e3 * w.passage->displacement.value, w.train->name, 3.6 * w.passage->speed,
                    w.passage->displacement.x);
  }
  const std::size_t passages = count_passages(responses);
  print_formatted("{} passage{} in {:.2f} s\n", passages, passages == 1 ? "" : "s", seconds);
}

void print_responses_as_json(const std::vector<DeckResponse>& responses, double seconds) {
  Json decks = Json::array();
  for (const DeckResponse& deck : responses) {
    Json trains = Json::array();
    for (const TrainResponse& response : deck.responses) {
      trains.push_back(response_as_json(deck.trains[response.train], response));
    }
    Json json{{"name", deck.deck.name},
              {"length", deck.deck.length()},
              {"start", deck.deck.start},
              {"frequencies", frequencies(deck.deck)},
              {"damping_ratios",
               std::vector<double>(deck.deck.damping.data(), deck.deck.damping.data() + deck.deck.dynamic_modes)},
              {"trains", trains}};
    const Critical a = critical(deck, true), w = critical(deck, false);
    if (a.train) {
      json["acceleration"] = peak_as_json(a.passage->acceleration, a.passage->speed, a.at_end);
      json["acceleration"]["train"] = a.train->name;
      json["displacement"] = peak_as_json(w.passage->displacement, w.passage->speed, w.at_end);
      json["displacement"]["train"] = w.train->name;
    }
    decks.push_back(std::move(json));
  }
  print_json_line({{"decks", decks}, {"passages", count_passages(responses)}, {"seconds", seconds}});
}

std::string response_columns() {
  return "deck,train,speed[m/s],speed[km/h],max_deck_acceleration[m/s2],acceleration_x[m],acceleration_time[s],"
         "max_deck_displacement[m],displacement_x[m],displacement_time[s],static_displacement[m],"
         "dynamic_amplification[-]\n";
}

std::string response_rows(const std::vector<DeckResponse>& responses) {
  std::string text = response_columns();
  const auto out = std::back_inserter(text);
  for (const DeckResponse& deck : responses) {
    for (const TrainResponse& response : deck.responses) {
      const std::string name = cell(deck.deck.name), train = cell(deck.trains[response.train].name);
      const double standing = response.standing.value;
      if (response.passages.empty()) fmt::format_to(out, "{},{},,,,,,,,,{:.8g},\n", name, train, standing);
      for (const PassagePeaks& p : response.passages) {
        fmt::format_to(out, "{},{},{:.8g},{:.8g},{:.8g},{:.6g},{:.6g},{:.8g},{:.6g},{:.6g},{:.8g},{:.6g}\n", name,
                       train, p.speed, 3.6 * p.speed, p.acceleration.value, p.acceleration.x, p.acceleration.time,
                       p.displacement.value, p.displacement.x, p.displacement.time, standing,
                       p.displacement.value / standing);
      }
    }
  }
  return text;
}

}  // namespace railtab::vsi
