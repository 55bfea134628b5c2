#include "reduction/cyclic/responses/delivery.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>
#include <optional>
#include <utility>

#include "elastogear/base/collectively.h"
#include "elastogear/base/dense_product.h"
#include "elastogear/base/rotation.h"
#include "elastogear/base/tensor.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXf;

constexpr int kPieceTag = 3;

// The rank that has found the responses of harmonic k, and whether these are real.
struct HarmonicAt {
  int k, real, rank;
};

// The harmonics of all ranks by ascending k, with the rank that has found each.
std::vector<HarmonicAt> all_harmonics(MPI_Comm comm, const std::vector<Amplitudes>& own) {
  constexpr int kNumbers = 3;  // of a HarmonicAt
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  std::vector<HarmonicAt> mine;
  for (const Amplitudes& harmonic : own) mine.push_back({harmonic.k, harmonic.real, rank});
  const int n_own = kNumbers * static_cast<int>(mine.size());
  std::vector<int> n(static_cast<std::size_t>(size)), first(n.size() + 1, 0);
  MPI_Allgather(&n_own, 1, MPI_INT, n.data(), 1, MPI_INT, comm);
  for (std::size_t r = 0; r < n.size(); ++r) first[r + 1] = first[r] + n[r];
  std::vector<HarmonicAt> all(static_cast<std::size_t>(first.back() / kNumbers));
  MPI_Allgatherv(mine.data(), n_own, MPI_INT, all.data(), n.data(), first.data(), MPI_INT, comm);
  std::sort(all.begin(), all.end(), [](const HarmonicAt& a, const HarmonicAt& b) { return a.k < b.k; });
  return all;
}

// Parts of the amplitudes of the harmonics by the sectors j, a row each: the field of a harmonic k turned by
// j sectors has the amplitude z exp(2 pi i j k/Z).
MatrixXf phases(const std::vector<HarmonicAt>& harmonics, int n_sectors) {
  Index n = 0;
  for (const HarmonicAt& harmonic : harmonics) n += harmonic.real ? 1 : 2;
  MatrixXf result(n, n_sectors);
  for (int j = 0; j < n_sectors; ++j) {
    Index row = 0;
    for (const HarmonicAt& harmonic : harmonics) {
      const double phase = 2 * std::numbers::pi / n_sectors *
                           static_cast<double>(static_cast<long>(j) * harmonic.k % n_sectors);
      result(row++, j) = static_cast<float>(std::cos(phase));
      if (!harmonic.real) result(row++, j) = static_cast<float>(std::sin(phase));
    }
  }
  return result;
}

// One piece of the responses of all harmonics on rank 0; nobody else keeps it. n_rows: wanted rows.
std::vector<MatrixXf> gather_piece(MPI_Comm comm, const std::vector<HarmonicAt>& harmonics,
                                   std::vector<Amplitudes>& own, std::size_t piece, Index n_rows,
                                   Index width) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::vector<MatrixXf> all;
  auto next = own.begin();
  for (const HarmonicAt& harmonic : harmonics)
    if (harmonic.rank == rank) {
      MatrixXf Y = std::exchange(next++->piece[piece], {});
      if (rank == 0)
        all.push_back(std::move(Y));
      else
        MPI_Send(Y.data(), static_cast<int>(Y.size()), MPI_FLOAT, 0, kPieceTag, comm);
    } else if (rank == 0) {
      MatrixXf& Y = all.emplace_back(harmonic.real ? n_rows : 2 * n_rows, width);
      MPI_Recv(Y.data(), static_cast<int>(Y.size()), MPI_FLOAT, harmonic.rank, kPieceTag, comm,
               MPI_STATUS_IGNORE);
    }
  return all;
}

// Turns the six components of a symmetric tensor by T.
Eigen::Matrix<double, 6, 6> tensor_turn(const Eigen::Matrix3d& T) {
  Eigen::Matrix<double, 6, 6> turn;
  for (int j = 0; j < 6; ++j) turn.col(j) = six_entries(T * symmetric(Vector6::Unit(j)) * T.transpose());
  return turn;
}

// Enters displacements of the sector's nodes, turned by j sectors.
void enter_displacements(const Eigen::Ref<const Eigen::VectorXf>& u, const Eigen::Matrix3f& turn,
                         const Eigen::RowVectorXi& nodes, Eigen::Ref<Eigen::VectorXf> column) {
  for (Index orbit = 0; orbit < nodes.size(); ++orbit)
    column.segment<3>(3 * Index{nodes[orbit]}).noalias() = turn * u.segment<3>(3 * orbit);
}

using Stresses = Eigen::Matrix<float, 6, Eigen::Dynamic>;

// The stress, turned, that each of the wanted rows of stresses stands for, a column each.
Stresses turned_stresses(const WantedRows& wanted, const Eigen::Matrix<double, 6, 6>& turn) {
  Stresses stress(6, static_cast<Index>(wanted.stress.size()));
  for (std::size_t row = 0; row < wanted.stress.size(); ++row)
    stress.col(static_cast<Index>(row)) =
        (turn * Eigen::Map<const Vector6>(wanted.stress[row].data())).cast<float>();
  return stress;
}

