#include "elastogear/reduction/completeness.h"

#include <algorithm>

#include "reduction/eigensolver/factorisation.h"
#include "reduction/static_response/inertia_relief.h"

namespace elastogear::reduction {
namespace {

// One vector and its own rows as a column.
struct Column {
  UniqueVec vec;
  PetscInt n_own = 0;

  explicit Column(Mat A) {
    check(MatCreateVecs(A, vec.out(), nullptr));
    check(VecGetLocalSize(vec, &n_own));
  }
  Eigen::VectorXd values() const {
    const PetscScalar* values = nullptr;
    check(VecGetArrayRead(vec, &values));
    const Eigen::VectorXd own = Eigen::Map<const Eigen::VectorXd>(values, n_own);
    check(VecRestoreArrayRead(vec, &values));
    return own;
  }
};

// F' U of each pair of columns, on all ranks.
Eigen::VectorXd products(MPI_Comm comm, const Eigen::MatrixXd& F, const Eigen::MatrixXd& U) {
  const Eigen::VectorXd own = F.cwiseProduct(U).colwise().sum();
  Eigen::VectorXd sum(own.size());
  MPI_Allreduce(own.data(), sum.data(), static_cast<int>(own.size()), MPI_DOUBLE, MPI_SUM, comm);
  return sum;
}

// f' K^-1 f of each column. Loads of a free body are balanced: they do no work in rigid motions.
Eigen::VectorXd exact_responses(const ElasticSystem& system, const Eigen::MatrixXd& F) {
  UniqueMat grounded;
  if (system.rigid) grounded = InertiaRelief(system.M, *system.rigid).ground(system.K);
  ShiftedFactor factor(system.rigid ? grounded.get() : system.K, system.M);
  factor.factorise(0);
  Eigen::MatrixXd U = F;
  factor.solve(U);
  return products(comm_of(system.K), F, U);
}

double modal_response(const model::ElasticBody& body, const Eigen::VectorXd& f) {
  const Eigen::VectorXd h = std::get<model::DenseRows>(body.surface.Phi).transpose() * f;
  return h.cwiseAbs2().cwiseQuotient(Eigen::VectorXd(body.K_r.diagonal())).sum();
}

}  // namespace

Eigen::VectorXd at_nodes(const model::Surface& surface, const Eigen::VectorXd& f, int n_nodes) {
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(n_nodes));
  for (std::size_t i = 0; i < surface.node.size(); ++i)
    whole.segment<3>(3 * surface.node[i]) = f.segment<3>(static_cast<Eigen::Index>(3 * i));
  return whole;
}

Eigen::MatrixXd distribute(const ElasticSystem& system, const std::vector<Eigen::VectorXd>& loads,
                           int n_loads) {
  const Column v(system.K);
  Eigen::MatrixXd F(v.n_own, n_loads);
  for (int j = 0; j < n_loads; ++j) {
    system.gather.scatter(loads.empty() ? Eigen::VectorXd() : loads[j], v.vec);
    F.col(j) = v.values();
  }
  if (system.rigid) InertiaRelief(system.M, *system.rigid).balance(F);
  return F;
}

Completeness static_completeness(const ElasticSystem& system, const model::ElasticBody& body, int n_nodes) {
  int rank = 0;
  MPI_Comm_rank(comm_of(system.K), &rank);
  std::vector<SurfaceLoad> loads;
  if (rank == 0) loads = representative_loads(body.surface);
  int n_loads = static_cast<int>(loads.size());
  MPI_Bcast(&n_loads, 1, MPI_INT, 0, comm_of(system.K));
  if (n_loads == 0) return {};
  std::vector<Eigen::VectorXd> f;
  for (const SurfaceLoad& load : loads) f.push_back(at_nodes(body.surface, load.f, n_nodes));
  const Eigen::VectorXd exact = exact_responses(system, distribute(system, f, n_loads));
  Completeness result;
  std::vector<double> share;
  for (std::size_t j = 0; j < loads.size(); ++j) {
    if (exact(static_cast<Eigen::Index>(j)) <= 0) continue;
    result.load.push_back(loads[j].name);
    share.push_back(modal_response(body, loads[j].f) / exact(static_cast<Eigen::Index>(j)));
  }
  result.share = Eigen::Map<const Eigen::VectorXd>(share.data(), static_cast<Eigen::Index>(share.size()));
  return result;
}

}  // namespace elastogear::reduction
