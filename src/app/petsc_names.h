#pragma once
// The names of the options that PETSc and SLEPc know.

#include <string>
#include <vector>

namespace elastogear::app {

/// Names without the leading '-', sorted. PETSc keeps no list of them: an option is known when some code asks
/// for it. The names it asks for are literals in the libraries, and they are read there, "ts_adapt_type".
/// Some hold %d (a number) or %s (a word). Empty where the libraries' text cannot be found.
const std::vector<std::string>& petsc_names();

/// Is this an option that PETSc or SLEPc may ask for, under one of the prefixes of nested solvers
/// ("elastic_mg_levels_1_ksp_type")? True for everything when petsc_names() is empty.
bool is_petsc_name(const std::string& name);

}  // namespace elastogear::app
