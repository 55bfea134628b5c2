#include "reduction/bases/ritz_bases.h"

#include <algorithm>
#include <cmath>

#include "elastogear/base/error.h"
#include "elastogear/base/text.h"
#include "elastogear/fem/assembly.h"
#include "reduction/dense/residual.h"
#include "reduction/eigensolver/factorisation.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kSolvedTogether = 96;  // right-hand sides that go through the factor together
constexpr const char* kStage = "static responses";

std::pair<int, int> own_rows(Mat K) {
  PetscInt begin = 0, end = 0;
  check(MatGetOwnershipRange(K, &begin, &end));
  return {static_cast<int>(begin), static_cast<int>(end)};
}

void factorise_stiffness(ShiftedFactor& factor) {
  const int negative = factor.factorise(0);
  if (negative > 0) fail_singular(std::to_string(negative) + " pivots are negative");
}

// Adds K^-1 e for the unit forces e on the interface.
void add_static_solutions(RitzSpace& space, const RitzTask& task, const Progress& progress) {
  const auto [begin, end] = own_rows(task.K);
  const std::vector<int>& row = task.interface_rows;
  const int n = static_cast<int>(row.size());
  ShiftedFactor factor(task.K, task.M);
  report(progress, kStage, 0);
  factorise_stiffness(factor);
  for (int first = 0; first < n; first += kSolvedTogether) {
    MatrixXd U = MatrixXd::Zero(end - begin, std::min(kSolvedTogether, n - first));
    for (int j = 0; j < U.cols(); ++j)
      if (row[first + j] >= begin && row[first + j] < end) U(row[first + j] - begin, j) = 1;
    factor.solve(U);
    extend(space, std::move(U), space.room());
    report(progress, kStage, static_cast<double>(std::min(n, first + kSolvedTogether)) / n);
  }
}

// Eigenmodes, rows of this rank.
MatrixXd own_modes(Mat K, Mat M, const EigenOptions& options, const Progress& progress) {
  const auto [begin, end] = own_rows(K);
  MatrixXd own(end - begin, options.n_modes);
  const auto keep = [&](int k, Vec phi) {
    const PetscScalar* values = nullptr;
    if (k >= own.cols()) own.conservativeResize(Eigen::NoChange, k + 1);
    check(VecGetArrayRead(phi, &values));
    own.col(k) = Eigen::Map<const Eigen::VectorXd>(values, own.rows());
    check(VecRestoreArrayRead(phi, &values));
  };
  const Eigenmodes modes = find_eigenmodes(K, M, options, keep, progress);
  return own.leftCols(modes.eigenvalue.size());
}

void add_in_blocks(RitzSpace& space, const MatrixXd& W) {
  for (Index begin = 0; begin < W.cols(); begin += kSolvedTogether)
    extend(space, W.middleCols(begin, std::min<Index>(kSolvedTogether, W.cols() - begin)), space.room());
}

RitzSpace modal_attachment(const RitzTask& task, const RitzSpace& empty, const Progress& progress) {
  const MatrixXd modes = own_modes(task.K, task.M, task.eigen, progress);
  const int capacity = static_cast<int>(modes.cols() + static_cast<Index>(task.interface_rows.size()));
  RitzSpace space = make_space(*empty.K, *empty.M, capacity);
  add_in_blocks(space, modes);
  add_static_solutions(space, task, progress);
  return space;
}

double shift_in_rad(double hz) { return std::pow(2 * M_PI * hz, 2); }

// Columns of one shift, until there are `size`. docs/theory, Eq. (2.18).
void add_chain(RitzSpace& space, ShiftedFactor& factor, MatrixXd W, int size) {
  factor.solve(W);
  MatrixXd Q = extend(space, std::move(W), size - space.size);
  while (space.size < size && Q.cols() > 0) {
    Q = (*space.M)(Q);
    factor.solve(Q);
    Q = extend(space, std::move(Q), size - space.size);
  }
}

RitzSpace krylov(const RitzTask& task, const RitzSpace& empty, const Progress& progress) {
  RitzSpace space = make_space(*empty.K, *empty.M, task.eigen.n_modes);
  ShiftedFactor factor(task.K, task.M);
  const auto& shift = task.options.shift;
  report(progress, "Krylov space", 0);
  for (std::size_t j = 0; j < shift.size(); ++j) {
    const int end = static_cast<int>((j + 1) * static_cast<std::size_t>(task.eigen.n_modes) / shift.size());
    factor.factorise(shift_in_rad(shift[j]));
    add_chain(space, factor, task.loads, end);
    report(progress, "Krylov space", static_cast<double>(j + 1) / static_cast<double>(shift.size()));
  }
  require(space.size > 0, "krylov: no load on the surface moves the body, its nodes are restrained");
  return space;
}