// Enters stresses of the sector's nodes, turned as `stress` is, from as many rows as are independent at each
// node.
void enter_stresses(const Eigen::Ref<const Eigen::VectorXf>& rows, const Stresses& stress,
                    const std::vector<int>& first_row, const Eigen::RowVectorXi& nodes,
                    Eigen::Ref<Eigen::VectorXf> column) {
  for (Index orbit = 0; orbit < nodes.size(); ++orbit) {
    Eigen::Matrix<float, 6, 1> sum = Eigen::Matrix<float, 6, 1>::Zero();
    for (int row = first_row[orbit]; row < first_row[orbit + 1]; ++row) sum += rows[row] * stress.col(row);
    column.segment<6>(6 * Index{nodes[orbit]}) = sum;
  }
}

// A column of F and G from the rows wanted of each sector.
class Turning {
 public:
  Turning(const mesh::Turn& sectors, const WantedRows& wanted, const model::Flexibility& plan)
      : wanted_(wanted), plan_(plan) {
    for (int j = 0; j < sectors.n_sectors; ++j) {
      const Eigen::Matrix3d T = rotation_matrix(2 * std::numbers::pi / sectors.n_sectors * j * sectors.axis);
      turn_.emplace_back(T.cast<float>());
      stress_.push_back(turned_stresses(wanted, tensor_turn(T)));
      loaded_.emplace_back(plan.surface.node.row(j));
      stressed_.emplace_back(plan.stress.node.row(j));
    }
  }

  // rows: wanted ones x sectors, in the frame of the first sector.
  void enter(const MatrixXf& rows, Eigen::Ref<Eigen::VectorXf> F, Eigen::Ref<Eigen::VectorXf> G) const {
    const Index n_u = wanted_.n_loads(), n_sigma = rows.rows() - n_u;
    for (std::size_t j = 0; j < turn_.size(); ++j) {
      const auto sector = rows.col(static_cast<Index>(j));
      enter_displacements(sector.head(n_u), turn_[j], loaded_[j], F);
      if (n_sigma > 0)
        enter_stresses(sector.tail(n_sigma), stress_[j], wanted_.first_stress_row, stressed_[j], G);
    }
  }

  Index n_F() const { return 3 * plan_.surface.node.size(); }
  Index n_G() const { return 6 * plan_.stress.node.size(); }

 private:
  const WantedRows& wanted_;
  const model::Flexibility& plan_;
  std::vector<Eigen::Matrix3f> turn_;  // of each sector
  std::vector<Stresses> stress_;
  std::vector<Eigen::RowVectorXi> loaded_, stressed_;
};

// Columns of F and G from those of all harmonics.
void combine(const std::vector<MatrixXf>& harmonics, const MatrixXf& phase, const Turning& turning,
             Index n_rows, MatrixXf& F, MatrixXf& G) {
  MatrixXf Y(n_rows, phase.rows()), sectors(n_rows, phase.cols());
  for (Index column = 0; column < F.cols(); ++column) {
    Index at = 0;
    for (const MatrixXf& harmonic : harmonics) {
      Y.col(at++) = harmonic.col(column).head(n_rows);
      if (harmonic.rows() > n_rows) Y.col(at++) = harmonic.col(column).tail(n_rows);
    }
    multiply(Op::plain, Op::plain, 1.0F, Y, phase, 0.0F, sectors);
    turning.enter(sectors, F.col(column), G.col(column));
  }
}

}  // namespace

void deliver_columns(MPI_Comm comm, const mesh::Turn& sectors, const WantedRows& wanted,
                     std::vector<Amplitudes>& own, const model::Flexibility& plan, const ColumnSink& sink) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const std::vector<HarmonicAt> harmonics = all_harmonics(comm, own);
  const Index n = wanted.n_loads(), n_rows = wanted.n_rows();
  std::exception_ptr failure;  // the other ranks send on
  const auto on_root = [&](auto&& f) {
    if (rank != 0 || failure) return;
    try {
      f();
    } catch (...) {
      failure = std::current_exception();
    }
  };
  std::optional<Turning> turning;
  MatrixXf phase, F, G;
  on_root([&] {
    turning.emplace(sectors, wanted, plan);
    phase = phases(harmonics, sectors.n_sectors);
  });
  for (Index first = 0; first < n; first += kPiece) {
    const Index width = std::min(kPiece, n - first);
    const std::vector<MatrixXf> piece =
        gather_piece(comm, harmonics, own, static_cast<std::size_t>(first / kPiece), n_rows, width);
    on_root([&] {
      F.resize(turning->n_F(), width);
      G.resize(turning->n_G(), width);
      combine(piece, phase, *turning, n_rows, F, G);
      sink(plan, first, F, G);
    });
  }
  collectively(comm, [&] {
    if (failure) std::rethrow_exception(failure);
  });
}

}  // namespace elastogear::reduction
