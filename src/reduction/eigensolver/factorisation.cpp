#include "reduction/eigensolver/factorisation.h"

#include <dmumps_c.h>

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

#include "elastogear/base/error.h"
#include "reduction/dense/residual.h"
#include "reduction/eigensolver/ordering.h"

namespace elastogear::reduction {
namespace {

enum Job { start = -1, end = -2, analyse = 1, factorise = 2, solve = 3 };
enum class Part { whole = 0, condense = 1, expand = 2 };  // of a solution, ICNTL(26)
constexpr int kSymmetric = 2;                             // indefinite: pivots of both signs
constexpr int kWorkspace = 30;                            // per cent above MUMPS' estimate
constexpr int kMaxWorkspace = 1000;                       // per cent
constexpr int kSharedFront = 9;         // KEEP: order from which a front's rows are shared among ranks
constexpr int kSingular = -10;          // INFOG(1)
constexpr int kWorkspaceTooSmall = -9;  // INFOG(1), and -8 for the integers
constexpr int kOutOfMemory[] = {-5, -7, -13};

}  // namespace

struct ShiftedFactor::Solver {
  Mat K, M;
  MPI_Comm comm;
  int rank = 0;
  DMUMPS_STRUC_C id = {};
  // Own entries of the lower triangle, from 1: those of K and, where its sparsity is another, those of M
  // again, for MUMPS adds up what comes twice.
  std::vector<int> row = {}, column = {};
  bool same_sparsity = true;
  std::vector<double> value = {};                // of K - sigma M there
  std::vector<int> position = {};                // of each row in the elimination, from 1; rank 0
  std::vector<int> n_rows = {}, first_row = {};  // of each rank
  std::vector<double> right_hand_sides = {};     // on rank 0 of several
  std::vector<int> kept = {};                    // rows that are not eliminated, from 1
  Eigen::MatrixXd schur = {};                    // of these

  int& icntl(int i) { return id.icntl[i - 1]; }
  int infog(int i) const { return id.infog[i - 1]; }

  int call(Job job) {
    id.job = job;
    dmumps_c(&id);
    return infog(1);
  }

  void check_call(Job job) { require_success(call(job), "in phase ", static_cast<int>(job)); }

  template <class... Where>
  void require_success(int code, const Where&... where) const {
    if (std::ranges::count(kOutOfMemory, code) > 0) throw std::bad_alloc();
    require(code >= 0, "MUMPS error ", code, " (detail ", infog(2), ") ", where...);
  }

  void check_solve(double* B, int columns, Part part = Part::whole) {
    id.rhs = B;
    id.nrhs = columns;
    id.lrhs = id.n;
    icntl(26) = static_cast<int>(part);
    icntl(27) = columns;  // all at once
    check_call(Job::solve);
  }

  template <class F>
  void visit_lower(Mat A, F&& f) {
    const int first = first_row[rank];
    for (int i = first; i < first + n_rows[rank]; ++i) {
      PetscInt n = 0;
      const PetscInt* columns = nullptr;
      const PetscScalar* values = nullptr;
      check(MatGetRow(A, i, &n, &columns, &values));
      for (PetscInt k = 0; k < n; ++k)
        if (columns[k] <= i) f(i, columns[k], values[k]);
      check(MatRestoreRow(A, i, &n, &columns, &values));
    }
  }

  void add_entries(Mat A) {
    visit_lower(A, [&](int i, int j, double) {
      row.push_back(i + 1);
      column.push_back(j + 1);
    });
  }

  bool has_entries_of(Mat A) {
    std::size_t k = 0;
    bool same = true;
    visit_lower(A, [&](int i, int j, double) {
      same = same && k < row.size() && row[k] == i + 1 && column[k] == j + 1;
      ++k;
    });
    return same && k == row.size();
  }
};

void ShiftedFactor::start_up() {
  Solver& s = *solver_;
  const auto [K, M] = std::pair(s.K, s.M);
  int n_ranks = 1;
  MPI_Comm_rank(s.comm, &s.rank);
  MPI_Comm_size(s.comm, &n_ranks);
  const PetscInt* ranges = nullptr;
  check(MatGetOwnershipRanges(K, &ranges));
  for (int r = 0; r < n_ranks; ++r) {
    s.first_row.push_back(ranges[r]);
    s.n_rows.push_back(ranges[r + 1] - ranges[r]);
  }
  s.add_entries(K);
  s.same_sparsity = !M || s.has_entries_of(M);
  if (!s.same_sparsity) s.add_entries(M);
  s.value.resize(s.row.size());
  s.id.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(s.comm));
  s.id.sym = kSymmetric;
  s.id.par = 1;
  s.check_call(start);
  for (int stream : {1, 2, 3, 4}) s.icntl(stream) = 0;  // silent
  s.icntl(13) = 1;  // no ScaLAPACK on the root: it counts no negative pivots
  s.icntl(14) = kWorkspace;
  s.icntl(18) = 3;  // entries come distributed
  // Two ranks have one subtree each. Sharing the few fronts above would make them wait for one another in
  // every solve, which costs more than one rank idling there.
  if (n_ranks == 2) s.id.keep[kSharedFront - 1] = ranges[n_ranks];
  s.id.n = ranges[n_ranks];
  s.id.nnz_loc = static_cast<MUMPS_INT8>(s.row.size());
  s.id.irn_loc = s.row.data();
  s.id.jcn_loc = s.column.data();
  s.id.a_loc = s.value.data();
}

