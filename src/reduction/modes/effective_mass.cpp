#include "reduction/modes/effective_mass.h"

#include <petscksp.h>

#include <Eigen/Geometry>

namespace elastogear::reduction {
namespace {

constexpr double kTolerance = 1e-7;  // of the solution; the masses are as exact as its square

// Conjugate gradients: the consistent mass scaled by its diagonal has a condition number that depends on the
// cell types alone (A. J. Wathen, IMA J. Numer. Anal. 7 (1987) 449-457).
UniqueKSP mass_solver(Mat M) {
  UniqueKSP ksp;
  PC pc = nullptr;
  check(KSPCreate(comm_of(M), ksp.out()));
  check(KSPSetOperators(ksp, M, M));
  check(KSPSetType(ksp, KSPCG));
  check(KSPSetTolerances(ksp, kTolerance, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  check(KSPSetErrorIfNotConverged(ksp, PETSC_TRUE));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCJACOBI));
  return ksp;
}

}  // namespace

Eigen::Matrix<double, Eigen::Dynamic, 6> effective_masses(const model::Inertia& inertia) {
  Eigen::Matrix<double, Eigen::Dynamic, 6> coupling(inertia.C_l.rows(), 6);
  coupling.leftCols<3>() = inertia.C_l;
  for (Eigen::Index k = 0; k < coupling.rows(); ++k) {
    const Eigen::Vector3d C_l = inertia.C_l.row(k);
    coupling.row(k).tail<3>() = inertia.C_r.row(k) - inertia.c.cross(C_l).transpose();
  }
  return coupling.cwiseAbs2();
}

SixDirections body_masses(const model::Inertia& inertia) {
  const Eigen::Vector3d c = inertia.c;
  SixDirections masses;
  masses.head<3>().setConstant(inertia.m);
  masses.tail<3>() = inertia.J.diagonal().array() - inertia.m * (c.squaredNorm() - c.array().square());
  return masses;
}

Eigen::VectorXd rigid_momentum(const fem::MassMoments& moments, const Eigen::Vector3d& c, int direction) {
  const Eigen::Vector3d e = Eigen::Vector3d::Unit(direction % 3);
  if (direction < 3) return fem::momentum(moments, e, Eigen::Vector3d::Zero());
  return fem::momentum(moments, -e.cross(c), e);
}

// p' M^-1 p by 2 p' v - v' M v, whose error is of second order in that of v whatever roundoff does to the
// orthogonality of conjugate gradients.
SixDirections inverse_masses(Mat M, const std::function<void(int direction, Vec p)>& set) {
  const UniqueKSP ksp = mass_solver(M);
  UniqueVec p, v, Mv;
  check(MatCreateVecs(M, v.out(), p.out()));
  check(VecDuplicate(p, Mv.out()));
  SixDirections masses;
  for (int direction = 0; direction < 6; ++direction) {
    PetscScalar with_p = 0, with_mv = 0;
    set(direction, p);
    check(KSPSolve(ksp, p, v));
    check(MatMult(M, v, Mv));
    check(VecDot(p, v, &with_p));
    check(VecDot(Mv, v, &with_mv));
    masses(direction) = 2 * with_p - with_mv;
  }
  return masses;
}

SixDirections mobile_masses(Mat M, const fem::VectorGather& gather, const fem::MassMoments& moments,
                            const Eigen::Vector3d& c) {
  return inverse_masses(
      M, [&](int direction, Vec p) { gather.scatter(rigid_momentum(moments, c, direction), p); });
}

}  // namespace elastogear::reduction
