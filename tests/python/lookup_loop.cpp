// The look-ups that lookup_ratio times from Python, as a C++ program makes them: lookup_loop TABLE.h5 MOTIONS LOOP
// MOTIONS: displacements of a wheelset, six doubles each; LOOP: forces, tangents or contacts. Prints the loop's CPU
// seconds and the sum of what it finds.

#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "railtab/runtime/contact/frictionless_contact.hpp"
#include "railtab/runtime/contact_files/contact_table_file.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"

namespace {

using namespace railtab;

std::vector<WheelsetMotion> motions_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<WheelsetMotion> motions;
  for (WheelsetMotion motion; in.read(reinterpret_cast<char*>(motion.displacement.data()), 6 * sizeof(double));) {
    motions.push_back(motion);
  }
  return motions;
}

struct Row {
  ContactPatch patch;
  PatchLoading loading;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const ContactTable table = read_contact_table(argv[1]);
  const std::vector<WheelsetMotion> motions = motions_of(argv[2]);
  const std::string loop = argv[3];
  WheelContactModel model;
  model.geometry = &table.geometry;
  model.creep_law = creep_law("table", model.normal.material.nu);
  model.speed = 55.0;
  const RailHeadMotion rail;
  const std::size_t n = motions.size();
  const bool tangents_too = loop == "tangents";
  std::vector<double> forces(9 * n), tangents(tangents_too ? 81 * n : 0);
  std::vector<Row> rows;
  const auto put_forces = [&] {
    for (std::size_t i = 0; i < n; ++i) {
      Eigen::Map<Vector9> all(&forces[9 * i]);
      const auto put = [&](const WheelForce& force) { all << force.wheelset, force.rail; };
      if (tangents_too) {
        const WheelResponse response =
            wheel_response(model, WheelSide::right, motions[i], rail, {Vector6::Zero(), 0.0});
        put(response.force);
        Eigen::Map<Eigen::Matrix<double, 9, 9, Eigen::RowMajor>> tangent(&tangents[81 * i]);
        tangent = response.tangent;
      } else {
        const WheelsetPose pose = relative_pose(table.geometry.pair(), WheelSide::right, motions[i], rail);
        put(wheel_force(model, WheelSide::right, motions[i], rail, wheel_contact(table.geometry, pose)));
      }
    }
  };
  const auto put_contacts = [&] {
    rows.reserve(n);
    for (const WheelsetMotion& motion : motions) {
      const Vector6& q = motion.displacement;
      const WheelsetPose pose{q[1], q[2], q[3], q[5]};
      const ContactPatches patches = table.patches.patches(pose, 1e-13);
      const auto loads = patch_loadings(table.geometry, pose, patches, table_material(table.geometry));
      for (int i = 0; i < patches.count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        rows.push_back({patches.patch[at], loads[at]});
      }
    }
  };
  const std::clock_t begin = std::clock();
  if (loop == "contacts") {
    put_contacts();
  } else {
    put_forces();
  }
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  double sum = 0.0;
  for (const Row& row : rows) sum += row.loading.normal_force;
  for (const double value : tangents_too ? tangents : forces) sum += value;
  std::fputs(fmt::format("{} {}\n", seconds, sum).c_str(), stdout);
}
