#pragma once
// A small dense second-order problem F(t, U, V, A) = 0 under a TS, for the tests of the time integrator.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>
#include <string>

#include "elastogear/base/petsc.h"
#include "elastogear/dynamics/generalized_alpha.h"

namespace elastogear::test {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

struct Problem {
  std::function<VectorXd(double t, const VectorXd& U, const VectorXd& V, const VectorXd& A)> F;
  std::function<MatrixXd(double t, const VectorXd& U, double shift_V, double shift_A)> J;
  VectorXd U0, V0;
};

/// Options database in force for this scope only.
class Options {
 public:
  explicit Options(const std::string& text) {
    check(PetscOptionsCreate(&options_));
    check(PetscOptionsInsertString(options_, text.c_str()));
    check(PetscOptionsPush(options_));
  }
  ~Options() {
    PetscOptionsPop();
    PetscOptionsDestroy(&options_);
  }
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;

 private:
  PetscOptions options_ = nullptr;
};

inline VectorXd values(Vec x) {
  PetscInt n = 0;
  const PetscScalar* a = nullptr;
  check(VecGetSize(x, &n));
  check(VecGetArrayRead(x, &a));
  VectorXd result = Eigen::Map<const VectorXd>(a, n);
  check(VecRestoreArrayRead(x, &a));
  return result;
}

inline void set_values(Vec x, const VectorXd& from) {
  PetscScalar* a = nullptr;
  check(VecGetArray(x, &a));
  Eigen::Map<VectorXd>(a, from.size()) = from;
  check(VecRestoreArray(x, &a));
}

inline UniqueVec vector(const VectorXd& from) {
  UniqueVec x;
  check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(from.size()), x.out()));
  set_values(x, from);
  return x;
}

/// The problem with its TS, set up from `options`; `at_step` sees every accepted state, the first included.
/// `linear` declares it TS_LINEAR. Not movable: the TS points here.
struct Integration {
  using Observer = std::function<void(double t, const VectorXd& U, const VectorXd& V)>;

  Integration(Problem p, const std::string& options, Observer observer = {},
              TSProblemType kind = TS_NONLINEAR);
  Integration(const Integration&) = delete;

  void solve() { check(TSSolve(ts, nullptr), pending); }
  VectorXd displacement() const { return values(U); }
  VectorXd velocity() const { return values(V); }
  VectorXd acceleration() {
    Vec A = nullptr;
    dynamics::generalized_alpha_state(ts, nullptr, nullptr, &A);
    return values(A);
  }

  Problem problem;
  Observer at_step;
  std::exception_ptr pending;
  UniqueVec U, V, residual;
  UniqueMat jacobian;
  UniqueTS ts;
};

}  // namespace elastogear::test
