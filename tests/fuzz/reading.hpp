#pragma once

#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <stdexcept>
#include <string>

/// What the fuzzed readers' answers are fed to: files that are accepted must give numbers.
namespace railtab::fuzz {

using Path = std::filesystem::path;

/// @throws std::logic_error: what was accepted leads to infinities
inline void require_finite(std::initializer_list<double> values, const char* what) {
  for (const double value : values) {
    if (!std::isfinite(value)) throw std::logic_error(std::string(what) + " is not finite");
  }
}

// run_files.cpp: what a run reads beside its models
void read_irregularity_file(const Path& file);
void read_load_file(const Path& file);
/// The load of a gust by its coefficients; of a history of wind by given ones.
void read_aerodynamics_file(const Path& file);
void read_wind_file(const Path& file);
void read_ground_file(const Path& file);
void read_speed_file(const Path& file);
void read_scene_file(const Path& file);
/// The scene, its model where it is small, and two steps of it.
void run_scene_file(const Path& file);
/// A line for every key and every heading of a scene.
std::string scene_vocabulary();

// model_files.cpp: structures and vehicles of other programs
void read_matrix_market_file(const Path& file);
void read_calculix_file(const Path& file);
void read_abaqus_file(const Path& file);
void read_abaqus_numbers(const Path& file);
void read_harwell_boeing_file(const Path& file);
/// Rails by the table of their rows; the matrices stay.
void read_structure_table(const Path& file);
/// A bridge by the table of its rows, by its nodes; what else it needs stays.
void read_row_file(const Path& file);
void read_node_file(const Path& file);
/// The same bridge by two modes: by their table, by their shapes.
void read_mode_file(const Path& file);
void read_shape_file(const Path& file);
/// A vehicle by the table of its rows, or by its stiffness.
void read_vehicle_file(const Path& file);
void read_vehicle_stiffness(const Path& file);
/// A vehicle's TOML file, its model and modes.
void read_vehicle_toml(const Path& file);
/// What an FMU has of a scene, and the motion of it where it is small.
void read_fmu_track(const Path& file);
void write_fmu_track_seed(const Path& file);

// table_files.cpp: HDF5
void read_geometry_file(const Path& file);
void read_creep_file(const Path& file);
void read_result_file(const Path& file);
void write_geometry_seed(const Path& file);
void write_creep_seed(const Path& file);
void write_result_seed(const Path& file);
/// Tables and checkpoints as no file with a right checksum has them: the lines "name index value" of the file are
/// changes of their numbers, "name size n" of their lengths.
void change_geometry_numbers(const Path& file);
void change_creep_numbers(const Path& file);
void change_checkpoint_numbers(const Path& file);

// tablegen_files.cpp
void read_batch_file(const Path& file);
/// A creep table under way, which the next run of its job goes on with.
void read_creep_partial(const Path& file);
void write_creep_partial_seed(const Path& file);

}  // namespace railtab::fuzz
