#pragma once
// By what two elastic bodies approach each other where they touch in a patch that is small beside them.

#include <Eigen/Core>

#include "elastogear/model/hertz.h"

namespace elastogear::dynamics {

/// A patch under the force F: its approach by the theory of H. Hertz and the exponent m = d ln(approach) /
/// d ln F.
struct PatchApproach {
  double approach = 0;  ///< m
  double m = 1;
  bool is_line = true;
};

/// Forces p (N) at places t (m) along a line of contact; face: m, to which their places are known;
/// compliance: 1/Pa, of both bodies together. Eq. (6.35).
PatchApproach line_approach(const Eigen::VectorXd& t, const Eigen::VectorXd& p, double curvature, double face,
                            double compliance);

/// The ellipse under the force F where it is shorter than `longest` (m), half of it, and the line of contact
/// otherwise.
PatchApproach patch_approach(const model::Curvatures& at, const Eigen::VectorXd& t, const Eigen::VectorXd& p,
                             double face, double compliance, double longest);

}  // namespace elastogear::dynamics
