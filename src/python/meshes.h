#pragma once
// Meshes as arrays.

#include <pybind11/pybind11.h>

namespace elastogear::python {

void bind_meshes(pybind11::module_& module);

}  // namespace elastogear::python
