#include "headline_text.hpp"

#include <fmt/format.h>

#include <iterator>

namespace railtab::report {
namespace {

void line(std::string& text, std::string_view name, const Extreme& extreme, double factor, std::string_view unit) {
  if (!extreme.found()) return;
  fmt::format_to(std::back_inserter(text), "  {:<28}{:>10.4g} {:<6} {}, t = {:.3f} s\n", name, factor * extreme.value,
                 unit, extreme.where, extreme.time);
}

/// Where a run's time went, in all and per step.
class TimeTable {
 public:
  TimeTable(std::string& text, double total, double steps) : text_(text), total_(total), steps_(steps) {}
  void once(std::string_view name, double seconds) { line(name, seconds, ""); }
  void every_step(std::string_view name, double seconds) {
    line(name, seconds, steps_ > 0.0 ? fmt::format("{:10.4f} ms per step", 1e3 * seconds / steps_) : "");
  }

 private:
  void line(std::string_view name, double seconds, std::string_view per_step) {
    fmt::format_to(std::back_inserter(text_), "  {:<28}{:>10.3f} s {:6.1f} %{}\n", name, seconds,
                   total_ > 0.0 ? 100.0 * seconds / total_ : 0.0, per_step);
  }
  std::string& text_;
  double total_, steps_;
};

void member(nlohmann::ordered_json& json, const char* name, const Extreme& extreme) {
  if (!extreme.found()) return;
  json[name] = {{"value", extreme.value}, {"time", extreme.time}, {"where", extreme.where}};
}

std::string contact_energy_text(const ContactEnergy& e) {
  std::string text = fmt::format(
      "Energy of the normal contacts: gained {:.3g} J, {:.3g} J of it by stiffness that varies; most in a step {:.3g} "
      "J, t = {:.4f} s\n",
      e.gain, e.stiffness_work, e.largest_step, e.largest_step_time);
  if (e.impacts > 0) {
    const std::string of =
        e.largest_impact_stored > 0.0 ? fmt::format(" of {:.3g} J", e.largest_impact_stored) : std::string();
    fmt::format_to(std::back_inserter(text), "  {} impacts of wheelsets, most in one {:.3g} J{}, t = {:.4f} s\n",
                   e.impacts, e.largest_impact, of, e.largest_impact_time);
  }
  return text;
}

nlohmann::ordered_json contact_energy_json(const ContactEnergy& e) {
  nlohmann::ordered_json json{{"gain", e.gain}, {"stiffness_work", e.stiffness_work}};
  json["largest_step"] = {{"value", e.largest_step}, {"time", e.largest_step_time}};
  json["impacts"] = e.impacts;
  if (e.impacts > 0) {
    json["largest_impact"] = {
        {"value", e.largest_impact}, {"time", e.largest_impact_time}, {"stored", e.largest_impact_stored}};
  }
  return json;
}

}  // namespace

std::string headline_text(const Headline& headline, const RunSummary& summary) {
  std::string text;
  line(text, "deck acceleration", headline.deck_acceleration, 1.0, "m/s²");
  line(text, "deck displacement", headline.deck_displacement, 1e3, "mm");
  line(text, "car body, vertical", headline.car_body_vertical, 1.0, "m/s²");
  line(text, "car body, lateral", headline.car_body_lateral, 1.0, "m/s²");
  line(text, "Y/Q", headline.derailment, 1.0, "");
  line(text, "Y/Q, mean over 2 m", headline.derailment_2m, 1.0, "");
  line(text, "sum of Y, mean over 2 m", headline.track_shift_2m, 1e-3, "kN");
  line(text, "wheel unloading", headline.unloading, 100.0, "%");
  line(text, "largest Q", headline.largest_Q, 1e-3, "kN");
  line(text, "smallest Q", headline.smallest_Q, 1e-3, "kN");
  if (!text.empty()) text = fmt::format("Largest values of {}:\n", headline.extent) + text;
  if (summary.contact_queries > 0) {
    fmt::format_to(std::back_inserter(text), "Contact ({}): {} queries, {:.4g} % served by the table\n",
                   summary.contact_mode, summary.contact_queries, 100.0 * headline.table_share);
  }
  if (summary.window_error > 0.0) {
    fmt::format_to(std::back_inserter(text), "Window: motion at its ends at most {:.2g} % of the structure's largest\n",
                   100.0 * summary.window_error);
  }
  if (summary.outside_creep_table > 0) {
    fmt::format_to(std::back_inserter(text), "Outside the creep table, by Polach: {} creep forces\n",
                   summary.outside_creep_table);
  }
  if (summary.stops) {
    fmt::format_to(std::back_inserter(text),
                   "Bump stops: engaged at t = {:.3f} s ({}), largest force {:.4g} kN at t = {:.3f} s ({})\n",
                   summary.stops->first_time, summary.stops->first_name, 1e-3 * summary.stops->largest_force,
                   summary.stops->largest_time, summary.stops->largest_name);
  }
  if (summary.contact_energy) text += contact_energy_text(*summary.contact_energy);
  const double total = summary.seconds_total;
  const std::string speed =
      headline.real_time_factor > 0.0 ? fmt::format(", {:.3g} times real time", headline.real_time_factor) : "";
  fmt::format_to(std::back_inserter(text), "Where the time went ({:.3f} s{}):\n", total, speed);
  const auto steps = static_cast<double>(summary.steps - summary.counted_from);
  TimeTable times(text, total, steps);
  times.once("set-up", summary.seconds_setup);
  if (summary.seconds_pre_roll > 0.0) times.once("  of it pre-roll", summary.seconds_pre_roll);
  times.every_step("structure", summary.seconds_structure);
  times.every_step("contact look-ups", summary.seconds_lookup);
  times.every_step("contact forces, tangents", summary.seconds_contact);
  times.every_step("vehicle", summary.seconds_vehicle);
  times.once("output", summary.seconds_output);
  const double named = summary.seconds_setup + summary.seconds_lookup + summary.seconds_contact +
                       summary.seconds_structure + summary.seconds_vehicle + summary.seconds_output;
  times.every_step("other", total - named);
  if (summary.structure_dofs > 0 && steps > 0.0) {
    fmt::format_to(std::back_inserter(text), "  {:.3g} back-substitutions and {:.3g} Newton iterations per step\n",
                   static_cast<double>(summary.back_substitutions) / steps,
                   static_cast<double>(summary.newton_iterations) / steps);
  }
  if (summary.complete && !summary.message.empty()) text += summary.message + "\n";
  return text;
}

nlohmann::ordered_json headline_json(const Headline& headline, const RunSummary& summary) {
  nlohmann::ordered_json json{{"complete", summary.complete}, {"message", summary.message}};
  member(json, "max_deck_acceleration", headline.deck_acceleration);
  member(json, "max_deck_displacement", headline.deck_displacement);
  member(json, "max_car_body_vertical_acceleration", headline.car_body_vertical);
  member(json, "max_car_body_lateral_acceleration", headline.car_body_lateral);
  member(json, "max_derailment_coefficient", headline.derailment);
  member(json, "max_derailment_coefficient_2m", headline.derailment_2m);
  member(json, "max_track_shift_force_2m", headline.track_shift_2m);
  member(json, "max_wheel_unloading", headline.unloading);
  member(json, "max_Q", headline.largest_Q);
  member(json, "min_Q", headline.smallest_Q);
  if (!headline.extent.empty()) json["extremes_of"] = headline.extent;
  json["simulated_time"] = headline.simulated_time;
  json["distance"] = headline.distance;
  json["contact_mode"] = summary.contact_mode;
  json["contact_queries"] = summary.contact_queries;
  json["table_queries"] = summary.table_queries;
  json["table_share"] = headline.table_share;
  json["outside_creep_table"] = summary.outside_creep_table;
  json["window_error"] = summary.window_error;
  json["steps"] = summary.steps;
  json["counted_from_step"] = summary.counted_from;
  json["newton_iterations"] = summary.newton_iterations;
  json["halved_steps"] = summary.halved_steps;
  json["impact_steps"] = summary.impact_steps;
  json["back_substitutions"] = summary.back_substitutions;
  json["structure_dofs"] = summary.structure_dofs;
  json["vehicle_dofs"] = summary.vehicle_dofs;
  json["seconds"] = {{"total", summary.seconds_total},       {"setup", summary.seconds_setup},
                     {"pre_roll", summary.seconds_pre_roll}, {"lookup", summary.seconds_lookup},
                     {"contact", summary.seconds_contact},   {"structure", summary.seconds_structure},
                     {"vehicle", summary.seconds_vehicle},   {"output", summary.seconds_output}};
  if (summary.stops) {
    json["stops"] = {{"first", {{"time", summary.stops->first_time}, {"where", summary.stops->first_name}}},
                     {"largest_force",
                      {{"value", summary.stops->largest_force},
                       {"time", summary.stops->largest_time},
                       {"where", summary.stops->largest_name}}}};
  }
  if (summary.contact_energy) json["contact_energy"] = contact_energy_json(*summary.contact_energy);
  if (headline.real_time_factor > 0.0) json["real_time_factor"] = headline.real_time_factor;
  return json;
}

}  // namespace railtab::report
