#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace railtab {

/// One wheel at one instant. Forces act on the rail, in the track frame: positive Q presses the rail down,
/// positive Y pushes the rail to the right, positive X pushes the rail forward [N].
struct WheelRecord {
  double Q = 0, Y = 0, X = 0;
  int patches = 0;                 ///< patches in contact
  int from_table = 0;              ///< 1: the table alone answered, 0: the online search, -1: not said
  double y_rail = 0, y_wheel = 0;  ///< of the patch with the largest normal force, own-side profile frames [m]
  double angle = 0;                ///< contact angle of that patch [rad]
  double rolling_radius = 0;       ///< of that patch [m]
  double normal_force = 0;         ///< of that patch [N]
  double penetration = 0;          ///< of that patch [m]
  double second_y_rail = 0, second_normal_force = 0;  ///< of the next patch; 0 where there is none
  double wear_number = 0;                             ///< T·γ: energy that creep takes per way of the train [J/m]
  double pressure = 0;                                ///< largest normal pressure [Pa]
};

/// Motion of one body or node, track axes: x, y, z [m, m/s, m/s²], then roll, pitch, yaw [rad, rad/s, rad/s²].
struct MotionRecord {
  double displacement[6] = {};
  double velocity[6] = {};
  double acceleration[6] = {};
};

/// Everything that one instant offers to the results.
struct StepRecord {
  double time = 0;                   ///< [s]
  double position = 0;               ///< of the first wheelset along the track [m]
  std::vector<WheelRecord> wheels;   ///< 2 per wheelset: left, right; wheelsets front first
  std::vector<MotionRecord> bodies;  ///< all vehicles, front first
  std::vector<MotionRecord> nodes;   ///< structure nodes of interest
  int newton_iterations = 0;
};

/// Where one quantity is followed on the decks (DeckQuantity).
struct DeckPlaces {
  std::string quantity, unit;    ///< "displacement", "acceleration", "filtered_acceleration", "twist", …; SI
  std::vector<double> x{}, y{};  ///< along the track, right of its centre [m]
  friend bool operator==(const DeckPlaces&, const DeckPlaces&) = default;
};

/// Extremes of that quantity at those places over all steps of a run, and when they occurred [s].
struct DeckExtremes {
  std::vector<double> smallest{}, smallest_time{}, largest{}, largest_time{};
};

/// Names and constants that do not change during a run.
struct ResultHeader {
  std::string scene_name;
  std::string scene_text;  ///< the TOML that was run
  /// Files that the scene names, in their order, and their checksums (file_checksum()) when the run began.
  std::vector<std::string> input_files, input_checksums;
  std::string program_version;
  std::string contact_mode;               ///< table, online, paper; in the summary of a file that is read
  double speed = 0;                       ///< [m/s]
  std::vector<double> wheel_x;            ///< offset of each wheel behind the first wheelset (<= 0) [m]
  std::vector<double> static_wheel_load;  ///< Q0 per wheel, the mean of both of a wheelset [N]
  std::vector<std::string> body_names;    ///< "coach-1/car-body", ...
  std::vector<double> body_x;             ///< offset of each body behind the first wheelset; empty in older files [m]
  std::vector<double> body_y, body_z;     ///< right of the track's centre, below the rail-head tops; likewise [m]
  std::vector<std::string> node_names;
  std::vector<double> node_x;                            ///< [m]
  std::vector<double> node_y, node_z;                    ///< as of bodies; empty where one is not known [m]
  std::vector<double> span_from, span_to;                ///< of the bridge's spans along the track [m]
  std::vector<DeckPlaces> deck{};                        ///< of RunSummary::deck; empty: decks are not followed
  double deck_cut_off = 0;                               ///< of its filtered acceleration [Hz]
  std::string wheel_profile, rail_profile;               ///< names
  std::vector<double> wheel_y, wheel_z, rail_y, rail_z;  ///< outlines for the report [m]
  /// Where wheels differ in their profiles: 1 where a wheel has the outline above, else 0; otherwise empty.
  std::vector<double> wheel_outline;
  /// Begin and end of the stretch on which wheels and car bodies are judged, each where it stands [m]; empty: all.
  /// ∓off_the_line where one of them is not stated.
  std::vector<double> judged;
  /// What the run was built of, what was left out, and what it was warned of before its first step.
  std::vector<std::string> built, left_out, warnings;
};

inline constexpr double off_the_line = 1e6;  ///< farther than any place on it [m]; results hold finite numbers

/// @param judged ResultHeader::judged
[[nodiscard]] inline bool is_judged(const std::vector<double>& judged, double x) noexcept {
  return judged.empty() || (x >= judged[0] && x <= judged[1]);
}

