#pragma once
// Consistent tangent of one penalty contact (docs/theory, section 6.3).

#include <Eigen/Core>

#include "contact/projection/projection.h"
#include "elastogear/contact/types.h"

namespace elastogear::contact {

/// Stiffness W k W' of the 15 coordinates (slave node, four master nodes; x y z each): the force
/// F = p [n; -N_i n] changes by dF = -W k W' dx.
struct Tangent {
  LocalColumns W;
  LocalStiffness k;  ///< symmetric, N/m
};

/// Force along n and -dp/dg_n.
struct NormalStiffness {
  double p, k;  // N, N/m
};

/// full: normal and geometric part; otherwise the normal part k [n; -N_i n] [n; -N_i n]' only.
Tangent contact_tangent(const Face& face, const Projection& projection, const NormalStiffness& normal,
                        bool full);

}  // namespace elastogear::contact
