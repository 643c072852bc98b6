#include <fstream>
#include <iterator>
#include <utility>

#include "railtab/fmi/driven_track.hpp"
#include "railtab/fmi/track_simulation.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/fe/abaqus_files.hpp"
#include "railtab/runtime/fe/fe_files.hpp"
#include "railtab/runtime/fe/fe_matrix.hpp"
#include "railtab/runtime/structure/fe_structure.hpp"
#include "railtab/runtime/structure/imported_bridge.hpp"
#include "railtab/runtime/structure/structure_import.hpp"
#include "railtab/runtime/structure/structure_summary.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vehicle/vehicle_file.hpp"
#include "railtab/runtime/vehicle/vehicle_import.hpp"
#include "railtab/runtime/vehicle/vehicle_modes.hpp"
#include "railtab/runtime/vehicle/vehicle_summary.hpp"
#include "reading.hpp"

namespace railtab::fuzz {

namespace {

void take_symmetric(const Path& file, const Eigen::SparseMatrix<double>& matrix) {
  constexpr Eigen::Index large = 10000;  // a line is enough to ask for a matrix of many rows without entries
  if (matrix.rows() <= large) static_cast<void>(symmetric_mean(file, matrix, 0));
}

Path beside(const Path& file, const char* name) { return file.parent_path() / name; }

/// Of a bridge of which one file is `file`.
ImportParameters bridge_files(const Path& file) {
  ImportParameters p;
  p.files = {FeFormat::matrix_market,         beside(file, "bridge_mass.mtx"), beside(file, "bridge_stiffness.mtx"), {},
             beside(file, "bridge_dofs.csv"), beside(file, "bridge_nodes.inp")};
  p.damping.ratio = 0.01;
  p.deck.set = "DECK";
  FeSupport ends;
  ends.nodes.set = "ENDS";
  ends.holds = {"x", "y", "z", "roll"};  // a line of nodes turns about itself else
  p.supports.push_back(ends);
  return p;
}

void take_bridge(const ImportParameters& parameters) {
  TrackParameters track;
  track.length_before = track.length_after = 3.0;
  try {
    static_cast<void>(summarise(read_on_supports(parameters), parameters.damping, 2));
    static_cast<void>(build_track_on_import(track, parameters));
  } catch (const ComputationError&) {  // of frequencies that are not found
  }
}

void take_modes(const Path& file, const Path& modes, const Path& shapes) {
  ImportParameters p = bridge_files(file);
  p.files = {};
  p.files.format = FeFormat::modes;
  p.files.nodes = beside(file, "bridge_nodes.inp");
  p.files.modes = modes;
  p.files.shapes = shapes;
  p.damping = {};
  TrackParameters track;
  track.length_before = track.length_after = 3.0;
  const StructureModel model = build_track_on_import(track, p);
  require_finite({model.mass.sum(), model.damping.sum(), model.stiffness.sum()}, "a matrix of a bridge by modes");
}

void take_vehicle(const Path& stiffness, const Path& dofs) {
  VehicleImport p;
  p.mass = beside(dofs, "vehicle_mass.mtx");
  p.damping = beside(dofs, "vehicle_damping.mtx");
  p.stiffness = stiffness;
  p.dofs = dofs;
  p.frame.axes = "x y z";
  p.wheelsets = {"ws1", "ws2"};
  p.car_body = "body";
  static_cast<void>(summarise(import_vehicle(p), 3));
}

}  // namespace

void read_matrix_market_file(const Path& file) { take_symmetric(file, read_matrix_market(file)); }
void read_calculix_file(const Path& file) { take_symmetric(file, read_calculix_matrix(file, 3)); }

void read_abaqus_file(const Path& file) { take_symmetric(file, read_abaqus_matrix(file, read_abaqus_rows(file, {}))); }

void read_abaqus_numbers(const Path& file) {
  take_symmetric(file, read_abaqus_matrix(file, read_abaqus_rows(file, beside(file, "bridge_dofs.csv"))));
}

void read_harwell_boeing_file(const Path& file) { take_symmetric(file, read_harwell_boeing(file)); }

void read_structure_table(const Path& file) {
  static_cast<void>(import_structure(
      {beside(file, "rails_mass.mtx"), beside(file, "rails_damping.mtx"), beside(file, "rails_stiffness.mtx"), file}));
}

void read_row_file(const Path& file) {
  ImportParameters bridge = bridge_files(file);
  bridge.files.dofs = file;
  take_bridge(bridge);
}

void read_node_file(const Path& file) {
  ImportParameters bridge = bridge_files(file);
  bridge.files.nodes = file;
  static_cast<void>(read_fe_mesh(file));
  take_bridge(bridge);
}

void read_mode_file(const Path& file) { take_modes(file, file, beside(file, "bridge_shapes.csv")); }
void read_shape_file(const Path& file) { take_modes(file, beside(file, "bridge_modes.csv"), file); }

void read_vehicle_file(const Path& file) { take_vehicle(beside(file, "vehicle_stiffness.mtx"), file); }
void read_vehicle_stiffness(const Path& file) { take_vehicle(file, beside(file, "vehicle_dofs.csv")); }

void read_vehicle_toml(const Path& file) {
  const VehicleData data = railtab::read_vehicle_file(file);
  const VehicleModel vehicle = build_vehicle(data, data.motion);
  static_cast<void>(closing_checks(data));
  for (const VehicleMode& mode : natural_modes(vehicle, 3)) require_finite({mode.frequency, mode.damping}, "a mode");
}

void read_fmu_track(const Path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  fmi::DrivenTrack track = fmi::track_of_bytes(bytes, file.string());
  constexpr int small = 2000;
  if (track.structure.dofs() > small) return;
  try {
    fmi::TrackSimulation simulation(std::move(track));
    simulation.set(2, 6e4);
    simulation.step(simulation.time_step());
    static_cast<void>(simulation.value(simulation.inputs()));
  } catch (const ComputationError&) {  // of matrices that are not positive definite
  }
}

void write_fmu_track_seed(const Path& file) {
  TrackParameters rails;
  rails.length_before = rails.length_after = 2.0;
  fmi::DrivenTrack track{"seed", {-0.05, 1e-3}, {0.5, 1.0}, build_track_bridge(rails, {})};
  std::ofstream(file, std::ios::binary) << fmi::track_bytes(track);
}

}  // namespace railtab::fuzz