/// Nodes of the bridge deck are named deck….
[[nodiscard]] inline bool is_deck(std::string_view node_name) noexcept { return node_name.starts_with("deck"); }

/// What the normal contacts made of a run's energy [J]: EnergyBalance::contact_gain, of all and where it was largest in
/// amount. An impact of a wheelset begins with a step in which one of its wheels touches after a flight or begins to
/// touch with its flange (contact angle above 0.2 rad), and ends with one that ends that contact, or after 10 ms.
struct ContactEnergy {
  double gain = 0;            ///< of the whole run
  double stiffness_work = 0;  ///< the part of it that is none of the time integration's, see EnergyBalance
  double largest_step = 0, largest_step_time = 0;      ///< of all contacts in one step; end of that step [s]
  long impacts = 0;                                    ///< that have ended
  double largest_impact = 0, largest_impact_time = 0;  ///< of a wheelset in one impact; its begin [s]
  double largest_impact_stored = 0;  ///< most that the wheelset's contact springs took up in that impact
};

/// Where a wheel's force was largest or smallest in a run.
struct WheelExtreme {
  double value = 0, time = 0;  ///< [N] or [-], and the end of the step [s]
  int wheel = -1;              ///< index in StepRecord::wheels; -1: there is none
  [[nodiscard]] bool found() const noexcept { return wheel >= 0; }
};

/// Over all steps of a run from t = 0 on, recorded or not, and over the parts of those that are divided, of wheels on
/// the judged stretch.
struct WheelExtremes {
  WheelExtreme largest_Q, smallest_Q;  ///< [N]
  WheelExtreme derailment;             ///< |Y|/Q of a wheel while Q > 0 [-]
  WheelExtreme unloading;              ///< (Q0 - Q)/Q0, Q0 the wheel's static load [-]
  void add(double time, int wheel, double Y, double Q, double static_load) noexcept;
};

/// A bump stop in action: a force element of a vehicle.
struct StopEvent {
  double time = 0, force = 0;  ///< end of the step [s], [N]
  int element = -1;            ///< index over the elements of all vehicles, front first; -1: there is none
  [[nodiscard]] bool found() const noexcept { return element >= 0; }
};
/// Over all steps of a run from t = 0 on: when a stop was first engaged, and where one bore most.
struct StopExtremes {
  StopEvent first, largest;
};
/// The same for the summary. @see RunSummary::stops
struct StopSummary {
  std::string first_name, largest_name;        ///< "coach-1: secondary suspension along y, bogie-1 to car-body, right"
  double first_time = 0;                       ///< [s]
  double largest_force = 0, largest_time = 0;  ///< [N], [s]
};

/// How the run ended and where its time went.
struct RunSummary {
  bool complete = false;
  bool interrupted = false;  ///< ended by RunObserver::stop; not stored
  std::string message;       ///< empty, or why the run ended early
  long steps = 0, newton_iterations = 0, halved_steps = 0;
  long impact_steps = 0;        ///< steps divided because a wheel met or left its rail, or its force jumped
  long counted_from = 0;        ///< step at which a resumed run's counts and times begin
  long back_substitutions = 0;  ///< of the structure's factor
  long contact_queries = 0, table_queries = 0;  ///< queries answered, and those that the table alone answered
  long outside_creep_table = 0;                 ///< creep forces that the creep table left to Polach, wholly or in part
  /// Set-up and, of it, the steps before the run begins; look-ups of the contact geometry; the contact solution besides
  /// (forces, tangents, Newton); and so on.
  double seconds_total = 0, seconds_setup = 0, seconds_pre_roll = 0, seconds_lookup = 0, seconds_contact = 0,
         seconds_structure = 0, seconds_vehicle = 0, seconds_output = 0;
  long structure_dofs = 0, vehicle_dofs = 0;
  long active_dofs = 0;  ///< most of the structure's unknowns that a step had, all or those of the moving window; not
                         ///< in result files
  /// Largest motion that the moving window put to rest behind the train or that reached its front end, relative to the
  /// structure's largest then [-]; 0 without window.
  double window_error = 0;
  std::string contact_mode;                     ///< table, online, paper
  std::optional<ContactEnergy> contact_energy;  ///< where output.energy asks for it
  std::optional<StopSummary> stops;             ///< where a bump stop of the vehicles was engaged
  std::vector<DeckExtremes> deck{};             ///< as ResultHeader::deck; empty of a run that was killed
  WheelExtremes wheel_extremes;                 ///< none where wheels are not recorded, and in older files
};

}  // namespace railtab
