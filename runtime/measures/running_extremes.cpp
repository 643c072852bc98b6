#include "railtab/runtime/measures/running_extremes.hpp"

#include <cassert>
#include <limits>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

RunningExtremes::RunningExtremes(std::size_t series)
    : smallest_(series, std::numeric_limits<double>::infinity()),
      largest_(series, -std::numeric_limits<double>::infinity()),
      smallest_at_(series, 0.0),
      largest_at_(series, 0.0) {}

void RunningExtremes::add(long sample, std::span<const double> values) {
  assert(values.size() == size());
  const auto at = static_cast<double>(sample);
  samples_ += 1.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < smallest_[i]) {
      smallest_[i] = values[i];
      smallest_at_[i] = at;
    }
    if (values[i] > largest_[i]) {
      largest_[i] = values[i];
      largest_at_[i] = at;
    }
  }
}

void RunningExtremes::pack(std::vector<double>& numbers) const {
  numbers.push_back(samples_);
  for (const auto* values : {&smallest_, &largest_, &smallest_at_, &largest_at_}) {
    numbers.insert(numbers.end(), values->begin(), values->end());
  }
}

void RunningExtremes::unpack(std::span<const double>& numbers) {
  if (numbers.size() < 1 + 4 * size()) throw InputError("a checkpoint whose extremes are not those of this run");
  samples_ = numbers.front();
  numbers = numbers.subspan(1);
  for (auto* values : {&smallest_, &largest_, &smallest_at_, &largest_at_}) {
    values->assign(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(size()));
    numbers = numbers.subspan(values->size());
  }
}

}  // namespace railtab
