#include "headline_text.hpp"

#include <fmt/format.h>

#include <iterator>

namespace railtab::vsi {
namespace {

void line(std::string& text, std::string_view name, const report::Extreme& extreme, double factor,
          std::string_view unit) {
  if (!extreme.found()) return;
  fmt::format_to(std::back_inserter(text), "  {:<28}{:>10.4g} {:<6} {}, t = {:.3f} s\n", name, factor * extreme.value,
                 unit, extreme.where, extreme.time);
}

void time_line(std::string& text, std::string_view name, double seconds, double total) {
  fmt::format_to(std::back_inserter(text), "  {:<28}{:>10.3f} s      {:.1f} %\n", name, seconds,
                 total > 0.0 ? 100.0 * seconds / total : 0.0);
}

void member(JsonObject& json, std::string_view name, const report::Extreme& extreme) {
  if (!extreme.found()) return;
  json.add(name, JsonObject().add("value", extreme.value).add("time", extreme.time).add("where", extreme.where));
}

}  // namespace

std::string headline_text(const report::Headline& headline, const RunSummary& summary) {
  std::string text = "Largest values of the recorded steps, unfiltered:\n";
  line(text, "deck acceleration", headline.deck_acceleration, 1.0, "m/s²");
  line(text, "deck displacement", headline.deck_displacement, 1e3, "mm");
  line(text, "car body, vertical", headline.car_body_vertical, 1.0, "m/s²");
  line(text, "car body, lateral", headline.car_body_lateral, 1.0, "m/s²");
  line(text, "Y/Q", headline.derailment, 1.0, "");
  line(text, "wheel unloading", headline.unloading, 100.0, "%");
  line(text, "largest Q", headline.largest_Q, 1e-3, "kN");
  line(text, "smallest Q", headline.smallest_Q, 1e-3, "kN");
  if (summary.contact_queries > 0) {
    fmt::format_to(std::back_inserter(text), "Contact ({}): {} queries, {:.4g} % served by the table\n",
                   summary.contact_mode, summary.contact_queries, 100.0 * headline.table_share);
  }
  const double total = summary.seconds_total;
  const std::string speed =
      headline.real_time_factor > 0.0 ? fmt::format(", {:.3g} times real time", headline.real_time_factor) : "";
  fmt::format_to(std::back_inserter(text), "Where the time went ({:.3f} s{}):\n", total, speed);
  time_line(text, "set-up", summary.seconds_setup, total);
  time_line(text, "contact", summary.seconds_contact, total);
  time_line(text, "structure", summary.seconds_structure, total);
  time_line(text, "vehicle", summary.seconds_vehicle, total);
  time_line(text, "output", summary.seconds_output, total);
  const double named = summary.seconds_setup + summary.seconds_contact + summary.seconds_structure +
                       summary.seconds_vehicle + summary.seconds_output;
  time_line(text, "other", total - named, total);
  if (summary.complete && !summary.message.empty()) text += summary.message + "\n";
  return text;
}

JsonObject headline_json(const report::Headline& headline, const RunSummary& summary) {
  JsonObject json;
  json.add("complete", summary.complete).add("message", summary.message);
  member(json, "max_deck_acceleration", headline.deck_acceleration);
  member(json, "max_deck_displacement", headline.deck_displacement);
  member(json, "max_car_body_vertical_acceleration", headline.car_body_vertical);
  member(json, "max_car_body_lateral_acceleration", headline.car_body_lateral);
  member(json, "max_derailment_coefficient", headline.derailment);
  member(json, "max_wheel_unloading", headline.unloading);
  member(json, "max_Q", headline.largest_Q);
  member(json, "min_Q", headline.smallest_Q);
  json.add("simulated_time", headline.simulated_time).add("distance", headline.distance);
  json.add("contact_mode", summary.contact_mode).add("contact_queries", summary.contact_queries);
  json.add("table_queries", summary.table_queries).add("table_share", headline.table_share);
  json.add("steps", summary.steps).add("newton_iterations", summary.newton_iterations);
  json.add("halved_steps", summary.halved_steps);
  json.add("structure_dofs", summary.structure_dofs).add("vehicle_dofs", summary.vehicle_dofs);
  json.add("seconds", JsonObject()
                          .add("total", summary.seconds_total)
                          .add("setup", summary.seconds_setup)
                          .add("contact", summary.seconds_contact)
                          .add("structure", summary.seconds_structure)
                          .add("vehicle", summary.seconds_vehicle)
                          .add("output", summary.seconds_output));
  if (headline.real_time_factor > 0.0) json.add("real_time_factor", headline.real_time_factor);
  return json;
}

}  // namespace railtab::vsi
