#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include "railtab/runtime/results/result_file.hpp"

namespace railtab::report {

/// Two records of one wheelset, one coach and one deck node, with values that are told apart by their size.
inline RunResults small_run() {
  RunResults run;
  run.header.scene_name = "small <run>";
  run.header.scene_text = "[train]\nspeed = 50 # </pre><script>\n";
  run.header.program_version = "9.8.7";
  run.header.speed = 50.0;
  run.header.wheel_x = {0.0, 0.0};
  run.header.static_wheel_load = {50e3, 50e3};
  run.header.body_names = {"coach-1/car-body", "coach-1/bogie-1"};
  run.header.node_names = {"deck-midspan-1", "rail-left-midspan-1"};
  run.header.node_x = {16.0, 16.0};
  run.header.wheel_y = {-0.03, 0.0, 0.06};
  run.header.wheel_z = {0.028, 0.0, -0.002};
  run.header.rail_y = {-0.035, -0.03, 0.0, 0.035};
  run.header.rail_z = {0.03, 0.008, 0.0, 0.02};
  for (int i = 0; i < 2; ++i) {
    StepRecord step;
    step.time = 0.1 * i;
    step.position = 5.0 * i;
    step.wheels.resize(2);
    step.wheels[0] = {.Q = i == 0 ? 50e3 : 40e3, .Y = -8e3, .patches = 1, .y_rail = 0.002, .y_wheel = 0.001};
    step.wheels[1] = {.Q = i == 0 ? 50e3 : 60e3, .Y = 3e3, .patches = 1, .y_rail = -0.004, .y_wheel = -0.003};
    step.bodies.resize(2);
    step.bodies[0].acceleration[2] = -0.5 * i;
    step.bodies[0].acceleration[1] = 0.25 * i;
    step.bodies[1].acceleration[2] = 99.0;  // a bogie: no car body
    step.nodes.resize(2);
    step.nodes[0].acceleration[2] = -3.0 * i;
    step.nodes[0].displacement[2] = 0.004 * i;
    step.nodes[1].acceleration[2] = 77.0;  // a rail: no deck
    run.steps.push_back(step);
  }
  run.summary.complete = true;
  run.summary.contact_queries = 200;
  run.summary.table_queries = 150;
  run.summary.seconds_total = 0.05;
  run.summary.seconds_contact = 0.02;
  return run;
}

/// A run as long and as wide as asked for, with smooth histories, two spans and car bodies; its records are close
/// enough for means over 2 m.
inline RunResults long_run(std::size_t records, std::size_t wheels) {
  RunResults run = small_run();
  ResultHeader& header = run.header;
  header.scene_name = "long run";
  header.wheel_x.clear();
  for (std::size_t w = 0; w < wheels; ++w) header.wheel_x.push_back(-6.0 * static_cast<double>(w / 2));
  header.static_wheel_load.assign(wheels, 50e3);
  header.body_names = {"coach-1/car-body", "coach-2/car-body"};
  header.body_x = {-9.0, -33.0};
  header.node_names = {"deck-midspan-1", "deck-midspan-2"};
  header.node_x = {10.0, 30.0};
  header.span_from = {0.0, 20.0};
  header.span_to = {20.0, 40.0};
  header.built = {"2 x coach"};
  header.left_out = {"wind: none acts"};
  header.warnings = {"the track is rough"};
  run.steps.assign(records, StepRecord{});
  for (std::size_t i = 0; i < records; ++i) {
    StepRecord& step = run.steps[i];
    step.time = 0.005 * static_cast<double>(i);
    step.position = -30.0 + 20.0 * step.time;
    for (std::size_t w = 0; w < wheels; ++w) {
      const double phase = 3.0 * step.time + 0.4 * static_cast<double>(w);
      step.wheels.push_back({.Q = 50e3 + 9e3 * std::sin(phase),
                             .Y = 6e3 * std::cos(1.7 * phase),
                             .patches = 1,
                             .from_table = w % 3 == 0 ? 0 : 1,
                             .y_rail = 0.004 * std::sin(phase),
                             .y_wheel = 0.003 * std::sin(phase),
                             .angle = 0.02,
                             .normal_force = 50e3});
    }
    step.bodies.resize(2);
    step.bodies[0].displacement[2] = 0.003 * std::sin(step.time);
    step.nodes.resize(2);
    step.nodes[0].displacement[2] = 0.002 * std::sin(2.0 * step.time);
    step.nodes[1].acceleration[2] = std::sin(step.time);
  }
  return run;
}

}  // namespace railtab::report
