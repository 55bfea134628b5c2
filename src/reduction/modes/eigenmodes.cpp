#include "elastogear/reduction/eigenmodes.h"

#include <slepceps.h>

#include <algorithm>
#include <cmath>

#include "elastogear/base/error.h"
#include "reduction/eigensolver/factorisation.h"
#include "reduction/eigensolver/spectrum_slicing.h"
#include "reduction/modes/dense_modes.h"
#include "reduction/static_response/residual.h"

namespace elastogear::reduction {
namespace {

using UniqueEPS = Handle<EPS, EPSDestroy>;

constexpr double kSameModulus = 1e-6;

struct Monitor {
  const Progress* progress;
  int wanted;
};

PetscErrorCode monitor(EPS, PetscInt, PetscInt converged, PetscScalar*, PetscScalar*, PetscReal*, PetscInt,
                       void* context) {
  const auto& m = *static_cast<Monitor*>(context);
  std::exception_ptr ignored;
  return guard(ignored, [&] {
    report(*m.progress, "eigenmodes", std::min(1.0, static_cast<double>(converged) / m.wanted));
  });
}

int size_of(Mat K) {
  PetscInt n = 0;
  check(MatGetSize(K, &n, nullptr));
  return static_cast<int>(n);
}

// A few modes more than wanted: the last of a group of equal eigenvalues then is not cut off, and a gap
// above the wanted ones is known.
int guarded_count(int wanted, int n) { return std::min(n, wanted + 2 + wanted / 20); }

UniqueEPS create_solver(Mat K, Mat M, const EigenOptions& options) {
  UniqueEPS eps;
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(EPSCreate(PetscObjectComm(reinterpret_cast<PetscObject>(K)), eps.out()));
  check(EPSSetOptionsPrefix(eps, options.prefix.c_str()));
  check(EPSSetOperators(eps, K, M));
  check(EPSSetProblemType(eps, EPS_GHEP));
  check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  check(EPSSetTarget(eps, 0));
  check(EPSSetDimensions(eps, guarded_count(options.n_modes, size_of(K)), PETSC_DEFAULT, PETSC_DEFAULT));
  check(EPSSetTolerances(eps, options.tolerance, PETSC_DEFAULT));
  check(EPSSetPurify(eps, PETSC_FALSE));  // M is definite: purifying costs a solve per mode for nothing
  check(EPSGetST(eps, &st));
  check(STSetType(st, STSINVERT));
  check(STGetKSP(st, &ksp));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(EPSSetFromOptions(eps));
  return eps;
}

void solve(EPS eps, const EigenOptions& options, const Progress& progress) {
  Monitor context{&progress, options.n_modes};
  check(EPSMonitorSet(eps, monitor, &context, nullptr));
  report(progress, "eigenmodes", 0);
  const PetscErrorCode code = EPSSolve(eps);
  if (code == PETSC_ERR_NOT_CONVERGED || code == PETSC_ERR_CONV_FAILED || code == PETSC_ERR_MAT_CH_ZRPVT)
    fail_singular("its factorisation failed");
  check(code);
  check(EPSMonitorCancel(eps));
  PetscInt converged = 0;
  check(EPSGetConverged(eps, &converged));
  require(converged >= options.n_modes, "the eigensolver found ", converged, " of ", options.n_modes,
          " modes; allow more iterations (-", options.prefix, "eps_max_it) or a larger basis (-",
          options.prefix, "eps_ncv)");
}

// Converged pairs in ascending order of eigenvalue.
std::vector<std::pair<double, int>> sorted_pairs(EPS eps) {
  PetscInt converged = 0;
  check(EPSGetConverged(eps, &converged));
  std::vector<std::pair<double, int>> pairs;
  for (int i = 0; i < static_cast<int>(converged); ++i) {
    PetscScalar lambda = 0;
    check(EPSGetEigenvalue(eps, i, &lambda, nullptr));
    pairs.emplace_back(lambda, i);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// A shift between the last wanted and the next known eigenvalue; the number of eigenvalues below it that are
// known. Equal eigenvalues stay together.
std::pair<double, int> shift_above(const std::vector<std::pair<double, int>>& pairs, int wanted) {
  constexpr double kGap = 1e-4;
  for (std::size_t i = static_cast<std::size_t>(wanted); i < pairs.size(); ++i) {
    const double below = pairs[i - 1].first, above = pairs[i].first;
    if (above - below > kGap * above) return {(below + above) / 2, static_cast<int>(i)};
  }
  return {pairs.back().first * (1 + kGap), static_cast<int>(pairs.size())};
}

// `wanted`, and more when their eigenvalues are as good as equal to the last one's.
int whole_group(const std::vector<std::pair<double, int>>& pairs, int wanted) {
  constexpr double kEqual = 1e-5;
  std::size_t n = static_cast<std::size_t>(wanted);
  while (n < pairs.size() && pairs[n].first - pairs[n - 1].first < kEqual * pairs[n].first) ++n;
  return static_cast<int>(n);
}

// Largest |phi_i' M phi_j|, i != j, of the first `count` pairs: the solver's basis consists of the modes.
double orthogonality(EPS eps, const std::vector<std::pair<double, int>>& pairs, int count) {
  BV basis = nullptr;
  UniqueMat dense;
  const PetscScalar* values = nullptr;
  PetscInt n = static_cast<PetscInt>(pairs.size());
  check(EPSGetBV(eps, &basis));
  check(BVSetActiveColumns(basis, 0, n));
  check(MatCreateSeqDense(PETSC_COMM_SELF, n, n, nullptr, dense.out()));
  check(BVDot(basis, basis, dense));
  check(MatDenseGetArrayRead(dense, &values));
  const Eigen::Map<const Eigen::MatrixXd> gram(values, n, n);
  double largest = 0;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < i; ++j) largest = std::max(largest, std::abs(gram(pairs[i].second, pairs[j].second)));
  check(MatDenseRestoreArrayRead(dense, &values));
  return largest;
}

void commit(const EigenOptions& options, const Eigenmodes& modes) {
  if (!options.commit) return;
  SearchState state;
  state.eigenvalue = modes.eigenvalue;
  state.residual = modes.residual;
  state.orthogonality = modes.orthogonality;
  state.iterations = modes.iterations;
  options.commit(state);
}

void verify_count(Mat K, Mat M, double sigma, int known) {
  const int exact = count_eigenvalues_below(K, M, sigma);
  require(exact == known, "the eigensolver found ", known, " of the ", exact, " modes below ",
          std::sqrt(sigma) / (2 * M_PI),
          " Hz; use a larger basis (-eps_ncv) or a smaller tolerance (-eps_tol)");
}

// All modes from one shift-and-invert about 0; the count is checked afterwards.
Eigenmodes find_by_slepc(Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                         const Progress& progress) {
  UniqueEPS eps = create_solver(K, M, options);
  solve(eps, options, progress);
  const auto pairs = sorted_pairs(eps);
  require_definite(K, M, pairs.front().first);
  const int count = options.whole_pairs ? whole_group(pairs, options.n_modes) : options.n_modes;
  Eigenmodes modes{Eigen::VectorXd(count), Eigen::VectorXd(count), orthogonality(eps, pairs, count)};
  PetscInt iterations = 0;
  check(EPSGetIterationNumber(eps, &iterations));
  modes.iterations = static_cast<int>(iterations);
  const Residual w = make_residual(K);
  for (int i = 0; i < count; ++i) {
    check(EPSGetEigenvector(eps, pairs[i].second, w.phi, nullptr));
    measure(K, M, w, &modes.eigenvalue(i), &modes.residual(i));
    sink(i, w.phi);
  }
  eps = {};  // frees the factorisation before the next one
  if (options.verify_count) {
    const auto [sigma, known] = shift_above(pairs, options.n_modes);
    verify_count(K, M, sigma, known);
  }
  commit(options, modes);
  return modes;
}

}  // namespace

int count_eigenvalues_below(Mat K, Mat M, double sigma) { return ShiftedFactor(K, M).factorise(sigma); }

void require_mode_count(int n_modes, int n_free) {
  require(n_modes > 0 && n_modes <= n_free, "modes = ", n_modes,
          ", must be between 1 and the number of free degrees of freedom, ", n_free);
}

Eigenmodes find_eigenmodes(Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                           const Progress& progress) {
  require_mode_count(options.n_modes, size_of(K));
  const SearchState& start = options.start;
  if (start.eigenvalue.size() >= options.n_modes)
    return {start.eigenvalue, start.residual, start.orthogonality, start.iterations};
  if (options.window == 0) return find_by_slepc(K, M, options, sink, progress);
  return options.n_rigid == 0 && suits_dense(size_of(K), options.n_modes)
             ? find_by_lapack(K, M, options, sink, progress)
             : find_by_slices(K, M, options, sink, progress);
}

void fix_sign(Eigen::VectorXd& phi) {
  const double largest = phi.lpNorm<Eigen::Infinity>();
  const auto first = std::find_if(phi.begin(), phi.end(),
                                  [&](double x) { return std::abs(x) >= (1 - kSameModulus) * largest; });
  if (first != phi.end() && *first < 0) phi = -phi;
}

}  // namespace elastogear::reduction
