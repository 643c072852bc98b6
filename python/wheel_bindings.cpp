
#include <memory>
#include <variant>

#include "bindings.hpp"
#include "geometry.hpp"
#include "law.hpp"
#include "railtab/runtime/contact/contact_response.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"
#include "rows.hpp"

namespace railtab::python {
namespace {

using OptionalDoubles = std::optional<Doubles>;

/// A wheel's contact model with what it refers to; the geometry lives as long as the Python object that has it.
struct Wheel {
  const Geometry* geometry;
  WheelContactModel model;
};

WheelSide wheel_side(const std::string& name) {
  if (name == "right") return WheelSide::right;
  if (name == "left") return WheelSide::left;
  throw input_error("WheelContact", fmt::format("the side \"{}\"", name), "right or left");
}

Doubles zeros(std::size_t count) { return Doubles(py::array_t<double>(py::cast(std::vector<double>(count)))); }

/// Motions of a wheelset and of the rail head under one of its wheels.
class Motions {
 public:
  struct Arguments {
    Doubles wheelset;
    OptionalDoubles wheelset_velocity, rail, rail_velocity;
    Doubles rail_yaw, rail_slope, rail_friction;
    std::string side;
  };
  Motions(const char* call, const Arguments& of) : rows_(call), side_(wheel_side(of.side)) {
    q_ = rows_.add("wheelset", of.wheelset, {6});
    v_ = rows_.add("wheelset_velocity", of.wheelset_velocity.value_or(zeros(6)), {6});
    rail_ = rows_.add("rail", of.rail.value_or(zeros(3)), {3});
    rail_v_ = rows_.add("rail_velocity", of.rail_velocity.value_or(zeros(3)), {3});
    yaw_ = rows_.add("rail_yaw", of.rail_yaw);
    slope_ = rows_.add("rail_slope", of.rail_slope);
    friction_ = rows_.add("rail_friction", of.rail_friction);
    rows_.broadcast();
  }
  [[nodiscard]] const Rows& rows() const noexcept { return rows_; }
  [[nodiscard]] WheelSide side() const noexcept { return side_; }
  [[nodiscard]] WheelsetMotion wheelset(py::ssize_t i) const noexcept {
    return {Eigen::Map<const Vector6>(rows_.row(q_, i)), Eigen::Map<const Vector6>(rows_.row(v_, i))};
  }
  [[nodiscard]] RailHeadMotion rail(py::ssize_t i) const noexcept {
    return {Eigen::Map<const Vector3>(rows_.row(rail_, i)), Eigen::Map<const Vector3>(rows_.row(rail_v_, i)),
            rows_.value(yaw_, i), rows_.value(slope_, i), rows_.value(friction_, i)};
  }

