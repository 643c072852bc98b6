#include "railtab/runtime/drawing/drawn_records.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace railtab {

void DrawnRecords::add(const StepRecord& record) {
  const std::size_t index = seen_++;
  last_ = record;
  if (index % spacing_ != 0) return;
  if (kept_.size() == static_cast<std::size_t>(most_)) {  // every second one
    for (std::size_t i = 0; 2 * i < kept_.size(); ++i) std::swap(kept_[i], kept_[2 * i]);
    kept_.resize((kept_.size() + 1) / 2);
    spacing_ *= 2;
    if (index % spacing_ != 0) return;
  }
  kept_.push_back(record);
}

std::vector<StepRecord> DrawnRecords::take() {
  if (seen_ > 0 && (seen_ - 1) % spacing_ != 0) kept_.push_back(std::move(last_));
  return std::move(kept_);
}

double DrawnRecords::count(double records, int most) noexcept {
  double spacing = 1.0;
  while (std::ceil(records / spacing) > most) spacing *= 2.0;
  return std::min(records, std::ceil(records / spacing) + 1.0);
}

}  // namespace railtab