// Number of interface modes of a body with n rows, n_b of them on the interface.
int interface_count(const RitzTask& task, int n) {
  const int n_modes = task.eigen.n_modes, n_b = static_cast<int>(task.interface_rows.size()),
            asked = task.options.interface_modes, most = std::min(n_b, n_modes),
            least = std::max(0, n_modes - (n - n_b));
  if (asked == 0) return std::clamp((n_modes + 1) / 2, least, most);
  require(asked >= least && asked <= most, "interface_modes = ", asked, ", must be ", std::max(1, least),
          "..", most, ": of ", n_modes, " modes in all, with ", n_b, " displacements on the interface and ",
          n - n_b, " others");
  return asked;
}

// Own rows of the lowest n vectors of the condensed pencil. The constraint modes span what K^-1 makes of the
// forces on the interface. docs/theory, Eq. (2.17).
MatrixXd interface_vectors(const RitzTask& task, const RitzSpace& empty, int n, const Progress& progress) {
  RitzSpace constraint = make_space(*empty.K, *empty.M, static_cast<int>(task.interface_rows.size()));
  add_static_solutions(constraint, task, progress);
  return combine(constraint, ritz_vectors(constraint).s.leftCols(std::min(n, constraint.size)));
}

// Rows of this rank that are not on the interface.
std::vector<PetscInt> inner_rows(const RitzTask& task) {
  const auto [begin, end] = own_rows(task.K);
  std::vector<PetscInt> inner;
  for (int row = begin; row < end; ++row)
    if (!std::binary_search(task.interface_rows.begin(), task.interface_rows.end(), row))
      inner.push_back(row);
  return inner;
}

fem::Matrices held(const RitzTask& task, const std::vector<PetscInt>& inner) {
  UniqueIS rows;
  fem::Matrices part;
  check(ISCreateGeneral(comm_of(task.K), static_cast<PetscInt>(inner.size()), inner.data(), PETSC_COPY_VALUES,
                        rows.out()));
  check(MatCreateSubMatrix(task.K, rows, rows, MAT_INITIAL_MATRIX, part.K.out()));
  check(MatCreateSubMatrix(task.M, rows, rows, MAT_INITIAL_MATRIX, part.M.out()));
  for (Mat A : {part.K.get(), part.M.get()}) check(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  return part;
}

// Own rows of modes of the body that is held at the interface.
MatrixXd fixed_interface_modes(const RitzTask& task, int n, const Progress& progress) {
  const auto [begin, end] = own_rows(task.K);
  const std::vector<PetscInt> inner = inner_rows(task);
  const fem::Matrices part = held(task, inner);
  EigenOptions options = task.eigen;
  options.n_modes = n;
  const MatrixXd modes = own_modes(part.K, part.M, options, progress);
  MatrixXd whole = MatrixXd::Zero(end - begin, modes.cols());
  for (std::size_t i = 0; i < inner.size(); ++i)
    whole.row(inner[i] - begin) = modes.row(static_cast<Index>(i));
  return whole;
}

RitzSpace craig_bampton(const RitzTask& task, const RitzSpace& empty, const Progress& progress) {
  const int n_interface = interface_count(task, empty.K->n()), n_fixed = task.eigen.n_modes - n_interface;
  const MatrixXd vectors = interface_vectors(task, empty, n_interface, progress);
  const MatrixXd modes = n_fixed > 0 ? fixed_interface_modes(task, n_fixed, progress) : MatrixXd();
  RitzSpace space = make_space(*empty.K, *empty.M, static_cast<int>(vectors.cols() + modes.cols()));
  add_in_blocks(space, vectors);
  add_in_blocks(space, modes);
  return space;
}

}  // namespace

void require_affordable(const std::vector<int>& interface_rows, const std::vector<std::string>& sets) {
  const std::string names = join(sets);
  require(!interface_rows.empty(), "all nodes of ", names, " are restrained: forces there move nothing");
  require(interface_rows.size() <= static_cast<std::size_t>(kMostInterface), "the nodes of ", names, " have ",
          interface_rows.size(), " displacements, and a static solution for each is affordable up to ",
          kMostInterface, ": name smaller face sets by the option loaded, or take basis modal_residual");
}

RitzSpace find_space(const RitzTask& task, const BlockProduct& K, const BlockProduct& M,
                     const Progress& progress) {
  require_mode_count(task.eigen.n_modes, K.n());
  const RitzSpace empty{&K, &M, {}, 0};
  switch (task.options.kind) {
    case RitzKind::modal_attachment:
      return modal_attachment(task, empty, progress);
    case RitzKind::krylov:
      return krylov(task, empty, progress);
    case RitzKind::craig_bampton:
      return craig_bampton(task, empty, progress);
  }
  fail("a basis that is none");
}

}  // namespace elastogear::reduction
