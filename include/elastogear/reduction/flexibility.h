#pragma once
// Static responses to unit forces on the contact surface (docs/theory, section 6.9).

#include <functional>
#include <string>
#include <vector>

#include "elastogear/base/progress.h"
#include "elastogear/fem/balance.h"
#include "elastogear/fem/gather.h"
#include "elastogear/fem/stressed_body.h"
#include "elastogear/mesh/mesh.h"
#include "elastogear/mesh/repetition.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/reduction/completeness.h"

namespace elastogear::reduction {

/// Loaded nodes and evaluation nodes of a flexibility, and the body. Read on rank 0.
struct FlexibilityTask {
  const model::Surface& surface;
  const std::vector<int>& stress_node;  ///< n_e evaluation nodes, mesh numbers
  const model::SparseRows& S;           ///< its first 6 n_e rows: stress operator
  const mesh::Mesh& mesh;
  const mesh::Repetition& repetition;
  const std::vector<std::string>& loaded;  ///< face sets that may be loaded; none: the whole surface
  fem::StressedBody stressed;
};

/// Loaded nodes and their symmetry; F and G are empty yet. A node's images are loaded with it; where one is
/// missing on the surface, or stresses at images are recovered otherwise, symmetry is not used. Throws Error
/// for unknown face sets and faces off the surface.
model::Flexibility plan_flexibility(const FlexibilityTask& task);
/// The n_r nodes of G, mesh numbers, ascending.
std::vector<int> stress_nodes(const FlexibilityTask& task, const model::Flexibility& plan);

/// Estimated cost of finding F and G, from the sizes alone; right within a factor of about two.
struct StaticResponseCost {
  std::size_t n_nodes = 0;    ///< n_c, that may be loaded
  std::size_t n_columns = 0;  ///< loads: three for one node of each orbit, for each harmonic
  double seconds = 0;         ///< on `n_ranks` ranks
  double bytes = 0;           ///< of all ranks together, at the same time
  double kept_bytes = 0;      ///< of F and G
  int n_states = 0;           ///< states of relaxation besides
};
/// n_free: free displacements of the whole body.
StaticResponseCost forecast(const FlexibilityTask& task, const model::Flexibility& plan, std::size_t n_free,
                            int n_ranks);

/// Flexibility of the plan with F and G, for three forces on each node, by nested dissection of K on rank 0.
/// Forces on a free body are balanced by inertia, and its static response is orthogonal to rigid motions
/// (section 2.4). Collective; the result is on rank 0. Throws Error when K is not positive definite.
model::Flexibility find_flexibility(const FlexibilityTask& task, const ElasticSystem& system,
                                    const Progress& progress = {});

/// Takes columns of F and G from column `first` on, three for each of the next orbits of loaded nodes.
using ColumnSink = std::function<void(const model::Flexibility& plan, Eigen::Index first,
                                      const Eigen::MatrixXf& F, const Eigen::MatrixXf& G)>;

/// Flexibility of the plan from one sector: u = sum_k P_k K_k^-1 P_k' f over the harmonics, with the rows P_k
/// that unfold harmonic k (section 2.6). Each rank takes its share of the harmonics, one at a time. floating:
/// a free body, whose rigid motions are in harmonics 0 and 1. Needs a plan that uses the symmetry. The sink
/// gets all columns, ascending, on rank 0, and the result then has neither F nor G; an empty one leaves them
/// in it. Collective; the result is on rank 0. Its errors and those of the sink reach all ranks.
model::Flexibility find_cyclic_flexibility(MPI_Comm comm, const FlexibilityTask& task,
                                           const fem::MeshedBody& body, bool floating,
                                           const ColumnSink& sink = {}, const Progress& progress = {});

}  // namespace elastogear::reduction
