#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>

#include "elastogear/base/broadcast.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/memory.h"
#include "elastogear/base/tensor.h"
#include "elastogear/fem/sector_assembly.h"
#include "elastogear/fem/stress.h"
#include "elastogear/reduction/flexibility.h"
#include "reduction/cyclic/responses/condensed_responses.h"
#include "reduction/cyclic/responses/delivery.h"
#include "reduction/cyclic/responses/wanted_rows.h"
#include "reduction/static_response/independent_rows.h"
#include "reduction/static_response/inertia_relief.h"
#include "reduction/static_response/nested_response.h"

namespace elastogear::reduction {
namespace {

constexpr const char* kStage = "static responses";

using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Triplets = std::vector<Eigen::Triplet<double>>;

// Adds the rows of the stress operator at one node of each orbit of the nodes of G.
void add_stress_rows(const FlexibilityTask& task, const fem::NodeOrbits& node_orbits,
                     const model::Flexibility& plan, WantedRows& wanted) {
  const std::vector<int> all = stress_nodes(task, plan);
  std::vector<int> first;
  for (int orbit = 0; orbit < static_cast<int>(plan.stress.node.cols()); ++orbit)
    first.push_back(all[plan.stress.node(0, orbit)]);
  if (first.empty()) return;
  const IndependentRows independent = independent_rows(fem::stress_operator(task.stressed, first));
  wanted.first_stress_row = independent.first;
  for (int row = 0; row < independent.W.rows(); ++row) {
    Eigen::Map<Vector6>(wanted.stress.emplace_back().data()) = independent.Q.col(row);
    for (model::SparseRows::InnerIterator it(independent.W, row); it; ++it) {
      const auto node = static_cast<std::size_t>(it.col() / 3);
      if (node_orbits.orbit[node] < 0) continue;
      wanted.row.push_back(row);
      wanted.orbit.push_back(node_orbits.orbit[node]);
      wanted.sector_index.push_back(node_orbits.sector_index[node]);
      wanted.direction.push_back(static_cast<int>(it.col() % 3));
      wanted.value.push_back(it.value());
    }
  }
}

WantedRows find_wanted(const FlexibilityTask& task, const model::Flexibility& plan,
                       const fem::NodeOrbits& node_orbits) {
  WantedRows wanted;
  for (Eigen::Index orbit = 0; orbit < plan.surface.node.cols(); ++orbit) {
    const int node = task.surface.node[plan.node[plan.surface.node(0, orbit)]];
    wanted.surface_orbit.push_back(node_orbits.orbit[node]);
    wanted.surface_sector_index.push_back(node_orbits.sector_index[node]);
  }
  add_stress_rows(task, node_orbits, plan, wanted);
  return wanted;
}

void broadcast(MPI_Comm comm, WantedRows& wanted) {
  for (std::vector<int>* list :
       {&wanted.surface_orbit, &wanted.surface_sector_index, &wanted.row, &wanted.orbit, &wanted.direction,
        &wanted.sector_index, &wanted.first_stress_row})
    elastogear::broadcast(comm, *list);
  elastogear::broadcast(comm, wanted.value);
  elastogear::broadcast(comm, wanted.stress);
}

// Rows of one displacement in the coordinates of a harmonic.
class Unfolding {
 public:
  Unfolding(const fem::Harmonic& harmonic, const fem::Sector& sector)
      : harmonic_(harmonic),
        sector_(sector),
        scale_(std::sqrt((harmonic.real ? 1.0 : 2.0) / harmonic.n_sectors)) {}

  void add(int row, int orbit, int sector_index, const Eigen::RowVector3d& weight, Triplets& entries) const {
    const MatrixXd& Q = harmonic_.at(sector_.on_axis[orbit], sector_index);
    const Eigen::RowVectorXd values = scale_ * weight * Q.topRows<3>();
    for (Eigen::Index j = 0; j < values.size(); ++j)
      entries.emplace_back(row, harmonic_.first[orbit] + static_cast<int>(j), values[j]);
  }

