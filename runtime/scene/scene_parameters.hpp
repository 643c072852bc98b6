#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/contact/friction_law.hpp"
#include "railtab/runtime/contact/hertz.hpp"
#include "railtab/runtime/line/irregularity_spectrum.hpp"
#include "railtab/runtime/line/span_deviation.hpp"
#include "railtab/runtime/line/wheel_deviation.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"
#include "railtab/runtime/results/output_selection.hpp"
#include "railtab/runtime/structure/imported_bridge.hpp"
#include "railtab/runtime/structure/reduction.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vehicle/consist.hpp"
#include "railtab/runtime/vehicle/vehicle_import.hpp"
#include "railtab/runtime/vsi/integration_parameters.hpp"
#include "railtab/runtime/vsi/normal_contact.hpp"

namespace railtab {

enum class ContactMode { table, online, paper };
/// Elastic forces of the contact: the half-space solution where the table holds it, or always, or those of patches.
enum class ElasticContact { automatic, half_space, patches };
enum class TrackKind { rigid, flexible, imported };

struct TrainParameters {
  std::string vehicle = "manchester-coach";  ///< of the library, a file, or imported_vehicle
  int count = 1;                             ///< coaches, 1..100
  std::vector<ConsistEntry> consist;         ///< front first, in place of `vehicle` and `count`; empty: these
  std::filesystem::path joint;               ///< between vehicles whose files name none; empty: nothing
  double speed = 200.0 / 3.6;                ///< [m/s], > 0
  std::filesystem::path speed_file;          ///< speed over time in place of `speed`; empty: constant
  double start = 0.0;                        ///< position of the first wheelset at t = 0 [m]
  /// Initial lateral shift [m] and yaw [rad] of every wheelset (hunting studies).
  double initial_lateral_shift = 0.0;
  double initial_yaw = 0.0;
  GeometricStiffness geometric_stiffness = GeometricStiffness::included;
  ForceElementChoice force_elements = ForceElementChoice::nonlinear;
  double lateral_acceleration = 0.0;  ///< V²/R of a curve to the left, horizontal: pushes the vehicles right [m/s²]
  double cant = 0.0;                  ///< height of the right rail above the left one, over cant_base [m]
  static constexpr double cant_base = 1.5;  ///< [m]

