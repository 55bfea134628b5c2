#pragma once
// Result, stress and body files as arrays.

#include <pybind11/pybind11.h>

namespace elastogear::python {

void bind_results(pybind11::module_& module);

}  // namespace elastogear::python
