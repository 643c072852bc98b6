#include <pybind11/stl/filesystem.h>

#include <memory>

#include "bindings.hpp"
#include "law.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"
#include "railtab/tables/files/creep_table_file.hpp"
#include "rows.hpp"

namespace railtab::python {
namespace {

/// Ellipses and normalised creepages.
class Creepages {
 public:
  Creepages(const char* call, const Doubles& ratio, const Doubles& ux, const Doubles& uy, const Doubles& phi)
      : rows_(call),
        ratio_(rows_.add("ratio", ratio)),
        x_(rows_.add("ux", ux)),
        y_(rows_.add("uy", uy)),
        spin_(rows_.add("phi", phi)) {
    rows_.broadcast();
  }
  [[nodiscard]] const Rows& rows() const noexcept { return rows_; }
  [[nodiscard]] double ratio(py::ssize_t i) const {
    constexpr double most = 1e6;
    const double ratio = rows_.value(ratio_, i);
    if (ratio > 0.0 && ratio <= most && ratio * most >= 1.0) return ratio;
    throw input_error(fmt::format("{}: query {}", rows_.call(), i), fmt::format("ratio = {}", ratio),
                      "a/b > 0, from 1e-06 to 1e+06");
  }
  [[nodiscard]] Creepage creepage(py::ssize_t i) const noexcept {
    return {rows_.value(x_, i), rows_.value(y_, i), rows_.value(spin_, i)};
  }

