#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/moving_load/speed_range.hpp"

namespace railtab::vsi {

/// What `vsi moving-load` has computed for one deck.
struct DeckResponse {
  ModalDeck deck;
  std::vector<AxleTrain> trains;
  std::vector<TrainResponse> responses;  ///< in the order of the trains
};

/// The trains of the library: axles, reach, sum of loads and sources.
void print_trains(bool json);

void print_responses(const std::vector<DeckResponse>& responses, double seconds);
void print_responses_as_json(const std::vector<DeckResponse>& responses, double seconds);

/// The CSV: names of its columns, and with them all rows.
[[nodiscard]] std::string response_columns();
[[nodiscard]] std::string response_rows(const std::vector<DeckResponse>& responses);

}  // namespace railtab::vsi