 private:
  Rows rows_;
  WheelSide side_;
  std::size_t q_ = 0, v_ = 0, rail_ = 0, rail_v_ = 0, yaw_ = 0, slope_ = 0, friction_ = 0;
};

void put_force(const WheelForce& force, double* out) noexcept {
  Eigen::Map<Vector9> all(out);
  all << force.wheelset, force.rail;
}

py::array_t<double> force(const Wheel& wheel, const Motions::Arguments& arguments) {
  const Motions motions("WheelContact.force", arguments);
  py::array_t<double> result = motions.rows().result({9});
  double* out = result.mutable_data();
  const py::gil_scoped_release release;
  for (py::ssize_t i = 0; i < motions.rows().count(); ++i, out += 9) {
    const WheelsetMotion wheelset = motions.wheelset(i);
    const RailHeadMotion rail = motions.rail(i);
    const ContactGeometry& geometry = wheel.geometry->contact();
    const WheelContact at = wheel_contact(geometry, relative_pose(geometry.pair(), motions.side(), wheelset, rail));
    put_force(wheel_force(wheel.model, motions.side(), wheelset, rail, at), out);
  }
  return result;
}

py::tuple force_and_tangent(const Wheel& wheel, const Motions::Arguments& arguments, double velocity_rate) {
  if (!std::isfinite(velocity_rate)) {
    throw input_error("WheelContact.force_and_tangent", fmt::format("velocity_rate = {}", velocity_rate), "a number");
  }
  const Motions motions("WheelContact.force_and_tangent", arguments);
  py::array_t<double> force = motions.rows().result({9}), tangent = motions.rows().result({9, 9});
  double *out = force.mutable_data(), *slopes = tangent.mutable_data();
  const StepRates rates{Vector6::Constant(velocity_rate), velocity_rate};
  {
    const py::gil_scoped_release release;
    for (py::ssize_t i = 0; i < motions.rows().count(); ++i, out += 9, slopes += 81) {
      const WheelResponse response =
          wheel_response(wheel.model, motions.side(), motions.wheelset(i), motions.rail(i), rates);
      put_force(response.force, out);
      Eigen::Map<Eigen::Matrix<double, 9, 9, Eigen::RowMajor>> all(slopes);
      all = response.tangent;
    }
  }
  return py::make_tuple(force, tangent);
}

void require(bool holds, const char* name, double found, const char* expected) {
  if (!holds) throw input_error("WheelContact", fmt::format("{} = {}", name, found), expected);
}

Wheel make_wheel(const Geometry& geometry, double speed, const std::variant<std::string, Law*>& law, double friction,
                 double damping, const ElasticMaterial& material) {
  material.validate();
  require(std::isfinite(speed) && speed > 0.0, "speed", speed, "above 0 m/s");
  require(friction >= 0.0 && friction <= 2.0, "friction", friction, "0 to 2");
  require(std::isfinite(damping) && damping >= 0.0, "damping", damping, "0 s/m or more");
  if (const LoadedTable* const loaded = geometry.contact().loaded()) {
    const double modulus = loaded->data().contact_modulus;
    if (!material.has_contact_modulus(modulus)) {
      throw input_error("WheelContact",
                        fmt::format("steel of the contact modulus {:.6g} Pa", material.contact_modulus()),
                        fmt::format("{:.6g} Pa, that of the table's loaded part", modulus));
    }
  }
  WheelContactModel model;
  model.geometry = &geometry.contact();
  model.normal.material = material;
  const auto* const named = std::get_if<std::string>(&law);
  model.creep_law = named ? creep_law(*named, material.nu) : std::get<Law*>(law)->law;
  model.friction = friction;
  model.damping = damping;
  model.speed = speed;
  return {&geometry, std::move(model)};
}

}  // namespace

void bind_wheel(py::module_& module) {
  py::class_<Wheel> wheel(module, "WheelContact", R"(Forces between the wheels of a wheelset and their rails.

    geometry   GeometryTable or ContactSearch
    speed      running speed, what creepages are relative to [m/s]
    law        name of a creep law, or a CreepLaw
    friction   coefficient [-]
    damping    of the normal force, F (1 + damping d') [s/m]
    young, poisson   of wheel and rail [Pa], [-]

    Motions are in the track frame, x forward, y right, z down. Of the wheelset (..., 6): x, y, z [m], roll, pitch, yaw
    [rad], its displacement from the centred position on undeflected rails; of the rail head (..., 3): y, z [m], roll
    [rad]. railtab.displacement() makes one of y, z, roll and yaw.

    >>> contact = railtab.WheelContact(table, speed=55.0)
    >>> q = railtab.displacement(y=np.linspace(-1e-3, 1e-3, 5), z=table.height(0.0, load=60e3))
    >>> force, tangent = contact.force_and_tangent(q)
    >>> force.shape, tangent.shape
    ((5, 9), (5, 9, 9))
    )");
  of_package(wheel);
  wheel.def(py::init([](const Geometry& geometry, double speed, const std::variant<std::string, Law*>& law,
                        double friction, double damping, double young, double poisson) {
              return make_wheel(geometry, speed, law, friction, damping, {young, poisson});
            }),
            py::keep_alive<1, 2>(), py::arg("geometry"), py::kw_only(), py::arg("speed"), py::arg("law") = "table",
            py::arg("friction") = 0.3, py::arg("damping") = 0.0, py::arg("young") = ElasticMaterial{}.E,
            py::arg("poisson") = ElasticMaterial{}.nu);
  const auto wheelset = py::arg("wheelset");
  const auto velocity = py::arg("wheelset_velocity") = py::none(), rail = py::arg("rail") = py::none(),
             rail_velocity = py::arg("rail_velocity") = py::none(), rail_yaw = py::arg("rail_yaw") = 0.0,
             rail_slope = py::arg("rail_slope") = 0.0, rail_friction = py::arg("rail_friction") = 1.0,
             side = py::arg("side") = "right";
  wheel.def(
      "force",
      [](const Wheel& w, const Doubles& q, const OptionalDoubles& v, const OptionalDoubles& r,
         const OptionalDoubles& rv, const Doubles& yaw, const Doubles& slope, const Doubles& mu,
         const std::string& of_side) {
        return force(w, {q, v, r, rv, yaw, slope, mu, of_side});
      },
      wheelset, velocity, rail, rail_velocity, py::kw_only(), rail_yaw, rail_slope, rail_friction, side,
      R"(Forces, shape (..., 9): six on the wheelset, x, y, z [N] and moments about its centre [N m], then y, z [N]
    on the rail head and the moment about x through its origin [N m].

    wheelset, wheelset_velocity   (..., 6) [m, rad], per second; velocity beside the running speed
    rail, rail_velocity           (..., 3) of the rail head there
    rail_yaw, rail_slope          its slopes dy/dx and dz/dx (...) [-]
    rail_friction                 coefficient of friction there over the model's (...) [-]
    side                          right or left)");
  wheel.def(
      "force_and_tangent",
      [](const Wheel& w, const Doubles& q, const OptionalDoubles& v, const OptionalDoubles& r,
         const OptionalDoubles& rv, const Doubles& yaw, const Doubles& slope, const Doubles& mu,
         const std::string& of_side, double rate) {
        return force_and_tangent(w, {q, v, r, rv, yaw, slope, mu, of_side}, rate);
      },
      wheelset, velocity, rail, rail_velocity, py::kw_only(), rail_yaw, rail_slope, rail_friction, side,
      py::arg("velocity_rate") = 0.0,
      R"(force(), and its derivative with respect to wheelset and rail: shape (..., 9, 9).

    velocity_rate   dv/dq of a time step, gamma/(beta dt) of Newmark's rule [1/s]; 0: velocities stay)");
}

}  // namespace railtab::python
