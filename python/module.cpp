#include "bindings.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/version.hpp"

namespace railtab::python {
namespace {

template <class Error>
void bind_error(pybind11::module_& module, const char* name, PyObject* base, const char* doc) {
  pybind11::exception<Error>& bound = pybind11::register_exception<Error>(module, name, base);
  of_package(bound);
  bound.doc() = doc;
}

}  // namespace
}  // namespace railtab::python

PYBIND11_MODULE(_railtab, module) {
  using namespace railtab::python;
  module.doc() = "The compiled part of railtab; import railtab instead.";
  module.attr("__version__") = railtab::version();
  bind_error<railtab::InputError>(module, "InputError", PyExc_ValueError,
                                  "The input is wrong: where, what was found, what is allowed.");
  bind_error<railtab::ComputationError>(module, "ComputationError", PyExc_RuntimeError,
                                        "A computation on valid input failed.");
  bind_profiles(module);
  bind_contact(module);
  bind_creep(module);
  bind_wheel(module);
  bind_runs(module);
}
