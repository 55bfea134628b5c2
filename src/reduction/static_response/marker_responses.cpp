#include "reduction/static_response/marker_responses.h"

#include <optional>

#include "reduction/eigensolver/factorisation.h"
#include "reduction/static_response/inertia_relief.h"
#include "reduction/static_response/residual.h"
#include "reduction/static_response/whole_body_solver.h"

namespace elastogear::reduction {
namespace {

using Eigen::MatrixXd;

// Q', a force and a moment in each direction on each marker, 3 n_nodes x 6 n_m. Rank 0.
MatrixXd unit_loads(const Job& job, int n_loads) {
  return MatrixXd(job.plan.S.bottomRows(n_loads)).transpose();
}

// K^-1 f of each of the columns, by one factor of the whole body. Collective; the columns are read on rank 0,
// where the result is.
MatrixXd by_factor(const ElasticSystem& system, const MatrixXd& f, int n_loads) {
  std::vector<Eigen::VectorXd> loads;
  for (const auto& column : f.colwise()) loads.emplace_back(column);
  MatrixXd own = distribute(system, loads, n_loads), u(f.rows(), f.cols());
  std::optional<InertiaRelief> relief;
  if (system.rigid) relief.emplace(system.M, *system.rigid);
  const UniqueMat grounded = relief ? relief->ground(system.K) : UniqueMat();
  ShiftedFactor factor(relief ? grounded.get() : system.K, system.M);
  factor.factorise(0);
  factor.solve(own);
  if (relief) relief->release(own);
  UniqueVec x;
  check(MatCreateVecs(system.K, x.out(), nullptr));
  for (int j = 0; j < n_loads; ++j) {
    load(x, own.col(j));
    const Eigen::VectorXd whole = system.gather(x);
    if (whole.size() > 0) u.col(j) = whole;
  }
  return u;
}

// The same of a held body that repeats, by its harmonics. Rank 0.
MatrixXd by_harmonics(const Job& job, const MatrixXd& f) {
  const io::BodySource source = source_of(job);
  MatrixXd u = MatrixXd::Zero(f.rows(), f.cols());
  factorise_harmonics(source, job.plan.repetition)->visit_parts([&](const Solve& part) { u += part(f); });
  return u;
}

}  // namespace

// K^-1 is symmetric: a marker moves by a force on a node as the node moves by a load on the marker.
void add_marker_responses(Job& job, const ElasticSystem* whole) {
  const int n_loads = 6 * static_cast<int>(job.options.markers.size());
  if (n_loads == 0) return;
  MatrixXd f, u;
  job.on_root([&] { f = unit_loads(job, n_loads); });
  if (whole) u = by_factor(*whole, f, n_loads);
  job.on_root([&] {
    if (!whole) u = by_harmonics(job, f);
    model::ElasticBody& body = job.plan.body;
    const std::vector<int>& node = body.flexibility.node;
    for (std::size_t m = 0; m < body.markers.size(); ++m) {
      model::DenseRows& F = body.markers[m].F;
      F.resize(6, 3 * static_cast<Eigen::Index>(node.size()));
      for (std::size_t c = 0; c < node.size(); ++c)
        F.middleCols<3>(static_cast<Eigen::Index>(3 * c)) =
            u.block<3, 6>(3 * body.surface.node[static_cast<std::size_t>(node[c])],
                          static_cast<Eigen::Index>(6 * m))
                .transpose();
    }
  });
}

}  // namespace elastogear::reduction
