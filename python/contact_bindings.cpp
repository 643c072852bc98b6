#include <pybind11/stl/filesystem.h>

#include <memory>

#include "bindings.hpp"
#include "geometry.hpp"
#include "profile.hpp"
#include "railtab/runtime/contact/frictionless_contact.hpp"
#include "rows.hpp"

namespace railtab::python {

/// One contact patch of one query, a row of the array that contacts() returns.
struct ContactRow {
  std::int64_t query;
  std::int32_t patch;
  bool concave, from_table;
  double y_rail, z_rail, y_wheel, z_wheel, x_contact, angle, rolling_radius, penetration, curv_wheel, curv_rail,
      normal_force, a, b, pressure;
};

namespace {

using OptionalDoubles = std::optional<Doubles>;

/// Poses of a wheelset, given by the lowering below first touch, the height of its centre, or the load.
class Poses {
 public:
  enum class By { lowering, height, load };
  Poses(const Geometry& geometry, const char* call, const Doubles& y, const OptionalDoubles& dz,
        const OptionalDoubles& z, const OptionalDoubles& load, const Doubles& roll, const Doubles& yaw)
      : geometry_(geometry), rows_(call) {
    if (dz.has_value() + z.has_value() + load.has_value() != 1) {
      throw input_error(call, fmt::format("{} of dz, z and load", dz.has_value() + z.has_value() + load.has_value()),
                        "one: the lowering below first touch dz [m], the height z [m], or the vertical load [N]");
    }
    by_ = dz ? By::lowering : z ? By::height : By::load;
    y_ = rows_.add("y", y);
    vertical_ = rows_.add(dz ? "dz" : z ? "z" : "load", dz ? *dz : z ? *z : *load);
    roll_ = rows_.add("roll", roll);
    yaw_ = rows_.add("yaw", yaw);
    rows_.broadcast();
  }

  [[nodiscard]] const Rows& rows() const noexcept { return rows_; }

  /// @throws InputError where wheel and rail never meet, or the lowering or the load is out of range
  [[nodiscard]] WheelsetPose operator()(py::ssize_t i) const {
    const double vertical = rows_.value(vertical_, i);
    const WheelsetPose pose{rows_.value(y_, i), vertical, rows_.value(roll_, i), rows_.value(yaw_, i)};
    if (by_ == By::height) return pose;
    return lowered_pose(geometry_.search(), geometry_.contact(), pose,
                        by_ == By::lowering ? Lowering::given : Lowering::under_load, vertical,
                        table_material(geometry_.contact()),
                        [&] { return fmt::format("{}: query {}", rows_.call(), i); })
        .pose;
  }

