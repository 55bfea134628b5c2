#include "reduction/dense/residual.h"

#include <algorithm>
#include <cmath>

#include "elastogear/base/error.h"

namespace elastogear::reduction {
namespace {

// A mechanism's eigenvalue is roundoff of the largest one, max K_ii/M_ii; the lowest elastic one of a slender
// finely meshed body is still some 1e-9 of it.
constexpr double kZeroEigenvalue = 1e-13;

double largest_ratio(Mat K, Mat M) {
  UniqueVec k, m;
  PetscReal largest = 0;
  check(MatCreateVecs(K, k.out(), m.out()));
  check(MatGetDiagonal(K, k));
  check(MatGetDiagonal(M, m));
  check(VecPointwiseDivide(k, k, m));
  check(VecMax(k, nullptr, &largest));
  return largest;
}

}  // namespace

Residual make_residual(Mat K) {
  Residual w;
  check(MatCreateVecs(K, w.phi.out(), w.K_phi.out()));
  check(VecDuplicate(w.phi, w.M_phi.out()));
  return w;
}

void load(Vec phi, const Eigen::Ref<const Eigen::VectorXd>& own) {
  PetscScalar* values = nullptr;
  check(VecGetArrayWrite(phi, &values));
  std::copy(own.begin(), own.end(), values);
  check(VecRestoreArrayWrite(phi, &values));
}

void measure(Mat K, Mat M, const Residual& w, double* eigenvalue, double* residual) {
  PetscScalar mass = 0, stiffness = 0;
  PetscReal force = 0, rest = 0;
  check(MatMult(M, w.phi, w.M_phi));
  check(VecDot(w.phi, w.M_phi, &mass));
  check(VecScale(w.phi, 1 / std::sqrt(mass)));
  check(VecScale(w.M_phi, 1 / std::sqrt(mass)));
  check(MatMult(K, w.phi, w.K_phi));
  check(VecDot(w.phi, w.K_phi, &stiffness));
  check(VecNorm(w.K_phi, NORM_2, &force));
  check(VecAXPY(w.K_phi, -stiffness, w.M_phi));
  check(VecNorm(w.K_phi, NORM_2, &rest));
  *eigenvalue = stiffness;
  *residual = rest / force;
}

double zero_eigenvalue(Mat K, Mat M) { return kZeroEigenvalue * largest_ratio(K, M); }

void require_definite(Mat K, Mat M, double lowest) {
  if (lowest > zero_eigenvalue(K, M)) return;
  fail_singular("its lowest eigenvalue is " + std::to_string(lowest) + " rad^2/s^2");
}

void fail_singular(const std::string& detail) {
  fail("the stiffness is singular (", detail,
       "): the restrained nodes do not hold the body, or parts of the mesh hang together by an edge or a "
       "node only");
}

}  // namespace elastogear::reduction
