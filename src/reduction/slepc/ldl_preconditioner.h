#pragma once
// The factor of K - sigma M with its inertia as a PC type of PETSc, "ldl", for the KSP of an ST.

#include <slepcst.h>

#include "reduction/eigensolver/factorisation.h"

namespace elastogear::reduction {

/// L D L' by MUMPS in the order of METIS (ShiftedFactor). The matrix is an assembled symmetric one or, after
/// ldl_set_transform, that of STSINVERT with ST_MATMODE_SHELL, where K - sigma M is never formed. It is
/// factorised when it is first needed; columns of a PCMatApply go through the factor together.
constexpr const char* kLdlType = "ldl";

/// May be called more than once.
void register_ldl();

bool is_ldl(PC pc);
/// The matrices and the shift are those of st, which must outlive the solves. pc: of st's KSP.
void ldl_set_transform(PC pc, ST st);
/// Another factor than that of MUMPS, borrowed; of the ST's K and M. nullptr: MUMPS'.
void ldl_set_factor(PC pc, ShiftedSolver* factor);
/// Negative pivots of the present factor: eigenvalues of (K, M) below sigma. Collective.
int ldl_negative_pivots(PC pc);
/// Finds the order of elimination if need be. Collective.
FactorSize ldl_size(PC pc);

}  // namespace elastogear::reduction