 private:
  const Geometry& geometry_;
  Rows rows_;
  By by_ = By::lowering;
  std::size_t y_ = 0, vertical_ = 0, roll_ = 0, yaw_ = 0;
};

/// An array that owns the rows.
py::array_t<ContactRow> array_of(std::vector<ContactRow> rows) {
  auto owner = std::make_unique<std::vector<ContactRow>>(std::move(rows));
  const std::vector<ContactRow>& kept = *owner;
  const py::capsule capsule(owner.release(), [](void* data) { delete static_cast<std::vector<ContactRow>*>(data); });
  return py::array_t<ContactRow>(static_cast<py::ssize_t>(kept.size()), kept.data(), capsule);
}

void append_contacts(const Geometry& geometry, const WheelsetPose& pose, std::int64_t query,
                     std::vector<ContactRow>& rows) {
  const ContactPatches patches = geometry.patches(pose);
  const std::array<PatchLoading, ContactPatches::capacity> loads =
      patch_loadings(geometry.contact(), pose, patches, table_material(geometry.contact()));
  for (int i = 0; i < patches.count; ++i) {
    const ContactPatch& p = patches.patch[static_cast<std::size_t>(i)];
    const PatchLoading& load = loads[static_cast<std::size_t>(i)];
    rows.push_back({query, i, p.concave, p.source == PatchSource::table, p.y_rail, p.z_rail, p.y_wheel, p.z_wheel,
                    p.x + 0.0, p.angle, p.rolling_radius, std::max(0.0, p.penetration), p.curv_wheel, p.curv_rail,
                    load.normal_force, load.a, load.b, load.pressure});
  }
}

py::array_t<ContactRow> contacts(const Geometry& geometry, const Doubles& y, const OptionalDoubles& dz,
                                 const OptionalDoubles& z, const OptionalDoubles& load, const Doubles& roll,
                                 const Doubles& yaw) {
  const Poses poses(geometry, "contacts", y, dz, z, load, roll, yaw);
  std::vector<ContactRow> rows;
  {
    const py::gil_scoped_release release;
    rows.reserve(static_cast<std::size_t>(poses.rows().count()));
    for (py::ssize_t i = 0; i < poses.rows().count(); ++i) append_contacts(geometry, poses(i), i, rows);
  }
  return array_of(std::move(rows));
}

py::array_t<double> rail_force(const Geometry& geometry, const Doubles& y, const OptionalDoubles& dz,
                               const OptionalDoubles& z, const OptionalDoubles& load, const Doubles& roll,
                               const Doubles& yaw) {
  const Poses poses(geometry, "rail_force", y, dz, z, load, roll, yaw);
  py::array_t<double> result = poses.rows().result({3});
  double* out = result.mutable_data();
  const py::gil_scoped_release release;
  for (py::ssize_t i = 0; i < poses.rows().count(); ++i, out += 3) {
    Eigen::Map<Vector3> force(out);
    force = frictionless_force(geometry.contact(), poses(i), table_material(geometry.contact()));
  }
  return result;
}

py::array_t<double> heights(const Geometry& geometry, const Doubles& y, const OptionalDoubles& dz,
                            const OptionalDoubles& load, const Doubles& roll, const Doubles& yaw) {
  const bool neither = !dz && !load;
  const Poses poses(geometry, "height", y, neither ? OptionalDoubles(py::float_(0.0)) : dz, std::nullopt, load, roll,
                    yaw);
  py::array_t<double> result = poses.rows().result();
  double* out = result.mutable_data();
  const py::gil_scoped_release release;
  for (py::ssize_t i = 0; i < poses.rows().count(); ++i) out[i] = poses(i).z;
  return result;
}

py::dict dimensions(const PairDimensions& of) {
  using namespace py::literals;
  return py::dict("gauge"_a = of.track_gauge, "gauge_height"_a = of.gauge_height, "flange_back"_a = of.flange_back,
                  "nominal_radius"_a = of.nominal_radius);
}

py::dict table_info(const TableGeometry& geometry) {
  using namespace py::literals;
  const GeometryTableData& data = geometry.table().data();
  py::dict info("wheel"_a = data.wheel.name, "rail"_a = data.rail.name, "tolerance"_a = data.tolerance,
                "lateral"_a = py::make_tuple(data.lateral.low, data.lateral.high),
                "largest_yaw"_a = std::sqrt(data.yaw_squared.high),
                "roll"_a = py::make_tuple(data.roll.low, data.roll.high),
                "loaded"_a = geometry.contact().loaded() != nullptr,
                "unused_loaded_error"_a = geometry.contact().unused_loaded_error(),
                "bytes"_a = geometry.table().bytes(), "program_version"_a = data.provenance.program_version,
                "command_line"_a = data.provenance.command_line, "created"_a = data.provenance.created);
  for (const auto& [name, value] : data.statistics) info[py::str(name)] = value;
  return info;
}

std::unique_ptr<SearchGeometry> search_of(const Profile& wheel, const Profile& rail, const PairDimensions& dimensions) {
  return std::make_unique<SearchGeometry>(ContactSearch(WheelRailPair(wheel.curve, rail.curve, dimensions)));
}

void bind_geometry(py::module_& module) {
  py::class_<Geometry> geometry(
      module, "ContactGeometry",
      R"(The contact of a wheel on its rail: what GeometryTable and ContactSearch have in common.

    Poses are those of a wheelset against its right rail: lateral shift y of its centre [m], roll and yaw [rad]; and one
    of dz, its lowering below first touch [m], z, its height below the nominal one [m], or load, the vertical force that
    the wheel carries without friction [N]. The left wheel is the query (-y, -roll, -yaw), with lateral coordinates and
    angles negated. All arguments are numbers or arrays that NumPy broadcasts. Other Python threads run meanwhile.)");
  of_package(geometry);
  const auto y = py::arg("y");
  const auto dz = py::arg("dz") = py::none(), z = py::arg("z") = py::none(), load = py::arg("load") = py::none(),
             roll = py::arg("roll") = 0.0, yaw = py::arg("yaw") = 0.0;
  geometry.def("contacts", &contacts, y, dz, py::kw_only(), z, load, roll, yaw,
               R"(Contact patches of each pose, one row per patch, in the order of the queries and of y_rail.

    Returns a structured array, shape (patches,), which pandas.DataFrame takes as it is:

    query                 index of the pose in the broadcast arguments (flat)
    patch                 counted from 0 in each query
    concave, from_table   the wheel is concave there; the table found the patch, not the online search
    y_rail, z_rail        on the rail profile [m]
    y_wheel, z_wheel      on the wheel profile [m]
    x_contact             ahead of the wheelset's centre [m]
    angle                 contact angle, negative on the right wheel [rad]
    rolling_radius        distance to the axle [m]
    penetration           [m]
    curv_wheel, curv_rail lateral curvatures, convex positive [1/m]
    normal_force          without friction [N]
    a, b                  semi-axes along and across the rolling direction [m]
    pressure              largest [Pa]

    Forces are those of the table's loaded part where it has one that is certified to 5 %, else of
    Hertz's ellipse of steel.

    >>> table.contacts(0.001, load=60e3)["rolling_radius"].round(4)
    array([0.4605])
    )");
  geometry.def("rail_force", &rail_force, y, dz, py::kw_only(), z, load, roll, yaw,
               R"(Force on the rail without friction, shape (..., 3): F_y, F_z [N] and the moment about x through the
    rail-head origin [N m].

    >>> table.rail_force([0.0, 0.001], load=60e3)[:, 1].round(3)
    array([60000., 60000.])
    )");
  geometry.def("height", &heights, y, py::kw_only(), dz, load, roll, yaw,
               R"(z of the wheelset at first touch, or dz [m] below it, or where the wheel carries a load [N]: shape
    (...) [m].

    >>> bool(table.height(0.0, load=60e3) > table.height(0.0))
    True
    )");
  geometry.def_property_readonly(
      "wheel", [](const Geometry& g) { return Profile{g.search().pair().wheel()}; }, "The wheel's Profile.");
  geometry.def_property_readonly(
      "rail", [](const Geometry& g) { return Profile{g.search().pair().rail()}; }, "The rail's Profile.");
  geometry.def_property_readonly(
      "dimensions", [](const Geometry& g) { return dimensions(g.search().pair().dimensions()); },
      "gauge, gauge_height, flange_back, nominal_radius [m].");
}

}  // namespace

void bind_contact(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(ContactRow, query, patch, concave, from_table, y_rail, z_rail, y_wheel, z_wheel, x_contact,
                       angle, rolling_radius, penetration, curv_wheel, curv_rail, normal_force, a, b, pressure);
  bind_geometry(module);
  py::class_<SearchGeometry, Geometry> search(module, "ContactSearch",
                                              "The online search, for pairs without a table: slower, and exact.");
  of_package(search);
  search.def(py::init([](const Profile& wheel, const Profile& rail, double gauge, double gauge_height,
                         double flange_back, double wheel_radius) {
               return search_of(wheel, rail, {gauge, gauge_height, flange_back, wheel_radius});
             }),
             py::arg("wheel"), py::arg("rail"), py::kw_only(), py::arg("gauge") = PairDimensions{}.track_gauge,
             py::arg("gauge_height") = PairDimensions{}.gauge_height,
             py::arg("flange_back") = PairDimensions{}.flange_back,
             py::arg("wheel_radius") = PairDimensions{}.nominal_radius, "Lengths in m, as of tablegen geometry.");
  search.def("__repr__", [](const SearchGeometry& g) {
    const WheelRailPair& pair = g.search().pair();
    return fmt::format("<railtab.ContactSearch {} on {}>", pair.wheel().knots().name, pair.rail().knots().name);
  });
  py::class_<TableGeometry, Geometry> table(module, "GeometryTable", R"(A contact table of tablegen geometry.

    Where a query leaves the table, the online search answers.

    >>> table
    <railtab.GeometryTable S1002 on 60E1>
    )");
  of_package(table);
  table.def_static(
      "open",
      [](const std::filesystem::path& file) {
        const py::gil_scoped_release release;
        return std::make_unique<TableGeometry>(read_contact_table(file));
      },
      py::arg("file"), "Reads a table's file. Raises InputError where it is none, or damaged.");
  table.def_property_readonly(
      "info", &table_info,
      "dict: profiles, ranges [m, rad], whether there is a loaded part, size in memory [bytes], "
      "provenance, measured errors.");
  table.def(
      "online",
      [](const TableGeometry& g) {
        const WheelRailPair& pair = g.search().pair();
        return search_of({pair.wheel()}, {pair.rail()}, pair.dimensions());
      },
      "The ContactSearch of the same pair.");
  table.def("__repr__", [](const TableGeometry& g) {
    const GeometryTableData& data = g.table().data();
    return fmt::format("<railtab.GeometryTable {} on {}>", data.wheel.name, data.rail.name);
  });
}

}  // namespace railtab::python
