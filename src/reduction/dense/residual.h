#pragma once
// Normalisation and residual of an eigenvector, for all eigensolvers of this module.

#include <Eigen/Core>
#include <string>

#include "elastogear/base/petsc.h"

namespace elastogear::reduction {

struct Residual {
  UniqueVec phi, K_phi, M_phi;
};

Residual make_residual(Mat K);

/// Sets phi from the rows of this rank.
void load(Vec phi, const Eigen::Ref<const Eigen::VectorXd>& own);

/// Scales phi to phi' M phi = 1. eigenvalue: the Rayleigh quotient (more exact than a solver's value);
/// residual: |K phi - eigenvalue M phi| / |K phi|.
void measure(Mat K, Mat M, const Residual& w, double* eigenvalue, double* residual);

/// rad^2/s^2; eigenvalues up to it are roundoff of the largest one.
double zero_eigenvalue(Mat K, Mat M);

/// Throws Error unless the lowest eigenvalue is above roundoff of the largest.
void require_definite(Mat K, Mat M, double lowest);
[[noreturn]] void fail_singular(const std::string& detail);

}  // namespace elastogear::reduction
