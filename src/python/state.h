#pragma once
// The state of a simulation as views of numpy.

#include <pybind11/numpy.h>

#include <memory>
#include <string>
#include <vector>

#include "elastogear/model/result.h"

namespace elastogear::python {

namespace py = pybind11;

/// Names of what a snapshot holds, in its order.
struct Names {
  std::vector<std::string> bodies, pairs, bushings, loads, sensors;
};

/// A snapshot that stays as it is while the run goes on.
struct StateView {
  std::shared_ptr<const model::Snapshot> snapshot;
  std::shared_ptr<const Names> names;
};

/// The dtype of contacts.
py::dtype contact_dtype();

void bind_state(py::module_& module);

}  // namespace elastogear::python
