#pragma once

#include <array>

#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab::result_columns {

/// What the results file holds and under which name: one list for the writer and the reader.
inline constexpr int format_version = 5;

template <typename Owner, typename Value>
struct Column {
  const char* path;
  const char* unit;
  const char* description;
  Value Owner::*value;
  bool in_all_files = true;  ///< else absent in older files, whose values then are NaN
};

using WheelColumn = Column<WheelRecord, double>;
inline constexpr std::array wheel{
    WheelColumn{"wheels/Q", "N", "vertical force on the rail, down", &WheelRecord::Q},
    WheelColumn{"wheels/Y", "N", "lateral force on the rail, to the right", &WheelRecord::Y},
    WheelColumn{"wheels/X", "N", "longitudinal force on the rail, forward", &WheelRecord::X},
    WheelColumn{"wheels/y_rail", "m", "contact point on the rail, of the patch with the largest normal force",
                &WheelRecord::y_rail},
    WheelColumn{"wheels/y_wheel", "m", "contact point on the wheel, of that patch", &WheelRecord::y_wheel},
    WheelColumn{"wheels/angle", "rad", "contact angle of that patch", &WheelRecord::angle},
    WheelColumn{"wheels/rolling_radius", "m", "rolling radius of that patch", &WheelRecord::rolling_radius},
    WheelColumn{"wheels/normal_force", "N", "normal force of that patch", &WheelRecord::normal_force},
    WheelColumn{"wheels/penetration", "m", "penetration of that patch", &WheelRecord::penetration},
    WheelColumn{"wheels/second_y_rail", "m", "contact point on the rail, of the next patch; 0 where there is none",
                &WheelRecord::second_y_rail},
    WheelColumn{"wheels/second_normal_force", "N", "normal force of the next patch; 0 where there is none",
                &WheelRecord::second_normal_force},
    WheelColumn{"wheels/wear_number", "J/m", "energy that creep takes per way of the train, all patches",
                &WheelRecord::wear_number, false},
    WheelColumn{"wheels/pressure", "Pa", "largest normal pressure of all patches", &WheelRecord::pressure, false}};
/// Stored as floating-point numbers like all that grows.
using WheelCount = Column<WheelRecord, int>;
inline constexpr WheelCount patches{"wheels/patches", "1", "patches in contact", &WheelRecord::patches};
/// Absent in older files.
inline constexpr WheelCount from_table{"wheels/from_table", "1",
                                       "1 where the table alone answered, 0 where the online search did",
                                       &WheelRecord::from_table};

using StepColumn = Column<StepRecord, double>;
inline constexpr std::array step{
    StepColumn{"time", "s", "time", &StepRecord::time},
    StepColumn{"position", "m", "position of the first wheelset along the track", &StepRecord::position}};
inline constexpr Column<StepRecord, int> newton_iterations{"newton_iterations", "1", "Newton iterations of the step",
                                                           &StepRecord::newton_iterations};

using MotionColumn = Column<MotionRecord, double[6]>;
inline constexpr std::array motion{
    MotionColumn{"displacement", "m, rad", "x, y, z, roll, pitch, yaw", &MotionRecord::displacement},
    MotionColumn{"velocity", "m/s, rad/s", "x, y, z, roll, pitch, yaw", &MotionRecord::velocity},
    MotionColumn{"acceleration", "m/s^2, rad/s^2", "x, y, z, roll, pitch, yaw", &MotionRecord::acceleration}};

/// Groups of motions: bodies and nodes.
struct MotionGroup {
  const char* name;
  std::vector<MotionRecord> StepRecord::*motions;
  std::vector<std::string> ResultHeader::*names;
  const char* description;
};
inline constexpr std::array motion_groups{
    MotionGroup{"bodies", &StepRecord::bodies, &ResultHeader::body_names, "bodies of all vehicles, front first"},
    MotionGroup{"nodes", &StepRecord::nodes, &ResultHeader::node_names, "nodes of the structure"}};

struct HeaderText {
  const char* name;
  std::string ResultHeader::*value;
};
inline constexpr std::array header_texts{
    HeaderText{"scene_name", &ResultHeader::scene_name}, HeaderText{"program_version", &ResultHeader::program_version},
    HeaderText{"wheel_profile", &ResultHeader::wheel_profile}, HeaderText{"rail_profile", &ResultHeader::rail_profile}};