// position: of each row in the order of elimination, from 0.
void ShiftedFactor::analyse_in_order(std::vector<int> position) {
  Solver& s = *solver_;
  s.position = std::move(position);
  for (int& p : s.position) ++p;
  s.icntl(7) = 1;  // the order is given
  s.id.perm_in = s.position.data();
  s.check_call(analyse);
}

ShiftedFactor::ShiftedFactor(Mat K, Mat M, Ordering ordering) : solver_(new Solver{K, M, comm_of(K)}) {
  start_up();
  if (ordering == Ordering::metis)
    analyse_in_order(nested_dissection(K));
  else
    solver_->check_call(analyse);
}

ShiftedFactor::ShiftedFactor(Mat K, Mat M, const std::vector<int>& kept)
    : solver_(new Solver{K, M, comm_of(K)}) {
  start_up();
  Solver& s = *solver_;
  require(s.n_rows.size() == 1, "rows can be kept of a matrix on one rank only");
  const auto n_kept = static_cast<Eigen::Index>(kept.size());
  for (int row : kept) s.kept.push_back(row + 1);
  s.schur.setZero(n_kept, n_kept);
  s.icntl(19) = 1;  // as a whole: its lower triangle by rows is the upper one by columns
  s.id.size_schur = static_cast<MUMPS_INT>(n_kept);
  s.id.listvar_schur = s.kept.data();
  s.id.schur = s.schur.data();
  s.id.lredrhs = static_cast<MUMPS_INT>(n_kept);
  analyse_in_order(nested_dissection(K, kept));
}

ShiftedFactor::~ShiftedFactor() { solver_->call(end); }

int ShiftedFactor::factorise(double sigma) {
  Solver& s = *solver_;
  std::size_t k = 0;
  s.visit_lower(s.K, [&](int, int, double a) { s.value[k++] = a; });
  std::size_t m = s.same_sparsity ? 0 : k;
  if (!s.same_sparsity) std::fill(s.value.begin() + static_cast<std::ptrdiff_t>(k), s.value.end(), 0.0);
  if (s.M) s.visit_lower(s.M, [&](int, int, double a) { s.value[m++] -= sigma * a; });
  int code = s.call(Job::factorise);
  while ((code == kWorkspaceTooSmall || code == kWorkspaceTooSmall + 1) && s.icntl(14) < kMaxWorkspace) {
    s.icntl(14) *= 2;
    code = s.call(Job::factorise);
  }
  if (code == kSingular) fail_singular("a pivot is zero");
  s.require_success(code, "in the factorisation at sigma = ", sigma, " rad^2/s^2");
  return s.infog(12);
}

void ShiftedFactor::solve(Eigen::Ref<Eigen::MatrixXd> B) {
  Solver& s = *solver_;
  const int n = s.id.n, columns = static_cast<int>(B.cols()), own = s.n_rows[s.rank];
  const bool serial = s.n_rows.size() == 1;
  if (!serial && s.rank == 0) s.right_hand_sides.resize(static_cast<std::size_t>(n) * columns);
  double* all = serial ? B.data() : s.right_hand_sides.data();
  const auto column = [&](int j) { return s.rank == 0 ? all + static_cast<std::ptrdiff_t>(j) * n : nullptr; };
  for (int j = 0; !serial && j < columns; ++j)
    MPI_Gatherv(B.col(j).data(), own, MPI_DOUBLE, column(j), s.n_rows.data(), s.first_row.data(), MPI_DOUBLE,
                0, s.comm);
  s.check_solve(all, columns);
  for (int j = 0; !serial && j < columns; ++j)
    MPI_Scatterv(column(j), s.n_rows.data(), s.first_row.data(), MPI_DOUBLE, B.col(j).data(), own, MPI_DOUBLE,
                 0, s.comm);
}

const Eigen::MatrixXd& ShiftedFactor::schur() const { return solver_->schur; }

Eigen::MatrixXd ShiftedFactor::condense(Eigen::Ref<Eigen::MatrixXd> B) {
  Eigen::MatrixXd reduced(solver_->schur.rows(), B.cols());
  solver_->id.redrhs = reduced.data();
  solver_->check_solve(B.data(), static_cast<int>(B.cols()), Part::condense);
  return reduced;
}

void ShiftedFactor::expand(Eigen::MatrixXd X, Eigen::Ref<Eigen::MatrixXd> B) {
  solver_->id.redrhs = X.data();
  solver_->check_solve(B.data(), static_cast<int>(B.cols()), Part::expand);
}

FactorSize ShiftedFactor::size() const {
  const double million = 1e6;
  const int entries = solver_->infog(20);  // negative: in millions
  return {entries < 0 ? -million * entries : entries, solver_->id.rinfog[0]};
}

}  // namespace elastogear::reduction
