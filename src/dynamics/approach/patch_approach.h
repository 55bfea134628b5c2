#pragma once
// By what two elastic bodies approach each other where they touch in a patch that is small beside them.

#include <Eigen/Core>

#include "dynamics/approach/line_extent.h"
#include "elastogear/model/hertz.h"

namespace elastogear::dynamics {

/// A patch under the force F: its approach by the theory of H. Hertz and the exponent m = d ln(approach) /
/// d ln F.
struct PatchApproach {
  double approach = 0;  ///< m
  double m = 1;
  bool is_line = true;
};

/// Forces p (N) at places t (m, ascending) along a line.
struct LineForces {
  Eigen::VectorXd t, p;
};

/// N, forces on n equal stations of a line: those of a load per length of the second degree, where it is
/// positive, that has the sum and the first two moments of the forces, each spread over one face. Eq.
/// (6.34a).
Eigen::VectorXd station_forces(const LineForces& forces, const LineExtent& line, Eigen::Index n);

/// Along a line of contact that may bear within `extent`, does so at most one face beyond the outer forces,
/// and on no less than `least`, m. compliance: 1/Pa, of both bodies together. Eq. (6.35).
PatchApproach line_approach(const LineForces& forces, const LineExtent& extent, double least,
                            double curvature, double compliance);

/// The ellipse under the force F, where half of it is shorter than half of `longest` (m).
bool is_ellipse(const model::Curvatures& at, double F, double compliance, double longest);
PatchApproach ellipse_approach(const model::Curvatures& at, double F, double compliance);

}  // namespace elastogear::dynamics
