#pragma once

#include <span>
#include <vector>

#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {

/// Records of a run that are drawn: every 2^m-th, with the least m that leaves no more than a given number, and the
/// last. Which these are depends on the number of records alone, so that a resumed run draws the same.
class DrawnRecords {
 public:
  /// @param most >= 1
  explicit DrawnRecords(int most) : most_(most) {}
  /// Each record of the run, in order.
  void add(const StepRecord& record);
  /// In order, none twice.
  [[nodiscard]] std::vector<StepRecord> take();

  /// How many there are at most of a run of `records`.
  [[nodiscard]] static double count(double records, int most) noexcept;

 private:
  int most_;
  std::size_t spacing_ = 1, seen_ = 0;
  std::vector<StepRecord> kept_;
  StepRecord last_;
};

}  // namespace railtab