struct HeaderTexts {
  const char* path;
  const char* dimension;  ///< name of the extent: datasets that share it have equal lengths
  const char* description;
  std::vector<std::string> ResultHeader::*values;
  bool in_all_files = true;  ///< else absent where it is empty, and in older files
};
inline constexpr std::array header_text_lists{
    HeaderTexts{"header/input_files", "files", "files that the scene names", &ResultHeader::input_files},
    HeaderTexts{"header/input_checksums", "files", "of their contents when the run began",
                &ResultHeader::input_checksums},
    HeaderTexts{"header/built", "parts built", "what the run was built of", &ResultHeader::built, false},
    HeaderTexts{"header/left_out", "parts left out", "what was left out of it", &ResultHeader::left_out, false},
    HeaderTexts{"header/warnings", "warnings", "of the scene and its start", &ResultHeader::warnings, false}};

struct HeaderColumn {
  const char* path;
  const char* dimension;
  const char* unit;
  const char* description;
  std::vector<double> ResultHeader::*values;
  bool in_all_files = true;  ///< else absent where it is empty, and in older files
};
inline constexpr std::array header{
    HeaderColumn{"header/wheel_x", "wheels", "m",
                 "offset of each wheel behind the first wheelset; left, right, front first", &ResultHeader::wheel_x},
    HeaderColumn{"header/static_wheel_load", "wheels", "N",
                 "vertical force of each wheel at rest on level track, the mean of both wheels of a wheelset",
                 &ResultHeader::static_wheel_load},
    HeaderColumn{"header/body_x", "bodies", "m", "offset of each body behind the first wheelset", &ResultHeader::body_x,
                 false},
    HeaderColumn{"header/body_y", "bodies", "m", "body at rest, right of the track's centre", &ResultHeader::body_y,
                 false},
    HeaderColumn{"header/body_z", "bodies", "m", "body at rest, below the rail-head tops", &ResultHeader::body_z,
                 false},
    HeaderColumn{"header/node_y", "nodes", "m", "node, right of the track's centre", &ResultHeader::node_y, false},
    HeaderColumn{"header/node_z", "nodes", "m", "node, below the rail-head tops", &ResultHeader::node_z, false},
    HeaderColumn{"header/span_from", "spans", "m", "begin of each span of the bridge along the track",
                 &ResultHeader::span_from, false},
    HeaderColumn{"header/span_to", "spans", "m", "its end", &ResultHeader::span_to, false},
    HeaderColumn{"header/judged", "ends of the judged stretch", "m",
                 "where wheels and car bodies begin and end to be judged, each where it stands; absent: everywhere",
                 &ResultHeader::judged, false},
    HeaderColumn{"header/node_x", "nodes", "m", "position of the nodes along the track", &ResultHeader::node_x},
    HeaderColumn{"header/wheel_outline", "wheels", "1", "1 where a wheel has the outline below, 0 where it has another",
                 &ResultHeader::wheel_outline, false},
    HeaderColumn{"header/wheel_y", "wheel points", "m", "outline of the wheel, lateral, to the field side",
                 &ResultHeader::wheel_y},
    HeaderColumn{"header/wheel_z", "wheel points", "m", "outline of the wheel, down", &ResultHeader::wheel_z},
    HeaderColumn{"header/rail_y", "rail points", "m", "outline of the rail, lateral, to the field side",
                 &ResultHeader::rail_y},
    HeaderColumn{"header/rail_z", "rail points", "m", "outline of the rail, down", &ResultHeader::rail_z}};

/// Decks: "deck/<quantity>/x" and so on; absent where decks are not followed, and in older files.
inline constexpr const char *deck_group = "deck", *deck_quantities = "deck/quantities", *deck_cut_off = "deck/cut_off";
struct DeckPlaceColumn {
  const char* name;
  const char* description;
  std::vector<double> DeckPlaces::*values;
};
inline constexpr std::array deck_places{DeckPlaceColumn{"x", "along the track", &DeckPlaces::x},
                                        DeckPlaceColumn{"y", "right of the track's centre", &DeckPlaces::y}};
/// Empty until the run has ended.
struct DeckExtremeColumn {
  const char* name;
  bool is_time;
  const char* description;
  std::vector<double> DeckExtremes::*values;
};
inline constexpr std::array deck_extremes{
    DeckExtremeColumn{"smallest", false, "smallest value of all steps", &DeckExtremes::smallest},
    DeckExtremeColumn{"smallest_time", true, "when it occurred", &DeckExtremes::smallest_time},
    DeckExtremeColumn{"largest", false, "largest value of all steps", &DeckExtremes::largest},
    DeckExtremeColumn{"largest_time", true, "when it occurred", &DeckExtremes::largest_time}};
