#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/grid_axis.hpp"

namespace railtab {

GridAxis::GridAxis(const std::string& name, std::vector<double> nodes) : nodes_(std::move(nodes)) {
  if (nodes_.empty()) throw input_error(fmt::format("axis {}", name), "no nodes", "at least one node");
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!std::isfinite(nodes_[i]) || (i > 0 && !(nodes_[i] > nodes_[i - 1]))) {
      throw input_error(fmt::format("axis {}, node {}", name, i), fmt::format("{}", nodes_[i]),
                        i > 0 ? fmt::format("a finite number above {}", nodes_[i - 1]) : "a finite number");
    }
  }
  if (size() < 2) return;
  const double step = (nodes_.back() - nodes_.front()) / (size() - 1);
  uniform_ = true;
  for (int i = 0; i < size(); ++i) {
    // Half a step of tolerance would do for locate(), which corrects by one; this only keeps the guess good.
    uniform_ = uniform_ && std::abs(nodes_[i] - (nodes_.front() + i * step)) < 1e-3 * step;
  }
  inverse_step_ = 1.0 / step;
}

GridAxis::Cell GridAxis::locate(double value) const noexcept {
  if (size() == 1) return {0, 0.0, 0.0, std::abs(value - nodes_.front()) <= 1e-12};
  if (!(value >= nodes_.front() && value <= nodes_.back())) return {0, 0.0, 0.0, false};
  const int last = size() - 2;
  int i;
  if (uniform_) {
    i = std::clamp(static_cast<int>((value - nodes_.front()) * inverse_step_), 0, last);
    if (value < nodes_[i]) {
      --i;
    } else if (i < last && value >= nodes_[i + 1]) {
      ++i;
    }
  } else {
    const auto above = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, value);
    i = static_cast<int>(above - nodes_.begin()) - 1;
  }
  const double width = nodes_[i + 1] - nodes_[i];
  return {i, (value - nodes_[i]) / width, width, true};
}

}  // namespace railtab
