#include "reduction/static_response/attachments.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "reduction/dense/residual.h"
#include "reduction/eigensolver/factorisation.h"
#include "reduction/job/second_moments.h"
#include "reduction/static_response/inertia_relief.h"
#include "reduction/static_response/whole_body_solver.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Energy of a load's response that modes and other responses have to leave out of it, over the whole of it.
constexpr double kLeftOut = 1e-12;
constexpr int kDeflations = 2;  // the second one removes what roundoff of the first leaves of low modes

// Columns on rank 0 from those of which each rank has its own rows. Collective.
MatrixXd on_root(const ElasticSystem& system, const MatrixXd& own) {
  UniqueVec x;
  check(MatCreateVecs(system.K, x.out(), nullptr));
  MatrixXd all;
  for (Index j = 0; j < own.cols(); ++j) {
    load(x, own.col(j));
    const VectorXd column = system.gather(x);
    if (j == 0) all.resize(column.size(), own.cols());
    if (column.size() > 0) all.col(j) = column;
  }
  return all;
}

// Q', a force and a moment in each direction on each marker, or a pressure, 3 n_nodes x 6 n_m. Rank 0.
MatrixXd unit_loads(const Job& job, int n_loads) {
  return MatrixXd(job.plan.S.bottomRows(n_loads)).transpose();
}

// Static responses by one factor of the whole body. Collective; the loads are read on rank 0, where the
// result is.
MatrixXd by_factor(const ElasticSystem& system, const MatrixXd& f, int n_loads) {
  std::vector<VectorXd> loads;
  for (const auto& column : f.colwise()) loads.emplace_back(column);
  MatrixXd own = distribute(system, loads, n_loads);
  std::optional<InertiaRelief> relief;
  if (system.rigid) relief.emplace(system.M, *system.rigid);
  const UniqueMat grounded = relief ? relief->ground(system.K) : UniqueMat();
  ShiftedFactor factor(relief ? grounded.get() : system.K, system.M);
  factor.factorise(0);
  factor.solve(own);
  if (relief) relief->release(own);
  return on_root(system, own);
}

// Static responses of a held, cyclically symmetric body, by its harmonics. Rank 0.
MatrixXd by_harmonics(const Job& job, const MatrixXd& f) {
  const io::BodySource source = source_of(job);
  MatrixXd u = MatrixXd::Zero(f.rows(), f.cols());
  factorise_harmonics(source, job.plan.repetition)->visit_parts([&](const Solve& part) { u += part(f); });
  return u;
}

// M u by the matrix of the whole body. Collective; u is read on rank 0, where the result is.
MatrixXd times_mass(const ElasticSystem& system, const MatrixXd& u, int n) {
  UniqueVec x, M_x;
  check(MatCreateVecs(system.K, x.out(), M_x.out()));
  MatrixXd M_u(u.rows(), u.cols());
  for (int j = 0; j < n; ++j) {
    system.gather.scatter(u.size() > 0 ? VectorXd(u.col(j)) : VectorXd(), x);
    check(MatMult(system.M, x, M_x));
    const VectorXd column = system.gather(M_x);
    if (column.size() > 0) M_u.col(j) = column;
  }
  return M_u;
}

// Takes the columns of Phi, orthonormal in the inner product of M, out of V.
void take_out(const MatrixXd& Phi, const MatrixXd& M_V, MatrixXd& V) {
  const MatrixXd share = Phi.transpose() * M_V;
  V.noalias() -= Phi * share;
}

void take_out_modes(const WaitingModes& modes, const MatrixXd& M_V, MatrixXd& V) {
  const Index width = modes.block_width(V.rows());
  for (Index k = 0; k < modes.size(); k += width)
    take_out(modes.block(k, std::min(width, modes.size() - k)), M_V, V);
}

MatrixXd symmetric(const MatrixXd& A) { return (A + A.transpose()) / 2; }

// V X with X' V' K V X = I, of those directions of which something is left. K: V' K V; whole: energies of the
// loads' whole responses, 0 of markers that do not move.
MatrixXd independent(const MatrixXd& K, const VectorXd& whole) {
  const VectorXd scale = whole.unaryExpr([](double e) { return e > 0 ? 1 / std::sqrt(e) : 0; });
  const Eigen::SelfAdjointEigenSolver<MatrixXd> energy(
      symmetric(scale.asDiagonal() * K * scale.asDiagonal()));
  const Index n = (energy.eigenvalues().array() > kLeftOut).count();
  return scale.asDiagonal() * energy.eigenvectors().rightCols(n) *
         energy.eigenvalues().tail(n).cwiseSqrt().cwiseInverse().asDiagonal();
}

// Stationary points of Rayleigh's quotient in the span of V, Eq. (2.16).
Attachments ritz(const MatrixXd& V, const MatrixXd& X, const MatrixXd& M) {
  if (X.cols() == 0) return {MatrixXd(V.rows(), 0), VectorXd()};
  const Eigen::SelfAdjointEigenSolver<MatrixXd> mass(symmetric(X.transpose() * M * X));
  const VectorXd eigenvalue = mass.eigenvalues().reverse().cwiseInverse();
  const MatrixXd s = X * mass.eigenvectors().rowwise().reverse() * eigenvalue.cwiseSqrt().asDiagonal();
  return {V * s, eigenvalue};
}

}  // namespace

Attachments find_attachments(Job& job, const ElasticSystem* whole, const WaitingModes* modes) {
  int n_loads = 6 * static_cast<int>(job.plan.body.markers.size());  // on rank 0, which has the mesh
  MPI_Bcast(&n_loads, 1, MPI_INT, 0, job.comm);
  MatrixXd f, V, rigid;
  fem::FieldMass mass;
  job.on_root([&] {
    f = unit_loads(job, n_loads);
    if (!whole) mass = field_mass(job);
  });
  if (whole) V = by_factor(*whole, f, n_loads);
  if (whole && whole->rigid) rigid = on_root(*whole, InertiaRelief(whole->M, *whole->rigid).fields().R);
  VectorXd energy;
  job.on_root([&] {
    if (!whole) V = by_harmonics(job, f);
    energy = f.cwiseProduct(V).colwise().sum();
    f.resize(0, 0);
  });
  const auto momentum = [&] { return whole ? times_mass(*whole, V, n_loads) : times(mass, V); };
  for (int i = 0; i < kDeflations; ++i) {
    const MatrixXd M_V = momentum();
    job.on_root([&] {
      if (rigid.size() > 0) take_out(rigid, M_V, V);
      take_out_modes(*modes, M_V, V);
    });
  }
  const MatrixXd M_V = momentum();
  Attachments found;
  job.on_root([&] {
    const MatrixXd K = job.plan.S.bottomRows(n_loads) * V;  // the modes are orthogonal to V in K, too
    found = ritz(V, independent(K, energy), V.transpose() * M_V);
  });
  return found;
}

}  // namespace elastogear::reduction
