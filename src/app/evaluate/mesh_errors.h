#pragma once
// Estimated errors by the mesh of what is read off a run, from the same run on coarser meshes.

#include <string>
#include <vector>

#include "app/evaluate/evaluate_tables.h"

namespace elastogear::app {

/// Adds its estimated error to each figure that the mesh changes, Eq. (10.15) to (10.18), as an item
/// `PATH_mesh_error`, in place of one that is there and of that by the contact's resolution. coarser:
/// evaluation files of the same cases, the coarsest mesh first; refinement: of the cases' own meshes. Figures
/// that a coarser mesh has not get none. Throws Error naming a file that has none of a pair of gears, or does
/// not say how fine its mesh is.
void add_mesh_errors(const std::vector<std::string>& coarser, double refinement,
                     std::vector<CaseFigures>& cases);

/// The largest estimated error of the largest tension at the root of a gear in a case, as a share of that of
/// the same gear over all cases of an evaluation file: a small torque does not ask for a finer mesh than the
/// largest one. < 0: there is none.
double root_error(const std::string& evaluation);
/// The same of one gear of the case that was read off this result, whose bodies are those of the evaluation's
/// results; < 0 where the evaluation is of others.
double root_error_of(const std::string& evaluation, const std::string& result, const std::string& gear);

}  // namespace elastogear::app
