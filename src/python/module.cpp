// The module elastogear._elastogear, beneath the package python/elastogear.

#include <pybind11/pybind11.h>

#include "elastogear/base/error.h"
#include "python/meshes.h"
#include "python/results.h"
#include "python/runtime.h"
#include "python/simulation.h"
#include "python/state.h"
#include "python/verbs.h"

PYBIND11_MODULE(_elastogear, module) {
  using namespace elastogear;
  module.doc() = "The library beneath the package elastogear.";
  auto& error = pybind11::register_exception<Error>(module, "Error", PyExc_RuntimeError);
  error.attr("__module__") = "elastogear";
  error.doc() = "What a user can cause: it says what, where, which value, and what is allowed.";
  python::bind_runtime(module);
  python::bind_verbs(module);
  python::bind_state(module);
  python::bind_simulation(module);
  python::bind_results(module);
  python::bind_meshes(module);
}
