// The exact solver of the offline part, in a module of its own: whoever distributes it is bound by FFTW's licence, GPL.

#include "bindings.hpp"
#include "railtab/tablegen/rolling_contact.hpp"
#include "rows.hpp"

namespace railtab::python {
namespace {

py::array_t<double> rolling_contact(double ratio, const Doubles& ux, const Doubles& uy, const Doubles& phi, double nu,
                                    int elements) {
  Rows rows("rolling_contact");
  const std::size_t x = rows.add("ux", ux), y = rows.add("uy", uy), spin = rows.add("phi", phi);
  rows.broadcast();
  py::array_t<double> result = rows.result({3});
  double* out = result.mutable_data();
  const py::gil_scoped_release release;
  RollingContactOptions options;
  options.elements = elements;
  ExtrapolatedRollingContact contact(ratio, nu, options);
  for (py::ssize_t i = 0; i < rows.count(); ++i) {
    const Creepage creepage{rows.value(x, i), rows.value(y, i), rows.value(spin, i)};
    const ExtrapolatedContactSolution solution = contact.solve(creepage);
    if (!solution.coarse.converged || !solution.fine.converged) {
      throw ComputationError(fmt::format("rolling_contact: query {}: no solution, residual {:.3g}", i,
                                         std::max(solution.coarse.residual, solution.fine.residual)));
    }
    *out++ = solution.force.x;
    *out++ = solution.force.y;
    *out++ = solution.force.moment;
  }
  return result;
}

}  // namespace
}  // namespace railtab::python

PYBIND11_MODULE(_rolling, module) {
  namespace py = pybind11;
  pybind11::module_::import("railtab._railtab");  // has the exceptions
  module.doc() = "Exact rolling contact; import railtab instead.";
  module.def("rolling_contact", &railtab::python::rolling_contact, py::arg("ratio"), py::arg("ux"), py::arg("uy"),
             py::arg("phi"), py::kw_only(), py::arg("nu") = 0.28, py::arg("elements") = 40,
             R"(Exact creep forces of an ellipse, Kalker's theory of steady rolling: what creep tables tabulate.

    ratio a/b; creepages ux, uy and spin phi, normalised (G = mu F_n = sqrt(ab) = 1), that broadcast to a shape (...).
    elements along each axis of the ellipse, even and at least 8; the force is extrapolated from these and half as many.
    Returns F_x, F_y, M_z on the wheel: shape (..., 3). There only where tablegen is built.

    >>> exact = railtab.rolling_contact(1.0, [0.1, 0.5], 0.0, 0.0)
    >>> bool(abs(exact - railtab.CreepLaw("table").force(1.0, [0.1, 0.5], 0.0, 0.0)).max() < 1e-3)
    True
    )");
}
