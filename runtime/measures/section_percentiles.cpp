#include "railtab/runtime/measures/section_percentiles.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/measures/percentile.hpp"

namespace railtab {
namespace {

constexpr double low_share = 0.0015, high_share = 0.9985;

}  // namespace

SectionPercentiles::SectionPercentiles(double begin, double length, double step) : begin_(begin), step_(step) {
  if (length > 0.0) per_section_ = std::max(2L, std::lround(length / step));
}

void SectionPercentiles::add(double position, double value) {
  const auto next = [&] { return begin_ + step_ * static_cast<double>(place_); };
  if (!any_ && position > next()) {  // the first section of which all is known, or the first place
    place_ = static_cast<long>(std::ceil((position - begin_) / step_));
    if (per_section_ > 0) place_ = (place_ + per_section_ - 1) / per_section_ * per_section_;
  }
  for (; position >= next(); ++place_) {
    const double way = position - last_position_;
    const double share = any_ && way > 0.0 ? (next() - last_position_) / way : 1.0;
    take(any_ ? last_value_ + share * (value - last_value_) : value);
  }
  any_ = true;
  last_position_ = position;
  last_value_ = value;
}

void SectionPercentiles::take(double value) {
  values_.push_back(value);
  if (per_section_ == 0 || static_cast<long>(values_.size()) < per_section_) return;
  const double to = begin_ + step_ * static_cast<double>(place_ + 1);
  full_.push_back({to - step_ * static_cast<double>(per_section_), to, percentile(values_, low_share),
                   percentile(values_, high_share)});
  values_.clear();
}

std::vector<SectionRange> SectionPercentiles::sections() const {
  if (per_section_ > 0) return full_;
  if (values_.size() < 2) return {};
  const double to = begin_ + step_ * static_cast<double>(place_ - 1);
  const double from = to - step_ * static_cast<double>(values_.size() - 1);
  return {{from, to, percentile(values_, low_share), percentile(values_, high_share)}};
}

}  // namespace railtab
