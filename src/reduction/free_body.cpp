#include "elastogear/reduction/free_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <vector>

#include "elastogear/base/error.h"
#include "reduction/dense/dense_eigenproblem.h"
#include "reduction/dense/residual.h"

namespace elastogear::reduction {
namespace {

constexpr int kRigid = 6;
constexpr int kFields = 30;                // complete polynomials of degree 2 in three directions
constexpr double kShiftPerEstimate = 0.1;  // of the first elastic eigenvalue, whose estimate is too high
constexpr double kRigidEnergy = 1e-4;  // of the same estimate: above roundoff, below any spring that matters
constexpr double kDependent = 1e-6;  // what orthogonalising leaves of a field that the mesh cannot tell apart

// x y z in units of the body's size, from the middle of its box: a well-conditioned set of fields.
Eigen::Matrix3Xd centred(const Eigen::Matrix3Xd& X) {
  if (X.cols() == 0) return X;
  const Eigen::Vector3d low = X.rowwise().minCoeff(), high = X.rowwise().maxCoeff();
  return (X.colwise() - Eigen::Vector3d((low + high) / 2)) / (high - low).norm();
}

// Field 0..5: unit translations and rotations; 6..11: linear ones with strain; 12..29: quadratic ones.
Eigen::Vector3d field(int index, const Eigen::Vector3d& x) {
  constexpr std::array<std::array<int, 2>, 6> kPair = {{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
  if (index < 3) return Eigen::Vector3d::Unit(index);
  if (index < kRigid) return Eigen::Vector3d::Unit(index - 3).cross(x);
  const auto [a, b] = kPair[index % 6];
  return index < 12 ? Eigen::Vector3d(x(a) * Eigen::Vector3d::Unit(b))
                    : Eigen::Vector3d(x(a) * x(b) * Eigen::Vector3d::Unit((index - 12) / 6));
}

Eigen::VectorXd field_values(int index, const Eigen::Matrix3Xd& x) {
  Eigen::VectorXd u(x.size());
  for (Eigen::Index i = 0; i < x.cols(); ++i) u.segment<3>(3 * i) = field(index, x.col(i));
  return u;
}

UniqueBV create_basis(Mat M, Vec layout) {
  UniqueBV basis;
  check(BVCreate(comm_of(M), basis.out()));
  check(BVSetSizesFromVec(basis, layout, kFields));
  check(BVSetType(basis, BVVECS));
  check(BVSetMatrix(basis, M, PETSC_FALSE));
  return basis;
}

// Appends v, orthonormalised; a field that depends on the others is left out.
void append(BV basis, Vec v, int& size) {
  PetscReal before = 0, after = 0;
  check(BVInsertVec(basis, size, v));
  check(BVNormColumn(basis, size, NORM_2, &before));
  check(BVOrthogonalizeColumn(basis, size, nullptr, &after, nullptr));
  if (after <= kDependent * before) return;
  check(BVScaleColumn(basis, size, 1 / after));
  ++size;
}

// The fields that the mesh can tell apart; the rigid ones are the first six.
UniqueBV polynomial_basis(Mat M, const fem::VectorGather& gather, const Eigen::Matrix3Xd& X) {
  UniqueVec v;
  check(MatCreateVecs(M, v.out(), nullptr));
  UniqueBV basis = create_basis(M, v);
  const Eigen::Matrix3Xd x = centred(X);
  int size = 0;
  for (int i = 0; i < kFields; ++i) {
    gather.scatter(field_values(i, x), v);
    append(basis, v, size);
    require(i >= kRigid || size == i + 1,
            "the nodes lie on one line: a free body needs six independent rigid motions");
  }
  require(size > kRigid, "the free body has no elastic degree of freedom");
  check(BVSetActiveColumns(basis, 0, size));
  return basis;
}

// V' K V of the active columns.
Eigen::MatrixXd project(Mat K, BV V) {
  PetscInt size = 0;
  UniqueMat dense;
  const PetscScalar* values = nullptr;
  check(BVGetActiveColumns(V, nullptr, &size));
  check(MatCreateSeqDense(PETSC_COMM_SELF, size, size, nullptr, dense.out()));
  check(BVMatProject(V, K, V, dense));
  check(MatDenseGetArrayRead(dense, &values));
  const Eigen::MatrixXd K_r = Eigen::Map<const Eigen::MatrixXd>(values, size, size);
  check(MatDenseRestoreArrayRead(dense, &values));
  return (K_r + K_r.transpose()) / 2;
}

[[noreturn]] void fail_count(int zero) {
  fail("the free body has ", zero >= kRigid ? "more than six" : std::to_string(zero).c_str(),
       " modes of zero frequency, must be the six rigid ones: ",
       zero >= kRigid ? "it has parts that do not hang together, or by an edge or a node only"
                      : "something holds it");
}

// K + shift M: docs/theory, Eq. (2.8).
UniqueMat shifted_stiffness(Mat K, Mat M, double shift) {
  UniqueMat shifted;
  check(MatDuplicate(K, MAT_COPY_VALUES, shifted.out()));
  check(MatAXPY(shifted, shift, M, SAME_NONZERO_PATTERN));
  check(MatSetOption(shifted, MAT_SPD, PETSC_TRUE));
  return shifted;
}

Eigen::VectorXd joined(const Eigen::VectorXd& head, const Eigen::VectorXd& tail) {
  Eigen::VectorXd all(head.size() + tail.size());
  all << head, tail;
  return all;
}

// Options of the search in K + shift M, whose states count the rigid modes too.
EigenOptions with_rigid_modes(const EigenOptions& options, double shift) {
  EigenOptions all = options;
  all.n_modes += kRigid;
  if (all.interval) all.interval = Interval{.upper = options.interval->upper + shift};
  if (options.start.eigenvalue.size() > 0) {
    all.start.eigenvalue = joined(Eigen::VectorXd::Zero(kRigid), options.start.eigenvalue).array() + shift;
    all.start.residual = joined(Eigen::VectorXd::Zero(kRigid), options.start.residual);
  }
  if (!options.commit) return all;
  all.commit = [commit = options.commit, shift](const SearchState& state) {
    const Eigen::Index elastic = state.eigenvalue.size() - kRigid;
    if (elastic <= 0) return;
    SearchState own = state;
    own.eigenvalue = state.eigenvalue.tail(elastic).array() - shift;
    own.residual = state.residual.tail(elastic);
    commit(own);
  };
  return all;
}

}  // namespace

RigidModes find_rigid_modes(Mat K, Mat M, const fem::VectorGather& gather, const Eigen::Matrix3Xd& X) {
  RigidModes rigid{polynomial_basis(M, gather, X), 0};
  const Eigen::MatrixXd K_r = project(K, rigid.R);
  const Eigen::Index n = K_r.rows() - kRigid;
  Eigen::MatrixXd elastic = K_r.bottomRightCorner(n, n);
  const double estimate = diagonalise(elastic)(0);
  if (estimate <= zero_eigenvalue(K, M)) fail_count(kRigid);
  const double energy = K_r.topLeftCorner<kRigid, kRigid>().cwiseAbs().maxCoeff();
  require(energy <= kRigidEnergy * estimate, "the stiffness resists rigid motions of the nodes (", energy,
          " rad^2/s^2, an elastic mode has about ", estimate,
          "): something holds the body, or the nodes' coordinates do not belong to the stiffness");
  rigid.shift = kShiftPerEstimate * estimate;
  check(BVResize(rigid.R, kRigid, PETSC_TRUE));
  check(BVSetActiveColumns(rigid.R, 0, kRigid));
  return rigid;
}

Eigenmodes find_free_modes(Mat K, Mat M, const RigidModes& rigid, const EigenOptions& options,
                           const ModeSink& sink, const Progress& progress) {
  PetscInt n = 0;
  check(MatGetSize(K, &n, nullptr));
  require(options.interval || (options.n_modes > 0 && options.n_modes <= n - kRigid),
          "modes = ", options.n_modes, ", must be between 1 and the number of elastic degrees of freedom, ",
          n - kRigid);
  require(!options.interval || (options.interval->lower <= 0 && options.interval->upper > 0),
          "the interval of a free body (-eps_interval) must begin at or below 0 and end above");
  const UniqueMat shifted = shifted_stiffness(K, M, rigid.shift);
  const double zero = zero_eigenvalue(K, M);
  const Residual w = make_residual(K);
  std::vector<double> eigenvalues(options.start.eigenvalue.begin(), options.start.eigenvalue.end());
  std::vector<double> residuals(options.start.residual.begin(), options.start.residual.end());
  const auto deliver = [&](int index, Vec phi) {
    double eigenvalue = 0, residual = 0;
    check(VecCopy(phi, w.phi));
    if (index >= kRigid) check(BVOrthogonalizeVec(rigid.R, w.phi, nullptr, nullptr, nullptr));
    measure(K, M, w, &eigenvalue, &residual);
    if ((index < kRigid) != (eigenvalue <= zero)) fail_count(index);
    if (index < kRigid) return;
    const std::size_t k = static_cast<std::size_t>(index - kRigid);
    eigenvalues.resize(k);
    residuals.resize(k);
    eigenvalues.push_back(eigenvalue);
    residuals.push_back(residual);
    sink(index - kRigid, w.phi);
  };
  const Eigenmodes all =
      find_eigenmodes(shifted, M, with_rigid_modes(options, rigid.shift), deliver, progress);
  const Eigen::Index count = all.eigenvalue.size() - kRigid;
  return {Eigen::Map<const Eigen::VectorXd>(eigenvalues.data(), count),
          Eigen::Map<const Eigen::VectorXd>(residuals.data(), count), all.orthogonality, all.iterations};
}

}  // namespace elastogear::reduction
