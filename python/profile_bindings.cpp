#include <pybind11/stl/filesystem.h>

#include "bindings.hpp"
#include "profile.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "rows.hpp"

namespace railtab::python {
namespace {

ProfileKind profile_kind(const std::string& name) {
  if (name == "wheel") return ProfileKind::wheel;
  if (name == "rail") return ProfileKind::rail;
  throw input_error("profile", fmt::format("the kind \"{}\"", name), "wheel or rail");
}

Doubles array_of(const std::vector<double>& values) {
  return Doubles(static_cast<py::ssize_t>(values.size()), values.data());
}

/// A function of the curve's point, over arc lengths.
template <std::size_t size, class Function>
py::array_t<double> over_curve(const ProfileCurve& curve, const Doubles& s, const char* call,
                               const Function& function) {
  Rows rows(call);
  const std::size_t at = rows.add("s", s);
  rows.broadcast();
  py::array_t<double> result = size == 1 ? rows.result() : rows.result({static_cast<py::ssize_t>(size)});
  double* out = result.mutable_data();
  const py::gil_scoped_release release;
  for (py::ssize_t i = 0; i < rows.count(); ++i, out += size) {
    const double place = rows.value(at, i);
    if (!curve.contains(place)) {
      throw input_error(
          call, fmt::format("s = {} m", place),
          fmt::format("{} to {} m, the length of {}", curve.s_begin(), curve.s_end(), curve.knots().name));
    }
    function(curve.at(place), out);
  }
  return result;
}

}  // namespace

void bind_profiles(py::module_& module) {
  module.def(
      "standard_profiles", [](const std::string& kind) { return standard_profile_names(profile_kind(kind)); },
      py::arg("kind"), "Names of the built-in profiles of a kind, 'wheel' or 'rail'.");
  py::class_<Profile> profile(module, "Profile", R"(A wheel or rail profile as a curve over its arc length s.

    y to the field side, z down [m], right side of the track. A wheel's origin is the tape circle, a rail's the highest
    point of the inclined head.

    >>> wheel = railtab.Profile.wheel("S1002")
    >>> wheel
    <railtab.Profile S1002: wheel, 0.153 m>
    >>> s = np.linspace(wheel.s[0], wheel.s[-1], 1000)
    >>> wheel.points(s).shape
    (1000, 2)
    )");
  of_package(profile);
  profile.def_static(
      "wheel",
      [](const std::string& name, double smoothing) {
        return Profile{ProfileCurve(load_profile(name, ProfileKind::wheel, 0.0, smoothing))};
      },
      py::arg("name"), py::arg("smoothing") = 0.0,
      "A built-in wheel profile by its name, or one from a file.\n\n"
      "smoothing: standard deviation of a measured profile's points [m]; 0: the curve goes through them.");
  profile.def_static(
      "rail",
      [](const std::string& name, double inclination, double smoothing) {
        return Profile{ProfileCurve(load_profile(name, ProfileKind::rail, inclination, smoothing))};
      },
      py::arg("name"), py::arg("inclination") = 1.0 / 40.0, py::arg("smoothing") = 0.0,
      "A built-in rail profile by its name, inclined to the track centre, or one from a file, inclined already.\n\n"
      "inclination: its tangent [-]; smoothing: as of wheel().");
  profile.def_property_readonly(
      "name", [](const Profile& p) { return p.curve.knots().name; }, "Built-in name, or name of the file.");
  profile.def_property_readonly(
      "kind", [](const Profile& p) { return p.curve.knots().kind == ProfileKind::wheel ? "wheel" : "rail"; },
      "wheel or rail.");
  profile.def_property_readonly(
      "notes", [](const Profile& p) { return p.curve.knots().notes; }, "What was repaired in a file's points.");
  profile.def_property_readonly(
      "s", [](const Profile& p) { return array_of(p.curve.knots().s); }, "Arc lengths of the knots, shape (k,) [m].");
  profile.def_property_readonly(
      "y", [](const Profile& p) { return array_of(p.curve.knots().y); }, "y of the knots, shape (k,) [m].");
  profile.def_property_readonly(
      "z", [](const Profile& p) { return array_of(p.curve.knots().z); }, "z of the knots, shape (k,) [m].");
  profile.def(
      "points",
      [](const Profile& p, const Doubles& s) {
        return over_curve<2>(p.curve, s, "points", [](const CurvePoint& point, double* out) {
          out[0] = point.y;
          out[1] = point.z;
        });
      },
      py::arg("s"), "y and z at arc lengths s [m]: shape (..., 2) [m].");
  profile.def(
      "curvature",
      [](const Profile& p, const Doubles& s) {
        return over_curve<1>(p.curve, s, "curvature",
                             [](const CurvePoint& point, double* out) { *out = point.curvature(); });
      },
      py::arg("s"),
      "Curvature at arc lengths s [m]: shape (...) [1/m], positive where the curve bends towards +z, as a rail's "
      "head.");
  profile.def("__repr__", [](const Profile& p) {
    const ProfileKnots& knots = p.curve.knots();
    return fmt::format("<railtab.Profile {}: {}, {:.3f} m>", knots.name,
                       knots.kind == ProfileKind::wheel ? "wheel" : "rail", p.curve.s_end() - p.curve.s_begin());
  });
}

}  // namespace railtab::python