/// Attribute of "deck": of all extremes in their order, as array_file.hpp computes checksums, its upper 52 bits.
inline constexpr const char* deck_checksum = "extremes_checksum";

template <typename Value>
struct SummaryEntry {
  const char* name;
  Value RunSummary::*value;
  bool in_all_files = true;  ///< else 0 where an older file lacks it
};
inline constexpr std::array summary_counts{SummaryEntry<long>{"steps", &RunSummary::steps},
                                           SummaryEntry<long>{"counted_from_step", &RunSummary::counted_from, false},
                                           SummaryEntry<long>{"newton_iterations", &RunSummary::newton_iterations},
                                           SummaryEntry<long>{"halved_steps", &RunSummary::halved_steps},
                                           SummaryEntry<long>{"impact_steps", &RunSummary::impact_steps, false},
                                           SummaryEntry<long>{"back_substitutions", &RunSummary::back_substitutions},
                                           SummaryEntry<long>{"contact_queries", &RunSummary::contact_queries},
                                           SummaryEntry<long>{"table_queries", &RunSummary::table_queries},
                                           SummaryEntry<long>{"outside_creep_table", &RunSummary::outside_creep_table},
                                           SummaryEntry<long>{"structure_dofs", &RunSummary::structure_dofs},
                                           SummaryEntry<long>{"vehicle_dofs", &RunSummary::vehicle_dofs}};
inline constexpr std::array summary_numbers{
    SummaryEntry<double>{"window_error", &RunSummary::window_error, false},
    SummaryEntry<double>{"seconds_total", &RunSummary::seconds_total},
    SummaryEntry<double>{"seconds_setup", &RunSummary::seconds_setup},
    SummaryEntry<double>{"seconds_pre_roll", &RunSummary::seconds_pre_roll, false},
    SummaryEntry<double>{"seconds_lookup", &RunSummary::seconds_lookup},
    SummaryEntry<double>{"seconds_contact", &RunSummary::seconds_contact},
    SummaryEntry<double>{"seconds_structure", &RunSummary::seconds_structure},
    SummaryEntry<double>{"seconds_vehicle", &RunSummary::seconds_vehicle},
    SummaryEntry<double>{"seconds_output", &RunSummary::seconds_output}};

struct ContactEnergyEntry {
  const char* name;
  double ContactEnergy::*value;
};
inline constexpr std::array summary_contact_energy{
    ContactEnergyEntry{"contact_energy_gain", &ContactEnergy::gain},
    ContactEnergyEntry{"contact_energy_stiffness_work", &ContactEnergy::stiffness_work},
    ContactEnergyEntry{"contact_energy_largest_step", &ContactEnergy::largest_step},
    ContactEnergyEntry{"contact_energy_largest_step_time", &ContactEnergy::largest_step_time},
    ContactEnergyEntry{"contact_energy_largest_impact", &ContactEnergy::largest_impact},
    ContactEnergyEntry{"contact_energy_largest_impact_time", &ContactEnergy::largest_impact_time},
    ContactEnergyEntry{"contact_energy_largest_impact_stored", &ContactEnergy::largest_impact_stored}};
inline constexpr const char* contact_energy_impacts = "contact_energy_impacts";  // -1 where no account was kept

/// Texts and numbers of RunSummary::stops; empty where no stop was engaged, absent in older files.
inline constexpr std::array<std::pair<const char*, std::string StopSummary::*>, 2> summary_stop_names{
    {{"stop_first_name", &StopSummary::first_name}, {"stop_largest_name", &StopSummary::largest_name}}};
inline constexpr std::array<std::pair<const char*, double StopSummary::*>, 3> summary_stops{
    {{"stop_first_time", &StopSummary::first_time},
     {"stop_largest_force", &StopSummary::largest_force},
     {"stop_largest_time", &StopSummary::largest_time}}};

struct WheelExtremeEntry {
  const char* name;  ///< and of time and wheel: with _time and _wheel
  WheelExtreme WheelExtremes::*value;
};
inline constexpr std::array summary_wheel_extremes{
    WheelExtremeEntry{"largest_Q", &WheelExtremes::largest_Q},
    WheelExtremeEntry{"smallest_Q", &WheelExtremes::smallest_Q},
    WheelExtremeEntry{"largest_derailment_coefficient", &WheelExtremes::derailment},
    WheelExtremeEntry{"largest_wheel_unloading", &WheelExtremes::unloading}};

inline constexpr const char* summary_group = "summary";
inline constexpr std::array checkpoint_slots{"checkpoint/a", "checkpoint/b"};

}  // namespace railtab::result_columns
