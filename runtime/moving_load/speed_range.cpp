#include "railtab/runtime/moving_load/speed_range.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "railtab/runtime/moving_load/speed_search.hpp"
#include "railtab/runtime/moving_load/work_sharing.hpp"

namespace railtab {
namespace {

const PassagePeaks& largest(const std::vector<PassagePeaks>& passages, DeckPeak PassagePeaks::*quantity) {
  return *std::max_element(passages.begin(), passages.end(), [quantity](const auto& a, const auto& b) {
    return (a.*quantity).value < (b.*quantity).value;
  });
}

}  // namespace

const PassagePeaks& TrainResponse::critical_acceleration() const {
  return largest(passages, &PassagePeaks::acceleration);
}
const PassagePeaks& TrainResponse::critical_displacement() const {
  return largest(passages, &PassagePeaks::displacement);
}

std::vector<TrainResponse> train_responses(const ModalDeck& deck, const std::vector<AxleTrain>& trains,
                                           const SpeedRange& range, int threads,
                                           const std::function<void(double)>& finished) {
  std::vector<TrainResponse> responses(trains.size());
  std::vector<ModalForce> forces(trains.size());  // made by a train's first passage, freed by its last
  std::vector<std::once_flag> made(trains.size());
  std::mutex reporting;
  std::size_t done = 0;
  const bool refined = range.speeds.empty();
  const std::size_t passages = refined ? 1 : range.speeds.size(), count = trains.size() * (passages + 1);
  std::vector<std::atomic<std::size_t>> left(trains.size());  // passages of each train
  for (std::atomic<std::size_t>& of_train : left) of_train = passages;
  const auto report = [&] {
    const std::lock_guard lock(reporting);
    ++done;
    if (finished) finished(static_cast<double>(done) / static_cast<double>(count));
  };
  share_work(trains.size(), threads, [&](std::size_t t) {
    responses[t].train = t;
    responses[t].standing = largest_static_deflection(deck, trains[t]);
    if (!trains[t].only_static && !refined) {
      responses[t].passages.resize(passages);
    }
    report();
  });
  share_work(trains.size() * passages, threads, [&](std::size_t task) {
    const std::size_t t = task / passages, i = task % passages;
    if (!trains[t].only_static) {
      if (refined) {
        responses[t].passages = search_critical_speeds(deck, trains[t], range.low, range.high);
      } else {
        std::call_once(made[t], [&] { forces[t] = modal_force(deck, trains[t]); });
        responses[t].passages[i] = train_passage(deck, forces[t], range.speeds[i]);
        if (--left[t] == 0) forces[t] = {};
      }
    }
    report();
  });
  return responses;
}

}  // namespace railtab
