#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab::testing {

inline constexpr double crossed_length = 25.0;  ///< of the beam in the references [m]

struct CrossingHistory {
  std::vector<double> t, u_mid, a_sprung, force;  ///< [s], [m], [m/s²], [N]
};

/// A one-wheelset model's way over its beam, from rest. `sprung` is the body whose acceleration is kept.
inline CrossingHistory cross_beam(const VsiModel& model, const IntegrationParameters& integration, int record_every,
                                  std::size_t sprung) {
  VsiState state(model);
  EXPECT_TRUE(static_equilibrium(model, state).converged);
  CrossingHistory history;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    history.t.push_back(record.time);
    history.u_mid.push_back(record.nodes.at(0).displacement[2]);
    history.a_sprung.push_back(record.bodies.at(sprung).acceleration[2]);
    history.force.push_back(record.wheels.at(0).Q + record.wheels.at(1).Q);
  };
  const RunSummary summary =
      simulate(model, integration, crossed_length / model.contact.speed, record_every, state, observer);
  EXPECT_TRUE(summary.complete) << summary.message;
  return history;
}

inline double largest(const std::vector<double>& v) {
  double m = 0.0;
  for (double x : v) m = std::max(m, std::abs(x));
  return m;
}

/// Largest difference, over all points but the last `left_out`.
inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b, std::size_t left_out = 0) {
  EXPECT_EQ(a.size(), b.size());
  double m = 0.0;
  for (std::size_t i = 0; i + left_out < std::min(a.size(), b.size()); ++i) m = std::max(m, std::abs(a[i] - b[i]));
  return m;
}

}  // namespace railtab::testing
