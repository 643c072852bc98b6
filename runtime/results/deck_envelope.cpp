#include "railtab/runtime/results/deck_envelope.hpp"

#include <algorithm>
#include <string>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/vsi/support_motion.hpp"

namespace railtab {
namespace {

std::size_t displacements(const DeckChannels& deck) {
  return static_cast<std::size_t>(std::ranges::count(deck.channel, DeckQuantity::displacement, &DeckChannel::quantity));
}

}  // namespace

DeckEnvelope::DeckEnvelope(const VsiModel& model, double cut_off, double step)
    : model_(model),
      step_(step),
      value_extremes_(deck().channel.size()),
      raw_(displacements(deck())),
      filtered_(raw_.size()),
      low_pass_(raw_.size(), cut_off, step) {
  const std::vector<DeckChannel>& channels = deck().channel;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (c == 0 || channels[c].quantity != channels[c - 1].quantity) groups_.push_back({channels[c].quantity, c, 0});
    ++groups_.back().count;
  }
  const auto nodes = std::ranges::find(groups_, DeckQuantity::displacement, &Group::quantity);
  if (nodes != groups_.end()) nodes_ = *nodes;
  const auto& rows = deck().rows;
  unknowns_.assign(rows.innerIndexPtr(), rows.innerIndexPtr() + rows.nonZeros());
  std::ranges::sort(unknowns_);
  unknowns_.erase(std::unique(unknowns_.begin(), unknowns_.end()), unknowns_.end());
  node_rows_ = deck().rows.middleRows(static_cast<Eigen::Index>(nodes_.first), static_cast<Eigen::Index>(nodes_.count));
}

std::vector<DeckPlaces> DeckEnvelope::places() const {
  std::vector<DeckPlaces> all;
  const auto add_places = [&](std::string_view quantity, std::string_view unit, const Group& group) {
    DeckPlaces& places = all.emplace_back(DeckPlaces{std::string(quantity), std::string(unit)});
    for (std::size_t c = group.first; c < group.first + group.count; ++c) {
      places.x.push_back(deck().channel[c].x);
      places.y.push_back(deck().channel[c].y);
    }
  };
  for (const Group& group : groups_) add_places(quantity_name(group.quantity), quantity_unit(group.quantity), group);
  if (nodes_.count > 0) {
    add_places("acceleration", "m/s^2", nodes_);
    add_places("filtered_acceleration", "m/s^2", nodes_);
  }
  return all;
}

void DeckEnvelope::add(const VsiState& state) {
  const LinearMotion& motion = state.structure.at(unknowns_);
  values_.noalias() = deck().rows * motion.displacement;
  acceleration_.noalias() = node_rows_ * motion.acceleration;
  const StructureSupports& supports = model_.structure->supports;
  if (model_.ground_motion && supports.carried_deck.size() > 0) {
    const SupportMotion ground = support_motion(*model_.ground_motion, supports.x, state.time);
    values_ += supports.carried_deck * ground.displacement;
    const Eigen::VectorXd carried = supports.carried_deck * ground.acceleration;
    acceleration_ += carried.segment(static_cast<Eigen::Index>(nodes_.first), static_cast<Eigen::Index>(nodes_.count));
  }
  const auto span_of = [](const Eigen::VectorXd& v) {
    return std::span<const double>(v.data(), static_cast<std::size_t>(v.size()));
  };
  value_extremes_.add(samples_, span_of(values_));
  raw_.add(samples_, span_of(acceleration_));
  low_pass_.add(span_of(acceleration_),
                [this](long sample, std::span<const double> filtered) { filtered_.add(sample, filtered); });
  ++samples_;
}

DeckExtremes DeckEnvelope::extremes(const RunningExtremes& of, const Group& group) const {
  const auto part = [&](const std::vector<double>& values, double factor) {
    std::vector<double> result(values.begin() + static_cast<std::ptrdiff_t>(group.first),
                               values.begin() + static_cast<std::ptrdiff_t>(group.first + group.count));
    for (double& value : result) value *= factor;
    return result;
  };
  return {part(of.smallest(), 1.0), part(of.smallest_at(), step_), part(of.largest(), 1.0),
          part(of.largest_at(), step_)};
}

std::vector<DeckExtremes> DeckEnvelope::finish() {
  low_pass_.finish([this](long sample, std::span<const double> filtered) { filtered_.add(sample, filtered); });
  std::vector<DeckExtremes> all;
  if (samples_ == 0) return all;
  for (const Group& group : groups_) all.push_back(extremes(value_extremes_, group));
  if (nodes_.count > 0) {
    const Group whole{DeckQuantity::displacement, 0, nodes_.count};
    all.push_back(extremes(raw_, whole));
    all.push_back(extremes(filtered_, whole));
  }
  return all;
}

void DeckEnvelope::pack(std::vector<double>& numbers) const {
  const std::size_t before = numbers.size();
  numbers.push_back(static_cast<double>(samples_));
  for (const RunningExtremes* extremes : {&value_extremes_, &raw_, &filtered_}) extremes->pack(numbers);
  low_pass_.pack(numbers);
  numbers.push_back(static_cast<double>(numbers.size() - before));
}

std::size_t packed_envelope(std::span<const double> numbers) {
  const double count = numbers.empty() ? -1.0 : numbers.back();
  if (!(count >= 0.0 && count < static_cast<double>(numbers.size()))) {
    throw InputError("a checkpoint without the deck's envelope: run the scene anew");
  }
  return static_cast<std::size_t>(count) + 1;
}

void DeckEnvelope::unpack(std::span<const double> numbers) {
  samples_ = static_cast<long>(numbers.front());
  numbers = numbers.subspan(1);
  for (RunningExtremes* extremes : {&value_extremes_, &raw_, &filtered_}) extremes->unpack(numbers);
  low_pass_.unpack(numbers);
}

std::size_t DeckEnvelope::capacity() const noexcept {
  return 5 + 4 * (value_extremes_.size() + 2 * raw_.size()) + low_pass_.capacity();
}

}  // namespace railtab