 private:
  const fem::Harmonic& harmonic_;
  const fem::Sector& sector_;
  double scale_;
};

// P_k at the first node of each orbit, displacements then stresses.
model::SparseRows rows_of(const WantedRows& wanted, const fem::Harmonic& harmonic,
                          const fem::Sector& sector) {
  const Unfolding unfolding(harmonic, sector);
  const int n_u = static_cast<int>(3 * wanted.surface_orbit.size());
  Triplets entries;
  for (int i = 0; i < n_u; ++i)
    if (const int orbit = wanted.surface_orbit[i / 3]; orbit >= 0)
      unfolding.add(i, orbit, wanted.surface_sector_index[i / 3], Eigen::Vector3d::Unit(i % 3).transpose(),
                    entries);
  for (std::size_t i = 0; i < wanted.row.size(); ++i)
    unfolding.add(n_u + wanted.row[i], wanted.orbit[i], wanted.sector_index[i],
                  wanted.value[i] * Eigen::Vector3d::Unit(wanted.direction[i]).transpose(), entries);
  model::SparseRows P(wanted.n_rows(), harmonic.size());
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

// Rows P_i with P_i z = P (i z).
model::SparseRows times_i(const model::SparseRows& P, const fem::Harmonic& harmonic) {
  Triplets entries;
  std::vector<int> half(static_cast<std::size_t>(P.cols()));  // how far Im z of each coordinate is from Re z
  for (std::size_t orbit = 0; orbit + 1 < harmonic.first.size(); ++orbit) {
    const int first = harmonic.first[orbit], n = (harmonic.first[orbit + 1] - first) / 2;
    for (int i = 0; i < n; ++i) half[first + i] = n, half[first + n + i] = -n;
  }
  for (int row = 0; row < P.outerSize(); ++row)
    for (model::SparseRows::InnerIterator it(P, row); it; ++it) {
      const int distance = half[it.col()];
      entries.emplace_back(row, static_cast<int>(it.col()) + distance,
                           distance > 0 ? -it.value() : it.value());
    }
  model::SparseRows P_i(P.rows(), P.cols());
  P_i.setFromTriplets(entries.begin(), entries.end());
  return P_i;
}

model::SparseRows below_each_other(const model::SparseRows& A, const model::SparseRows& B) {
  model::SparseRows both(A.rows() + B.rows(), A.cols());
  both.topRows(A.rows()) = A;
  both.bottomRows(B.rows()) = B;
  return both;
}

auto column(Amplitudes& amplitudes, int load) {
  return amplitudes.piece[static_cast<std::size_t>(load / kPiece)].col(load % kPiece);
}

// Amplitudes of one harmonic's part of all responses.
class HarmonicResponses {
 public:
  // rigid: the rigid motions that the harmonic contains; of a held body none.
  HarmonicResponses(const fem::Harmonic& harmonic, const fem::Sector& sector, const WantedRows& wanted,
                    MatrixXd rigid)
      : harmonic_(harmonic), P_(rows_of(wanted, harmonic, sector)), rigid_(std::move(rigid)) {
    n_u_ = static_cast<Eigen::Index>(3 * wanted.surface_orbit.size());
  }

  // progress: takes the share of the work that is done.
  Amplitudes find(const fem::Matrices& matrices, const std::function<void(double)>& progress) const {
    RigidFields rigid;
    UniqueMat grounded;
    if (rigid_.cols() > 0) {
      const InertiaRelief relief(matrices.M, rigid_);
      grounded = relief.ground(matrices.K);
      rigid = relief.fields();
    }
    std::vector<int> loads(static_cast<std::size_t>(n_u_));
    std::iota(loads.begin(), loads.end(), 0);
    NestedResponse response(grounded ? grounded.get() : matrices.K.get(),
                            harmonic_.real ? P_ : below_each_other(P_, times_i(P_, harmonic_)), loads, rigid,
                            0, progress);
    Amplitudes amplitudes{harmonic_.real, harmonic_.k, {}};
    const Eigen::Index n_rows = harmonic_.real ? P_.rows() : 2 * P_.rows();
    for (Eigen::Index first = 0; first < n_u_; first += kPiece)
      amplitudes.piece.emplace_back(n_rows, std::min(kPiece, n_u_ - first));
    for (const std::vector<int>& group : response.groups()) {
      const MatrixXf Y = response.next();
      for (std::size_t i = 0; i < group.size(); ++i)
        column(amplitudes, group[i]) = Y.col(static_cast<Eigen::Index>(i));
    }
    fill_symmetric(response.groups(), [&](int load) { return column(amplitudes, load).data(); });
    return amplitudes;
  }

 private:
  const fem::Harmonic& harmonic_;
  model::SparseRows P_;
  MatrixXd rigid_;
  Eigen::Index n_u_ = 0;
};

// From the columns of F of whole orbits.
void set_self(Eigen::Index first, const MatrixXf& F, model::Flexibility& flexibility) {
  for (Eigen::Index i = 0; i < F.cols(); i += 3) {
    const auto orbit = static_cast<int>((first + i) / 3);
    flexibility.self[orbit] = model::self_response(flexibility, orbit, F.middleCols<3>(i));
  }
}

void store(Eigen::Index first, const MatrixXf& F, const MatrixXf& G, model::Flexibility& flexibility) {
  const Eigen::Index n = 3 * flexibility.surface.node.cols();
  flexibility.F.resize(F.rows(), n);
  flexibility.G.resize(G.rows(), n);
  flexibility.F.middleCols(first, F.cols()) = F;
  flexibility.G.middleCols(first, G.cols()) = G;
}

}  // namespace

model::Flexibility find_cyclic_flexibility(MPI_Comm comm, const FlexibilityTask& task,
                                           const fem::MeshedBody& body, bool floating, const ColumnSink& sink,
                                           const Progress& progress) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  model::Flexibility flexibility;
  fem::Sector sector;
  WantedRows wanted;
  collectively(comm, [&] {
    if (rank != 0) return;
    flexibility = plan_flexibility(task);
    const fem::NodeOrbits node_orbits = fem::free_node_orbits(task.repetition, body.is_free);
    sector = fem::make_sector(body.mesh, task.repetition, body.region, node_orbits);
    wanted = find_wanted(task, flexibility, node_orbits);
  });
  fem::broadcast(comm, sector);
  broadcast(comm, wanted);
  const int n_harmonics = sector.turn.n_sectors / 2 + 1;
  std::vector<Amplitudes> own;
  collectively(comm, [&] {
    std::optional<CondensedResponses> condensed;
    if (!floating && condensing_pays(sector))
      condensed.emplace(sector, wanted, body.regions, body.formulation);
    for (int k = rank; k < n_harmonics; k += size) {
      const auto report_part = [&](double part) {
        report(progress, kStage, std::min(1.0, (k - rank + part * size) / n_harmonics));
      };
      const fem::Harmonic harmonic = fem::make_harmonic(sector, k);
      if (harmonic.size() == 0) continue;
      report_part(0);
      if (condensed) {
        own.push_back(condensed->find(harmonic));
        report_part(1);
        continue;
      }
      const fem::Matrices matrices =
          fem::assemble(PETSC_COMM_SELF, sector, harmonic, body.regions, body.formulation);
      const MatrixXd rigid = floating ? fem::rigid_fields(harmonic, sector) : MatrixXd();
      own.push_back(HarmonicResponses(harmonic, sector, wanted, rigid).find(matrices, report_part));
      give_back_memory();
    }
  });
  model::Flexibility found = flexibility;
  if (rank == 0) found.self.resize(flexibility.surface.node.cols());
  const auto keep = [&](const model::Flexibility& plan, Eigen::Index first, const MatrixXf& F,
                        const MatrixXf& G) {
    set_self(first, F, found);
    sink ? sink(plan, first, F, G) : store(first, F, G, found);
  };
  deliver_columns(comm, sector.turn, wanted, own, flexibility, keep);
  return found;
}

}  // namespace elastogear::reduction
