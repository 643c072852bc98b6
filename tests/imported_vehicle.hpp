// A coach as another program would write it: matrices of the free vehicle, every row a motion of a named body.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "folder_fixture.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vehicle/vehicle_import.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"

namespace railtab::testing {

struct BodyRow {
  std::string body;          ///< empty: an inner degree of freedom
  int motion;                ///< x, y, z, roll, pitch, yaw
  Eigen::Vector3d position;  ///< [m]
};

/// In railtab's axes and SI units.
struct FreeCoach {
  Eigen::MatrixXd mass, damping, stiffness;
  std::vector<BodyRow> rows;  ///< of the first rows; further ones are inner degrees of freedom

  [[nodiscard]] int row(const std::string& body, int motion) const {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (rows[r].body == body && rows[r].motion == motion) return static_cast<int>(r);
    }
    ADD_FAILURE() << body << " has no motion " << motion;
    return 0;
  }

  /// A mass on a spring under the car body's centre of gravity that moves along z alone; along x and y it rides with
  /// the car body.
  void hang_mass(double m, double k) {
    const auto n = mass.rows();
    for (Eigen::MatrixXd* matrix : {&mass, &damping, &stiffness}) {
      matrix->conservativeResizeLike(Eigen::MatrixXd::Zero(n + 1, n + 1));
    }
    for (int motion : {0, 1}) mass(row("CAR", motion), row("CAR", motion)) += m;
    mass(n, n) = m;
    const int z = row("CAR", 2);
    stiffness(z, z) += k;
    stiffness(n, n) = k;
    stiffness(z, n) = stiffness(n, z) = -k;
  }
};

inline constexpr VehicleWeight without_geometric_stiffness{standard_gravity, GeometricStiffness::omitted};

/// The built coach with its car body's x set free: springs know differences only, so that x of the car body does what
/// the opposite x of all others does.
inline FreeCoach free_coach(const CoachParameters& parameters = coach_parameters("manchester-coach"),
                            const VehicleWeight& weight = without_geometric_stiffness) {
  const VehicleModel coach = build_coach(parameters, MotionPlane::spatial, weight);
  const int n = coach.dofs();
  const std::vector<std::string> names{"CAR", "bogie-1", "bogie-2", "WS1", "WS2", "WS3", "WS4"};
  FreeCoach free;
  free.rows.assign(static_cast<std::size_t>(n + 1), {"CAR", 0, coach.bodies[0].position});
  Eigen::MatrixXd relative = Eigen::MatrixXd::Zero(n, n + 1);  // row 0 of the free coach: x of the car body
  relative.rightCols(n).setIdentity();
  for (std::size_t b = 0; b < coach.bodies.size(); ++b) {
    for (int k = 0; k < 6; ++k) {
      const int dof = coach.dof[b][static_cast<std::size_t>(k)];
      if (dof == held) continue;
      free.rows[static_cast<std::size_t>(dof + 1)] = {names[b], k, coach.bodies[b].position};
      if (k == 0) relative(dof, 0) = -1.0;
    }
  }
  free.stiffness = relative.transpose() * coach.stiffness * relative;
  free.damping = relative.transpose() * coach.damping * relative;
  free.mass = Eigen::MatrixXd::Zero(n + 1, n + 1);
  free.mass(0, 0) = parameters.car_body.mass;
  free.mass.bottomRightCorner(n, n) = coach.mass;
  return free;
}

/// Axes and units that a model is written in.
enum class Written { as_railtab, turned_in_millimetres };

/// A folder with the files of a vehicle.
class ImportedVehicle : public InFolder {
 protected:
  using InFolder::write;

  void write(const std::string& name, const Eigen::MatrixXd& matrix) const {
    std::string entries;
    long count = 0;
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        if (matrix(i, j) == 0.0) continue;
        ++count;
        entries += fmt::format("{} {} {:.17g}\n", i + 1, j + 1, matrix(i, j));
      }
    }
    write(name, fmt::format("%%MatrixMarket matrix coordinate real general\n{} {} {}\n{}", matrix.rows(), matrix.cols(),
                            count, entries));
  }

  /// m.mtx, c.mtx, k.mtx and dofs.csv. Turned: forward is the model's y, right its x, up its z.
  void write(const FreeCoach& coach, Written how = Written::as_railtab) const {
    constexpr const char* names[] = {"x", "y", "z", "rotx", "roty", "rotz"};
    const bool turned = how == Written::turned_in_millimetres;
    constexpr int of_model[] = {1, 0, 2, 4, 3, 5};
    constexpr double energy = 1e3;  // N mm in a joule
    Eigen::VectorXd to_model = Eigen::VectorXd::Ones(coach.mass.rows());
    std::string table = "row,body,motion,x,y,z\n";
    for (std::size_t r = 0; r < coach.rows.size(); ++r) {
      const auto& [body, motion, p] = coach.rows[r];
      if (body.empty()) continue;
      const Eigen::Vector3d at =
          turned ? Eigen::Vector3d(1e3 * p.y() + 250.0, 1e3 * p.x() - 40.0, -1e3 * p.z() + 1200.0) : p;
      if (turned) {
        to_model[static_cast<Eigen::Index>(r)] = (motion % 3 == 2 ? -1.0 : 1.0) * (motion < 3 ? 1e-3 : 1.0);
      }
      table += fmt::format("{},{},{},{:.17g},{:.17g},{:.17g}\n", r + 1, body, names[turned ? of_model[motion] : motion],
                           at.x(), at.y(), at.z());
    }
    const auto in_model = [&](const Eigen::MatrixXd& matrix) -> Eigen::MatrixXd {
      return (turned ? energy : 1.0) * (to_model.asDiagonal() * matrix * to_model.asDiagonal());
    };
    write("m.mtx", in_model(coach.mass));
    write("c.mtx", in_model(coach.damping));
    write("k.mtx", in_model(coach.stiffness));
    write("dofs.csv", table);
  }

  /// The scene's words for these files.
  [[nodiscard]] static std::string vehicle_section(Written how = Written::as_railtab) {
    const std::string frame = how == Written::as_railtab
                                  ? "axes = \"x y z\"\n"
                                  : "axes = \"y x -z\"\nunits = \"mm-N-t\"\norigin = [250.0, -40.0, 1200.0]\n";
    return "[vehicle]\nmass = \"m.mtx\"\ndamping = \"c.mtx\"\nstiffness = \"k.mtx\"\ndofs = \"dofs.csv\"\n"
           "wheelsets = [\"WS1\", \"WS2\", \"WS3\", \"WS4\"]\ncar_body = \"CAR\"\nlength = 26.4\n" +
           frame;
  }

  [[nodiscard]] VehicleImport files() const {
    VehicleImport import;
    import.mass = folder_ / "m.mtx";
    import.damping = folder_ / "c.mtx";
    import.stiffness = folder_ / "k.mtx";
    import.dofs = folder_ / "dofs.csv";
    import.frame.axes = "x y z";
    import.wheelsets = {"WS1", "WS2", "WS3", "WS4"};
    import.car_body = "CAR";
    return import;
  }

  /// Without geometric stiffness, which an import distributes by an assumption.
  [[nodiscard]] SceneParameters scene(const std::string& text) const {
    write("scene.toml", text);
    SceneParameters scene = read_scene(folder_ / "scene.toml");
    scene.train.geometric_stiffness = GeometricStiffness::omitted;
    return scene;
  }
};

}  // namespace railtab::testing
