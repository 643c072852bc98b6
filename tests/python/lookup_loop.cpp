// The look-ups that lookup_ratio times from Python, as a C++ program makes them: lookup_loop TABLE.h5 MOTIONS ROUNDS
// MOTIONS: displacements of a wheelset, six doubles each. Prints the least seconds of three loops and the sums of what
// they find: wheel forces, forces with tangents, contact patches with what carries their load.

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>
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

double least_seconds(int rounds, const std::function<void()>& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return least;
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
  const int rounds = std::stoi(argv[3]);
  WheelContactModel model;
  model.geometry = &table.geometry;
  model.creep_law = creep_law("table", model.normal.material.nu);
  model.speed = 55.0;
  const RailHeadMotion rail;
  const std::size_t n = motions.size();
  std::vector<double> forces(9 * n), tangents(81 * n);
  std::vector<Row> rows;
  const auto contact_of = [&](const WheelsetMotion& motion) {
    return wheel_contact(table.geometry, relative_pose(table.geometry.pair(), WheelSide::right, motion, rail));
  };
  const auto put_force = [&](std::size_t i, const WheelContact& contact) {
    const WheelForce force = wheel_force(model, WheelSide::right, motions[i], rail, contact);
    Eigen::Map<Vector9> all(&forces[9 * i]);
    all << force.wheelset, force.rail;
  };
  const double force_seconds = least_seconds(rounds, [&] {
    for (std::size_t i = 0; i < n; ++i) put_force(i, contact_of(motions[i]));
  });
  const double tangent_seconds = least_seconds(rounds, [&] {
    for (std::size_t i = 0; i < n; ++i) {
      const WheelContact contact = contact_of(motions[i]);
      put_force(i, contact);
      Eigen::Map<Eigen::Matrix<double, 9, 9, Eigen::RowMajor>> all(&tangents[81 * i]);
      all = wheel_force_tangent(model, WheelSide::right, motions[i], rail, contact, {Vector6::Zero(), 0.0});
    }
  });
  const double contact_seconds = least_seconds(rounds, [&] {
    rows.clear();
    for (const WheelsetMotion& motion : motions) {
      const Vector6& q = motion.displacement;
      const WheelsetPose pose{q[1], q[2], q[3], q[5]};
      const ContactPatches patches = table.patches.patches(pose, 1e-13);
      const auto loads = patch_loadings(table.geometry, pose, patches);
      for (int i = 0; i < patches.count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        rows.push_back({patches.patch[at], loads[at]});
      }
    }
  });
  double force = 0.0, tangent = 0.0, normal = 0.0;
  for (const double value : forces) force += value;
  for (const double value : tangents) tangent += value;
  for (const Row& row : rows) normal += row.loading.normal_force;
  std::fputs(fmt::format("{} {} {} {} {} {}\n", force_seconds, tangent_seconds, contact_seconds, force, tangent, normal)
                 .c_str(),
             stdout);
}
