#pragma once
// Distributed stiffness K and consistent mass M over the free displacements, block size 3.

#include "elastogear/base/petsc.h"
#include "elastogear/base/progress.h"
#include "elastogear/fem/mesh_part.h"
#include "elastogear/model/material.h"

namespace elastogear::fem {

/// K in N/m, M in kg, MATAIJ, both symmetric positive definite when the restraint holds the body, and of one
/// sparsity. (Not MATSBAIJ, which would halve the memory: on several ranks the inertia of K - sigma M formed
/// by PETSc 3.18's MatAXPY came out wrong there; the cause is not known.)
/// docs/theory, Eqs. (1.1) and (1.2).
struct Matrices {
  UniqueMat K, M;
};

/// Restraint by elimination: restrained displacements have no rows. Collective. The part's regions index
/// `regions`; Jacobians must be positive (require_positive_jacobians).
Matrices assemble(MPI_Comm comm, const MeshPart& part, const std::vector<model::MaterialRegion>& regions,
                  const model::Formulation& formulation, const Progress& progress = {});

}  // namespace elastogear::fem
