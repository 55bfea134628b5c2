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

/// Throws Error that begins with `label` when the option lets a solver, under any prefix, end before it has
/// begun: relative tolerances (-snes_rtol, -ksp_rtol, -eps_tol and the like) above 0.1, and no iterations.
void check_petsc_limits(const std::string& label, const std::string& name, const std::string& value);

/// Throws Error that begins with `label` when the option chooses among types of solvers (-eps_type, -st_type,
/// -snes_type, -ts_type, and -ksp_type and -pc_type under any prefix) and there is none of this name.
void check_petsc_type(const std::string& label, const std::string& name, const std::string& value);

/// Options in the database that PETSc knows, and that the solvers of this run have not asked for. What PETSc
/// itself asks for when it ends is none of them.
std::vector<std::string> unused_petsc_options();

}  // namespace elastogear::app
