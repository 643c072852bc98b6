#include "railtab/tablegen/loaded_verification.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <mutex>
#include <random>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/loaded_contact.hpp"
#include "railtab/tablegen/parallel_failure.hpp"

namespace railtab {

void LoadedVerificationOptions::validate() const {
  if (samples < 1 || samples > 10'000'000) throw input_error("samples", fmt::format("{}", samples), "1..10^7");
  if (!(approach.low >= 0.0 && approach.low < approach.high && approach.high <= 5e-3)) {
    throw input_error("approach", fmt::format("{}:{}", approach.low, approach.high), "0 <= LO < HI <= 5e-3 m");
  }
  if (elements < 4 || elements > 1000) throw input_error("elements", fmt::format("{}", elements), "4..1000");
  material.validate();
}

namespace {

struct Sample {
  bool answered = false;
  double normal_force = 0.0, force = 0.0, stiffness = 0.0, pressure = 0.0;
};

Sample compare(const ContactSearch& search, const LoadedTable& table, const WheelsetPose& pose,
               const LoadedContactOptions& options) {
  Sample sample;
  LoadedSlopes slopes;
  const LoadedLookup found = table.lookup(pose.y, pose.z, pose.roll, pose.yaw, slopes);
  if (found.table_share < 1.0) return sample;
  const LoadedContact exact = loaded_contact(search, pose, options);
  if (!exact.converged) return sample;
  sample.answered = true;
  sample.normal_force = std::hypot(exact.on_rail.force.y(), exact.on_rail.force.z());
  const double error_y = found.force[0] - exact.on_rail.force.y(), error_z = found.force[1] - exact.on_rail.force.z();
  sample.force = std::hypot(error_y, error_z) / sample.normal_force;
  if (sample.normal_force < 5e3) return sample;
  sample.pressure = std::abs(found.largest_pressure() / exact.largest_pressure - 1.0);
  // A difference of solutions over six hundredths of a Hertzian approach: the reference's noise of some 1e-4 of the
  // force becomes less than 1 % of the stiffness, and the third derivative of Hertz's force 4e-5 of it.
  const double step = 0.03 * 2.5 * exact.elastic_energy / exact.on_rail.force.z();
  WheelsetPose above = pose, below = pose;
  above.z -= step;
  below.z += step;
  const double rise = loaded_contact(search, below, options).on_rail.force.z() -
                      loaded_contact(search, above, options).on_rail.force.z();
  sample.stiffness = std::abs(slopes.stiffness(1, 1) / (0.5 * rise / step) - 1.0);
  return sample;
}

double time_of_lookup(const LoadedTable& table, const std::vector<WheelsetPose>& poses) {
  double best = std::numeric_limits<double>::infinity(), sum = 0.0;
  for (int pass = 0; pass < 5; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    for (const WheelsetPose& p : poses) sum += table.lookup(p.y, p.z, p.roll, p.yaw).energy;
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return std::isfinite(sum) ? 1e9 * best / static_cast<double>(poses.size()) : 0.0;
}

}  // namespace

LoadedVerification verify_loaded_table(const ContactSearch& search, const LoadedTable& table,
                                       const LoadedVerificationOptions& options, const Progress& progress) {
  options.validate();
  const LoadedTableData& data = table.data();
  LoadedContactOptions contact;
  contact.wheel = contact.rail = options.material;
  contact.elements.across_narrowest = options.elements;
  contact.elements.most = most_elements;
  contact.validate();
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> uniform;
  const auto within = [&](double low, double high) { return low + (high - low) * uniform(random); };
  std::vector<WheelsetPose> poses;
  std::size_t misses = 0;
  while (poses.size() < static_cast<std::size_t>(options.samples)) {
    constexpr double border = LoadedTable::border;
    const double yaw = std::sqrt((1.0 - border) * data.yaw_squared.back());
    const double of_roll = border * (data.roll.back() - data.roll.front());
    WheelsetPose pose{.y = within(data.shift.front(), data.shift[data.shift.size() - 2]),
                      .z = 0.0,
                      .roll = within(data.roll.front() + of_roll, data.roll.back() - of_roll),
                      .yaw = within(-yaw, yaw)};
    pose.roll = data.roll_at(pose.roll, pose.y);
    const TouchPoint touch = search.first_touch(pose.y, pose.roll, pose.yaw);
    const double approach = within(options.approach.low, options.approach.high);
    if (!std::isfinite(touch.z_touch)) {
      if (++misses <= 20 * (poses.size() + 50)) continue;
      throw ComputationError("verification: the wheel does not meet the rail in more than 95 % of the loaded table");
    }
    pose.z = touch.z_touch + approach * std::hypot(1.0, touch.z_touch_dy);
    poses.push_back(pose);
  }
  std::vector<Sample> samples(poses.size());
  std::size_t done = 0;
  ParallelFailure failure;
  std::mutex one_at_a_time;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < poses.size(); ++i) {
    failure.guard([&] {
      try {
        samples[i] = compare(search, table, poses[i], contact);
      } catch (const TooManyElements&) {  // not answered: no solution to compare with
      }
      const std::scoped_lock lock(one_at_a_time);
      ++done;
      if (progress) progress(static_cast<double>(done) / static_cast<double>(poses.size()));
    });
  }
  failure.rethrow();
  LoadedVerification result;
  result.samples = options.samples;
  std::vector<double> force, light, stiffness, pressure;
  for (const Sample& s : samples) {
    result.answered += s.answered;
    if (!s.answered || s.normal_force < 1e3) continue;
    (s.normal_force > 5e3 ? force : light).push_back(s.force);
    if (s.normal_force <= 5e3) continue;
    stiffness.push_back(s.stiffness);
    pressure.push_back(s.pressure);
  }
  result.above_5_kn = static_cast<int>(force.size());
  result.from_1_to_5_kn = static_cast<int>(light.size());
  result.force = error_statistics(std::move(force));
  result.light_force = error_statistics(std::move(light));
  result.stiffness = error_statistics(std::move(stiffness));
  result.pressure = error_statistics(std::move(pressure));
  result.time_ns = time_of_lookup(table, poses);
  return result;
}

}  // namespace railtab
