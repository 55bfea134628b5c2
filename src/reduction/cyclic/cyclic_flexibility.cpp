#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "elastogear/base/broadcast.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/base/tensor.h"
#include "elastogear/fem/sector_assembly.h"
#include "elastogear/fem/stress.h"
#include "elastogear/reduction/flexibility.h"
#include "reduction/eigensolver/factorisation.h"
#include "reduction/static_response/inertia_relief.h"

namespace elastogear::reduction {
namespace {

constexpr Eigen::Index kBlock = 96;  // right-hand sides that go through the factor together
constexpr const char* kStage = "static responses";

using Eigen::MatrixXd;
using Triplets = std::vector<Eigen::Triplet<double>>;

// Loaded nodes and wanted rows of the stress operator in terms of a sector, for the first node of each orbit.
struct Wanted {
  std::vector<int> surface_orbit, surface_sector_index;  // in the sector: of the loaded nodes; orbit -1: held
  std::vector<int> row, orbit, direction, sector_index;  // stress operator, entry by entry
  std::vector<double> value;
  int n_stress_rows = 0;
};

// Adds the rows of the stress operator at one node of each orbit of the nodes of G.
void add_stress_rows(const FlexibilityTask& task, const fem::NodeOrbits& node_orbits,
                     const model::Flexibility& plan, Wanted& wanted) {
  const std::vector<int> all = stress_nodes(task, plan);
  std::vector<int> first;
  for (int orbit = 0; orbit < static_cast<int>(plan.stress.node.cols()); ++orbit)
    first.push_back(all[plan.stress.node(0, orbit)]);
  wanted.n_stress_rows = static_cast<int>(6 * first.size());
  if (first.empty()) return;
  const model::SparseRows S = fem::stress_operator(task.stressed, first);
  for (int row = 0; row < wanted.n_stress_rows; ++row)
    for (model::SparseRows::InnerIterator it(S, row); it; ++it) {
      const auto node = static_cast<std::size_t>(it.col() / 3);
      if (node_orbits.orbit[node] < 0) continue;
      wanted.row.push_back(row);
      wanted.orbit.push_back(node_orbits.orbit[node]);
      wanted.sector_index.push_back(node_orbits.sector_index[node]);
      wanted.direction.push_back(static_cast<int>(it.col() % 3));
      wanted.value.push_back(it.value());
    }
}

Wanted find_wanted(const FlexibilityTask& task, const model::Flexibility& plan,
                   const fem::NodeOrbits& node_orbits) {
  Wanted wanted;
  for (Eigen::Index orbit = 0; orbit < plan.surface.node.cols(); ++orbit) {
    const int node = task.surface.node[plan.node[plan.surface.node(0, orbit)]];
    wanted.surface_orbit.push_back(node_orbits.orbit[node]);
    wanted.surface_sector_index.push_back(node_orbits.sector_index[node]);
  }
  add_stress_rows(task, node_orbits, plan, wanted);
  return wanted;
}

void broadcast(MPI_Comm comm, Wanted& wanted) {
  for (std::vector<int>* list : {&wanted.surface_orbit, &wanted.surface_sector_index, &wanted.row,
                                 &wanted.orbit, &wanted.direction, &wanted.sector_index})
    elastogear::broadcast(comm, *list);
  elastogear::broadcast(comm, wanted.value);
  MPI_Bcast(&wanted.n_stress_rows, 1, MPI_INT, 0, comm);
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
Eigen::SparseMatrix<double, Eigen::RowMajor> rows_of(const Wanted& wanted, const fem::Harmonic& harmonic,
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
  Eigen::SparseMatrix<double, Eigen::RowMajor> P(n_u + wanted.n_stress_rows, harmonic.size());
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

// A vector or, by its six components, a symmetric tensor turned by T.
MatrixXd turning(const Eigen::Matrix3d& T, int components) {
  if (components == 3) return T;
  MatrixXd turn(6, 6);
  for (int j = 0; j < 6; ++j) turn.col(j) = six_entries(T * symmetric(Vector6::Unit(j)) * T.transpose());
  return turn;
}

// Adds what the orbits' nodes, turned by j sectors, get from their amplitudes: `components` rows of Y a node.
void add_turned(const Eigen::Ref<const MatrixXd>& Y, const MatrixXd& turn, const model::Images& images, int j,
                Eigen::Ref<Eigen::MatrixXf> responses) {
  const Eigen::Index n = turn.rows();
  for (Eigen::Index orbit = 0; orbit < images.node.cols(); ++orbit)
    responses.middleRows(n * images.node(j, orbit), n) += (turn * Y.middleRows(n * orbit, n)).cast<float>();
}

// One harmonic's part of all responses.
class HarmonicResponses {
 public:
  // rigid: the rigid motions that the harmonic contains; of a held body none.
  HarmonicResponses(const fem::Harmonic& harmonic, const fem::Sector& sector, const Wanted& wanted,
                    MatrixXd rigid)
      : harmonic_(harmonic),
        axis_(sector.turn.axis),
        P_(rows_of(wanted, harmonic, sector)),
        rigid_(std::move(rigid)) {
    n_u_ = static_cast<Eigen::Index>(3 * wanted.surface_orbit.size());
  }

  void add(const fem::Matrices& matrices, model::Flexibility& flexibility) const {
    std::optional<InertiaRelief> relief;
    UniqueMat grounded;
    if (rigid_.cols() > 0) grounded = relief.emplace(matrices.M, rigid_).ground(matrices.K);
    ShiftedFactor factor(relief ? grounded.get() : matrices.K.get(), matrices.M);
    factor.factorise(0);
    for (Eigen::Index first = 0; first < n_u_; first += kBlock) {
      const Eigen::Index n = std::min(kBlock, n_u_ - first);
      MatrixXd Z = MatrixXd(P_.middleRows(first, n)).transpose();
      if (relief) relief->balance(Z);
      factor.solve(Z);
      if (relief) relief->release(Z);
      enter(P_ * Z, harmonic_.real ? MatrixXd() : MatrixXd(P_ * fem::times_i(harmonic_, 0, Z)), first,
            flexibility);
    }
  }

 private:
  // The field turned by j sectors has the amplitude z exp(2 pi i j k/Z).
  void enter(const MatrixXd& Y, const MatrixXd& Y_i, Eigen::Index first,
             model::Flexibility& flexibility) const {
    const Eigen::Index n = Y.cols(), n_sigma = Y.rows() - n_u_;
    for (int j = 0; j < harmonic_.n_sectors; ++j) {
      const double alpha = 2 * std::numbers::pi / harmonic_.n_sectors,
                   phase =
                       alpha * static_cast<double>(static_cast<long>(j) * harmonic_.k % harmonic_.n_sectors);
      MatrixXd Y_j = std::cos(phase) * Y;
      if (!harmonic_.real) Y_j += std::sin(phase) * Y_i;
      const Eigen::Matrix3d T = rotation_matrix(alpha * j * axis_);
      add_turned(Y_j.topRows(n_u_), turning(T, 3), flexibility.surface, j,
                 flexibility.F.middleCols(first, n));
      if (n_sigma > 0)
        add_turned(Y_j.bottomRows(n_sigma), turning(T, 6), flexibility.stress, j,
                   flexibility.G.middleCols(first, n));
    }
  }

  const fem::Harmonic& harmonic_;
  Eigen::Vector3d axis_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> P_;
  MatrixXd rigid_;
  Eigen::Index n_u_ = 0;
};

// Sum of the ranks' matrices on rank 0, some columns at a time.
void sum_on_root(MPI_Comm comm, Eigen::MatrixXf& A) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  for (Eigen::Index j = 0; j < A.cols(); ++j)
    MPI_Reduce(rank == 0 ? MPI_IN_PLACE : A.col(j).data(), A.col(j).data(), static_cast<int>(A.rows()),
               MPI_FLOAT, MPI_SUM, 0, comm);
}

void broadcast(MPI_Comm comm, model::Images& images, int n_sectors) {
  elastogear::broadcast(comm, images.orbit);
  elastogear::broadcast(comm, images.sector_index);
  images = model::make_images(images.orbit, images.sector_index, n_sectors, "nodes of the flexibility");
}

}  // namespace

model::Flexibility find_cyclic_flexibility(MPI_Comm comm, const FlexibilityTask& task,
                                           const fem::MeshedBody& body, bool floating,
                                           const Progress& progress) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  model::Flexibility flexibility;
  fem::Sector sector;
  Wanted wanted;
  collectively(comm, [&] {
    if (rank != 0) return;
    flexibility = plan_flexibility(task);
    const fem::NodeOrbits node_orbits = fem::free_node_orbits(task.repetition, body.is_free);
    sector = fem::make_sector(body.mesh, task.repetition, body.region, node_orbits);
    wanted = find_wanted(task, flexibility, node_orbits);
  });
  fem::broadcast(comm, sector);
  broadcast(comm, wanted);
  broadcast(comm, flexibility.surface, sector.turn.n_sectors);
  broadcast(comm, flexibility.stress, sector.turn.n_sectors);
  flexibility.F.setZero(3 * flexibility.surface.node.size(), 3 * flexibility.surface.node.cols());
  flexibility.G.setZero(6 * flexibility.stress.node.size(), flexibility.F.cols());
  const int n_harmonics = sector.turn.n_sectors / 2 + 1;
  collectively(comm, [&] {
    for (int k = rank; k < n_harmonics; k += size) {
      const fem::Harmonic harmonic = fem::make_harmonic(sector, k);
      if (harmonic.size() == 0) continue;
      const fem::Matrices matrices =
          fem::assemble(PETSC_COMM_SELF, sector, harmonic, body.regions, body.element);
      HarmonicResponses(harmonic, sector, wanted, floating ? fem::rigid_fields(harmonic, sector) : MatrixXd())
          .add(matrices, flexibility);
      report(progress, kStage, std::min(1.0, static_cast<double>(k + size) / n_harmonics));
    }
  });
  sum_on_root(comm, flexibility.F);
  sum_on_root(comm, flexibility.G);
  if (rank == 0) model::set_self(flexibility);
  return flexibility;
}

}  // namespace elastogear::reduction