 private:
  Rows rows_;
  std::size_t ratio_, x_, y_, spin_;
};

void put(const CreepForce& force, double* out) {
  out[0] = force.x;
  out[1] = force.y;
  out[2] = force.moment;
}

py::array_t<double> law_force(const Law& law, const Doubles& ratio, const Doubles& ux, const Doubles& uy,
                              const Doubles& phi) {
  const Creepages queries("CreepLaw.force", ratio, ux, uy, phi);
  py::array_t<double> result = queries.rows().result({3});
  double* out = result.mutable_data();
  const py::gil_scoped_release release;
  for (py::ssize_t i = 0; i < queries.rows().count(); ++i, out += 3) {
    put(creep_force(law.law, queries.ratio(i), queries.creepage(i)), out);
  }
  return result;
}

py::tuple law_jet(const Law& law, const Doubles& ratio, const Doubles& ux, const Doubles& uy, const Doubles& phi) {
  const Creepages queries("CreepLaw.jet", ratio, ux, uy, phi);
  py::array_t<double> force = queries.rows().result({3}), derivative = queries.rows().result({3, 4});
  double *out = force.mutable_data(), *slopes = derivative.mutable_data();
  {
    const py::gil_scoped_release release;
    for (py::ssize_t i = 0; i < queries.rows().count(); ++i, out += 3) {
      const CreepForceJet jet = creep_force_jet(law.law, queries.ratio(i), queries.creepage(i));
      put(jet.force, out);
      for (const std::array<double, 4>& row : jet.derivative) slopes = std::copy(row.begin(), row.end(), slopes);
    }
  }
  return py::make_tuple(force, derivative);
}

py::array_t<double> table_share(const Law& law, const Doubles& ratio, const Doubles& ux, const Doubles& uy,
                                const Doubles& phi) {
  const Creepages queries("CreepLaw.table_share", ratio, ux, uy, phi);
  const auto* const table = std::get_if<TableCreep>(&law.law);
  py::array_t<double> result = queries.rows().result();
  double* out = result.mutable_data();
  const py::gil_scoped_release release;
  for (py::ssize_t i = 0; i < queries.rows().count(); ++i) {
    out[i] = table ? table->share(queries.ratio(i), queries.creepage(i)) : 0.0;
  }
  return result;
}

py::tuple table_lookup(const CreepTable& table, const Doubles& ratio, const Doubles& ux, const Doubles& uy,
                       const Doubles& phi) {
  const Creepages queries("CreepTable.lookup", ratio, ux, uy, phi);
  const Rows& rows = queries.rows();
  py::array_t<double> force = rows.result({3}), derivative = rows.result({3, 4});
  py::array_t<bool> inside = rows.result<bool>();
  double *out = force.mutable_data(), *slopes = derivative.mutable_data();
  bool* in = inside.mutable_data();
  {
    const py::gil_scoped_release release;
    for (py::ssize_t i = 0; i < rows.count(); ++i) {
      const Creepage at = queries.creepage(i);
      const CreepLookup found = table.jet(queries.ratio(i), {at.x, at.y, at.spin});
      out = std::copy(found.force.begin(), found.force.end(), out);
      for (std::size_t k = 0; k < 3; ++k) {
        *slopes++ = found.by_ratio[k];
        slopes = std::copy(found.derivative[k].begin(), found.derivative[k].end(), slopes);
      }
      in[i] = found.inside;
    }
  }
  return py::make_tuple(force, derivative, inside);
}

py::array_t<double> kalker(const Doubles& ratio, double nu) {
  if (!(nu >= 0.0 && nu <= 0.5)) throw input_error("kalker_coefficients", fmt::format("nu = {}", nu), "0 to 0.5");
  Rows rows("kalker_coefficients");
  const std::size_t at = rows.add("ratio", ratio);
  rows.broadcast();
  py::array_t<double> result = rows.result({4});
  double* out = result.mutable_data();
  const py::gil_scoped_release release;
  for (py::ssize_t i = 0; i < rows.count(); ++i, out += 4) {
    if (!(rows.value(at, i) > 0.0)) {
      throw input_error("kalker_coefficients", fmt::format("ratio = {}", rows.value(at, i)), "a/b > 0");
    }
    const KalkerCoefficients c = kalker_coefficients(rows.value(at, i), nu);
    out[0] = c.c11;
    out[1] = c.c22;
    out[2] = c.c23;
    out[3] = c.c33;
  }
  return result;
}

void bind_table(py::module_& module) {
  py::class_<CreepTable> table(module, "CreepTable",
                               R"(A table of exact rolling contact, normalised: G = mu F_n = sqrt(ab) = 1.

    >>> creep = railtab.CreepTable.open()
    >>> force, derivative, inside = creep.lookup(1.0, [0.1, 0.5, 2.0], 0.0, 0.0)
    >>> force[:, 0].round(3)
    array([-0.37, -0.99, -1.  ])
    )");
  of_package(table);
  table.def_static(
      "open",
      [](const std::optional<std::filesystem::path>& file) {
        return std::make_unique<CreepTable>(read_creep_table(file ? *file : shipped_creep_table()));
      },
      py::arg("file") = py::none(), "Reads a creep table; without a file the one that comes with railtab.");
  table.def("lookup", &table_lookup, py::arg("ratio"), py::arg("ux"), py::arg("uy"), py::arg("phi"),
            R"(Force, derivatives and whether the table covers the query.

    ratio a/b, creepages ux, uy and spin phi, normalised: numbers or arrays that broadcast to a shape (...).
    Returns force (..., 3): F_x, F_y, M_z on the wheel; derivative (..., 3, 4): of these with respect to a/b, ux, uy and
    phi; inside (...): outside, force and derivative are zero.)");
  table.def_property_readonly(
      "info",
      [](const CreepTable& t) {
        using namespace py::literals;
        const CreepTableData& data = t.data();
        py::dict info("poisson"_a = data.poisson, "elements"_a = data.elements,
                      "layout"_a = std::string(creep_table_layout_name(data.layout)), "bytes"_a = t.bytes(),
                      "program_version"_a = data.provenance.program_version,
                      "command_line"_a = data.provenance.command_line, "created"_a = data.provenance.created);
        for (const auto& [name, value] : data.statistics) info[py::str(name)] = value;
        return info;
      },
      "dict: Poisson's ratio, layout, size in memory [bytes], provenance, measured errors.");
}

}  // namespace

void bind_creep(py::module_& module) {
  bind_table(module);
  py::class_<Law> law(module, "CreepLaw", R"(A law of creep forces, normalised: G = mu F_n = sqrt(ab) = 1.

    name: table, polach, fastsim or linear; nu: Poisson's ratio; table: file of a creep table, without it the one that
    comes with railtab, for nu = 0.28. Outside its table, the law 'table' is Polach's.

    >>> law = railtab.CreepLaw("polach")
    >>> law.force(1.0, [0.5, 1.0], 0.0, 0.0).shape
    (2, 3)
    )");
  of_package(law);
  law.def(py::init([](const std::string& name, double nu, const std::optional<std::filesystem::path>& table) {
            if (table && name != "table")
              throw input_error(fmt::format("CreepLaw {}", name), "a table", "the law table, or no table");
            return Law{creep_law(name, nu, table.value_or(std::filesystem::path()))};
          }),
          py::arg("name") = "table", py::kw_only(), py::arg("nu") = 0.28, py::arg("table") = py::none());
  law.def_property_readonly(
      "name", [](const Law& l) { return std::string(creep_law_name(l.law)); }, "table, polach, fastsim or linear.");
  const auto ratio = py::arg("ratio"), ux = py::arg("ux"), uy = py::arg("uy"), phi = py::arg("phi");
  law.def("force", &law_force, ratio, ux, uy, phi,
          "F_x, F_y, M_z on the wheel, shape (..., 3), from a/b, creepages and spin that broadcast to a shape (...).");
  law.def("jet", &law_jet, ratio, ux, uy, phi,
          "force (..., 3) and its derivatives (..., 3, 4) with respect to a/b, ux, uy, phi.");
  law.def("table_share", &table_share, ratio, ux, uy, phi,
          "Share of the table in the force, 1 inside it, 0 outside and for other laws: shape (...).");
  law.def("__repr__", [](const Law& l) { return fmt::format("<railtab.CreepLaw {}>", creep_law_name(l.law)); });
  module.def("kalker_coefficients", &kalker, ratio, py::arg("nu") = 0.28,
             "Kalker's c11, c22, c23, c33 of an ellipse a/b: shape (..., 4) [-].");
}

}  // namespace railtab::python
