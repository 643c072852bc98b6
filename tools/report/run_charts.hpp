#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "railtab/runtime/report/chart.hpp"
#include "railtab/runtime/report/history_store.hpp"
#include "railtab/runtime/results/result_file.hpp"

namespace railtab::report {

/// Charts of one run, or of several laid over each other, as HTML. Wheel quantities stand over the wheel's own position
/// along the track, bodies and deck over time. A chart is empty where no run has its quantity. All channels go to the
/// store; shown are at first both wheels of the first and of the last wheelset, and the nodes or bodies that move most.
class RunCharts {
 public:
  /// @param names of the runs, put before the names of their channels where there are several
  RunCharts(std::span<const RunResults> runs, std::vector<std::string> names);

  [[nodiscard]] std::string running_safety();
  [[nodiscard]] std::string wheel_forces();
  [[nodiscard]] std::string car_bodies();
  [[nodiscard]] std::string structure();
  [[nodiscard]] const HistoryStore& histories() const noexcept { return store_; }

 private:
  struct Linear {
    double factor, shift;
  };
  using Values = std::function<double(const StepRecord&)>;

  [[nodiscard]] std::string label(std::size_t run, const std::string& name) const;
  [[nodiscard]] Detail detail(bool shown) const;
  [[nodiscard]] std::vector<double> values(std::size_t run, const Values& value) const;
  [[nodiscard]] bool at_first(std::size_t run, std::size_t wheel) const;
  void add_line(Chart& chart, std::size_t run, LiveSeries line, const std::vector<double>& values);
  void add_wheels(Chart& chart, const std::function<double(const WheelRecord&)>& quantity);
  void add_of_Q(Chart& chart, const std::function<Linear(double static_load)>& of_load);
  void add_motions(Chart& chart, std::size_t run, const std::vector<std::size_t>& members,
                   const std::function<double(const StepRecord&, std::size_t)>& value,
                   const std::function<std::string(std::size_t)>& name);
  [[nodiscard]] std::string quotient_mean();
  [[nodiscard]] std::string track_shift();
  [[nodiscard]] std::string filtered_unloading();
  [[nodiscard]] std::string unloading();
  [[nodiscard]] std::string deck_envelope() const;
  [[nodiscard]] std::vector<Mark> bridge() const;
  [[nodiscard]] std::vector<Mark> passage() const;

  std::span<const RunResults> runs_;
  std::vector<std::string> names_;
  HistoryStore store_;
  std::vector<std::vector<std::size_t>> Q_;  // histories of the wheels' Q, by run
};

}  // namespace railtab::report