  /// `consist`, or where it is empty the one entry of `vehicle` and `count`.
  [[nodiscard]] std::vector<ConsistEntry> entries() const;
  /// Vehicles of the train.
  [[nodiscard]] int vehicles() const noexcept;
  /// Sine of the angle by which the track is rolled to the left.
  [[nodiscard]] double cant_sine() const noexcept { return cant / cant_base; }
};

struct ContactParameters {
  ContactMode mode = ContactMode::table;
  NormalContact normal = NormalContact::hertz;
  ElasticContact elastic = ElasticContact::automatic;
  std::filesystem::path table;  ///< geometry table; also gives the profiles
  std::string wheel = "S1002";  ///< where no table is named (online, paper)
  std::string rail = "60E1";
  double rail_inclination = 1.0 / 40.0;
  PairDimensions dimensions;            ///< where no table is named
  std::string creep_law = "table";      ///< the shipped table is for nu = 0.28
  std::filesystem::path creep_table;    ///< of the law "table"; empty: the shipped one
  double friction = 0.30;               ///< Coulomb coefficient [-], 0..2
  std::filesystem::path friction_file;  ///< coefficients of both rails along the track; empty: `friction`
  FrictionLaw friction_law;
  double k_adhesion = 1.0, k_slip = 1.0;  ///< of the law "polach"
  double creep_speed_floor = 0.1;         ///< WheelContactModel::speed_floor of a run with a speed file [m/s]
  ElasticMaterial material;
  double damping = 0.0;           ///< contact damping: F_n·(1 + damping·d'), [s/m], >= 0
  double curvature_floor = 0.05;  ///< smallest B of the Hertz ellipse [1/m]
};

/// "table", "online", "paper", or "rigid": what results say of how they were made.
[[nodiscard]] std::string_view contact_mode_name(const ContactParameters& contact) noexcept;

/// One load on bodies of the train: a history from a file, or the constant one given, or a gust of that peak.
struct LoadParameters {
  std::string body = "car-body";  ///< name of a body of the vehicle
  int coach = 0;                  ///< counted from the front; 0: every one
  std::filesystem::path file;     ///< load history; empty: `load`
  /// Fx, Fy, Fz [N], Mx, My, Mz [N m]; those that are not named are zero.
  std::array<std::optional<double>, 6> load{};
  double start = 0.0;          ///< added to the file's times or positions [s] or [m]; of the gust [s]
  double gust_duration = 0.0;  ///< of a one-minus-cosine gust [s]; 0: the load is constant
  /// Coefficients of a vehicle in wind; `file` then is a history of the wind's speed. Empty: no wind.
  std::filesystem::path aerodynamics;
  std::optional<double> wind_speed;  ///< constant, or the peak of the gust [m/s]
  double wind_direction = 90.0;      ///< where it comes from, from the direction of travel to the left [°]
  double air_density = 1.225;        ///< [kg/m³]
  double area = 10.0, length = 3.0;  ///< that the coefficients refer to [m²], [m]
};

/// Profiles of some wheels where they are not those of [contact].
struct ProfileParameters {
  int coach = 0;                ///< counted from the front; 0: every one
  std::string vehicle;          ///< as the train names it; empty: any
  std::filesystem::path table;  ///< geometry table, with contact.mode = "table"
  std::string wheel;            ///< without tables; empty: that of [contact]
};

enum class WheelSides { both, left, right };

/// What is not round about some wheels.
struct WheelParameters {
  int coach = 0;     ///< counted from the front; 0: every one
  int wheelset = 0;  ///< of the coach, counted from the front; 0: every one
  WheelSides side = WheelSides::both;
  WheelFlat flat;                      ///< length 0: none
  WheelHarmonic polygon{2, 0.0, 0.0};  ///< amplitude 0: none
  WheelHarmonic run_out;               ///< order 1; amplitude 0: none
  std::filesystem::path file;          ///< contour; empty: none
};

enum class DeckTrack { ballasted, direct };

/// What vsi assess asks besides what a run does.
struct AssessmentParameters {
  double line_speed_kmh = 0.0;                ///< highest speed of the line [km/h]; 0: the train's
  DeckTrack track = DeckTrack::ballasted;     ///< by which limits of deck acceleration are chosen
  std::vector<std::string> trains{"hslm-a"};  ///< besides the scene's own
  int seeds = 3;                              ///< random tracks for each speed, from irregularity.seed on
  std::optional<double> begin, end;           ///< where wheels and car bodies begin and end to be judged [m]
  double section_length = 0.0;                ///< of percentiles [m]; 0: all that is judged
  double section_step = 0.5;                  ///< between the values of a section [m]
  std::vector<std::string> rules{"Europe"};   ///< whose clauses apply besides those that belong to none
};

/// Ground motion by one record; several are stations along the track.
struct GroundMotionParameters {
  std::filesystem::path file;
  double x = 0.0;           ///< of the station along the track, where there are several [m]
  double factor = 1.0;      ///< times the record
  double start = 0.0;       ///< added to the record's times [s]
  double wave_speed = 0.0;  ///< of a single record: along the track, backward where negative [m/s]; 0: everywhere alike
};

/// Everything a run needs, read from a TOML scene. Paths are relative to the scene file.
struct SceneParameters {
  std::string name;
  std::string text;                          ///< the TOML itself, kept with the results
  std::vector<std::filesystem::path> files;  ///< all that the scene names, in the order of their keys
  TrainParameters train;
  VehicleImport vehicle;  ///< where train.vehicle is imported_vehicle
  ContactParameters contact;
  TrackKind track_kind = TrackKind::flexible;
  TrackParameters track;
  std::vector<BridgeParameters> spans;  ///< none: no bridge
  ImportParameters structure;  ///< rails (TrackKind::imported) or a bridge under railtab's own track (flexible)
  ReductionParameters reduction;
  std::optional<std::filesystem::path> irregularity;
  std::optional<SpectrumParameters> spectrum;  ///< in place of a file: a random track
  std::optional<SpanDeviationParameters> span_deviation;
  std::vector<LoadParameters> loads;
  std::vector<ProfileParameters> profiles;  ///< that some coaches have in place of those of `contact`
  std::vector<WheelParameters> wheels;      ///< that are not round
  std::vector<GroundMotionParameters> ground_motion;
  IntegrationParameters integration;
  OutputParameters output;
  AssessmentParameters assessment;

  /// What no single key can tell: a table where contact.mode needs one, spans only on flexible track, integration.
  /// To be called again where a command changes a parameter. @throws InputError naming the keys.
  void validate() const;
};

/// A key whose value is not that of the scene's file.
struct KeyChange {
  std::string key;    ///< "train.speed"; of a [[bridge]] where there are several, "bridge.2.length" for the second
  std::string value;  ///< as TOML writes it, files relative to the scene; empty: the scene shall not have the key
};

/// Which of the files that a scene names have to be there: all, or those of [train], [vehicle] and [structure] alone,
/// for commands that use neither contact nor irregularity nor loads.
enum class SceneFiles { all, of_train_and_structure };

/// @param changes made in their order before the scene is read; its text says them in a comment at its end
/// @throws InputError with file and line: unknown key (with the nearest valid spelling), wrong type, value out of
/// range,
///         missing file; with the changes.
[[nodiscard]] SceneParameters read_scene(const std::filesystem::path& file, const std::vector<KeyChange>& changes = {},
                                         SceneFiles files = SceneFiles::all);

}  // namespace railtab
