#include "readers.hpp"

#include <unistd.h>

#include <fstream>

#include "../../runtime/vehicle/vehicle_table.hpp"
#include "../unit/small_geometry_table.hpp"
#include "csv_table.hpp"
#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/structure/fe_files.hpp"
#include "railtab/runtime/structure/structure_import.hpp"
#include "railtab/runtime/track/irregularity.hpp"
#include "railtab/tables/creep_table.hpp"
#include "railtab/tables/creep_table_file.hpp"
#include "railtab/tables/geometry_table.hpp"
#include "railtab/tables/geometry_table_file.hpp"
#include "railtab/tables/input_error.hpp"

namespace railtab::fuzz {
namespace {

using Path = std::filesystem::path;

void read_wheel(const Path& file) { static_cast<void>(ProfileCurve(read_profile_file(file, ProfileKind::wheel))); }
void read_rail(const Path& file) { static_cast<void>(ProfileCurve(read_profile_file(file, ProfileKind::rail))); }

void read_geometry(const Path& file) { static_cast<void>(GeometryTable(read_geometry_table(file))); }

void read_creep(const Path& file) { static_cast<void>(CreepTable(read_creep_table(file))); }

void read_result(const Path& file) {
  static_cast<void>(read_results(file));
  static_cast<void>(ResultWriter::read_checkpoint(file));
}

void write_geometry_seed(const Path& file) { write_geometry_table(file, small_geometry_table()); }

void copy_creep_seed(const Path& file) {
  std::filesystem::copy_file(RAILTAB_SOURCE_DIR "/tables/data/creep_table_nu028.h5", file);
}

void write_result_seed(const Path& file) {
  ResultHeader header;
  header.wheel_x = {0.0, 0.0};
  header.static_wheel_load = {1.0, 1.0};
  header.body_names = {"body"};
  ResultWriter out(file, header, 2);
  for (int i = 0; i < 5; ++i) {
    StepRecord record;
    record.time = i;
    record.wheels.resize(2);
    record.bodies.resize(1);
    out.append(record);
  }
  out.checkpoint(std::vector<double>{1.0, 2.0, 3.0}, 5);
}

/// The matrices stay; the table of their rows is what is read.
void read_dof_table(const Path& file) {
  const Path matrix = file.parent_path() / "matrix.mtx";
  if (!std::filesystem::exists(matrix)) {
    std::ofstream(matrix) << "%%MatrixMarket matrix coordinate real symmetric\n4 4 4\n1 1 2\n2 2 2\n3 3 2\n4 4 2\n";
  }
  static_cast<void>(import_structure({matrix, matrix, matrix, file}));
}

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all{
      {"simpack_wheel", ".prw", read_wheel, nullptr},
      {"simpack_rail", ".prr", read_rail, nullptr},
      {"miniprof_wheel", ".whl", read_wheel, nullptr},
      {"miniprof_rail", ".ban", read_rail, nullptr},
      {"two_columns", ".txt", read_wheel, nullptr},
      {"scene", ".toml", [](const Path& file) { static_cast<void>(read_scene(file)); }, nullptr},
      {"matrix_market", ".mtx", [](const Path& file) { static_cast<void>(read_matrix_market(file)); }, nullptr},
      {"calculix_matrix", ".sti", [](const Path& file) { static_cast<void>(read_calculix_matrix(file, 3)); }, nullptr},
      {"calculix_rows", ".dof", [](const Path& file) { static_cast<void>(read_calculix_rows(file)); }, nullptr},
      {"harwell_boeing", ".matrix", [](const Path& file) { static_cast<void>(read_harwell_boeing(file)); }, nullptr},
      {"ansys_rows", ".mapping", [](const Path& file) { static_cast<void>(read_ansys_rows(file)); }, nullptr},
      {"fe_mesh", ".inp", [](const Path& file) { static_cast<void>(read_fe_mesh(file)); }, nullptr},
      {"structure_dofs", ".csv", read_dof_table, nullptr},
      {"vehicle_dofs", ".csv", [](const Path& file) { static_cast<void>(read_vehicle_table(file, 12)); }, nullptr},
      {"irregularity", ".csv", [](const Path& file) { static_cast<void>(read_irregularity(file)); }, nullptr},
      {"creep_queries", ".csv",
       [](const Path& file) {
         static_cast<void>(vsi::read_csv(file, {"ratio", "ux", "uy", "phi"}));
       },
       nullptr},
      {"geometry_table", ".h5", read_geometry, write_geometry_seed},
      {"creep_table", ".h5", read_creep, copy_creep_seed},
      {"results", ".h5", read_result, write_result_seed},
  };
  return all;
}

const Reader& reader(const std::string& name) {
  for (const Reader& candidate : readers()) {
    if (candidate.name == name) return candidate;
  }
  throw input_error("reader", name, "one of the list");
}

bool accepts(const Reader& reader, const std::string& bytes) {
  static const Path folder = [] {
    Path own = std::filesystem::temp_directory_path() / ("railtab_fuzz_" + std::to_string(::getpid()));
    std::filesystem::create_directories(own);
    return own;
  }();
  const Path file = folder / ("input" + reader.extension);
  std::ofstream(file, std::ios::binary) << bytes;
  try {
    reader.read(file);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace railtab::fuzz
