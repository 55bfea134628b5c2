#include "reduction/bases/ritz_task.h"

#include <algorithm>

#include "elastogear/base/broadcast.h"
#include "elastogear/reduction/surface_load.h"
#include "reduction/job/surface.h"

namespace elastogear::reduction {
namespace {

// Faces on which a Ritz basis is loaded. Rank 0.
model::Surface loaded_surface(const Job& job) {
  const ReductionOptions& o = job.options;
  return o.loaded.empty() ? job.plan.body.surface : make_surface(job.mesh, job.regions, o.loaded);
}

// Rows of the displacements of the loaded nodes, on all ranks.
std::vector<int> interface_rows(Job& job) {
  std::vector<int> rows;
  job.on_root([&] {
    const ReductionOptions& o = job.options;
    const std::vector<int> node = loaded_surface(job).node, &dof = job.plan.dof;
    for (std::size_t row = 0; row < dof.size(); ++row)
      if (std::binary_search(node.begin(), node.end(), dof[row] / 3)) rows.push_back(static_cast<int>(row));
    require_affordable(rows, o.loaded.empty() ? o.surface : o.loaded);
  });
  broadcast(job.comm, rows);
  return rows;
}

// Loads of a Krylov basis, rows of this rank.
Eigen::MatrixXd krylov_loads(Job& job, const ElasticSystem& system) {
  std::vector<Eigen::VectorXd> loads;
  job.on_root([&] {
    const model::Surface surface = loaded_surface(job);
    const Eigen::MatrixXd F = smooth_loads(surface, job.options.n_modes);
    for (const auto& f : F.colwise()) loads.push_back(at_nodes(surface, f, job.mesh.n_nodes()));
  });
  int n = static_cast<int>(loads.size());
  MPI_Bcast(&n, 1, MPI_INT, 0, job.comm);
  return distribute(system, loads, n);
}

}  // namespace

RitzTask ritz_task(Job& job, const ElasticSystem& system, const EigenOptions& eigen) {
  RitzTask task{system.K, system.M, *job.options.ritz, eigen, {}, {}};
  if (task.options.kind == RitzKind::krylov)
    task.loads = krylov_loads(job, system);
  else
    task.interface_rows = interface_rows(job);
  return task;
}

}  // namespace elastogear::reduction
