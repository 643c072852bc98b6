#pragma once

#include <pybind11/pybind11.h>

namespace railtab::python {

/// Each adds its part to the module; classes before those that take them.
void bind_profiles(pybind11::module_& module);
void bind_contact(pybind11::module_& module);
void bind_creep(pybind11::module_& module);
void bind_wheel(pybind11::module_& module);
void bind_runs(pybind11::module_& module);

/// Python names classes by the package that users import.
template <class Class>
void of_package(Class& bound) {
  bound.attr("__module__") = "railtab";
}

}  // namespace railtab::python
