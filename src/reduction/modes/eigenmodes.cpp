#include "elastogear/reduction/eigenmodes.h"

#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "elastogear/base/error.h"
#include "elastogear/reduction/block_lanczos.h"
#include "reduction/dense/residual.h"
#include "reduction/eigensolver/factorisation.h"
#include "reduction/modes/dense_modes.h"

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

// The type that the options database asks for, or an empty text.
std::string asked_type(const EigenOptions& options) {
  char type[256] = "";
  PetscBool given = PETSC_FALSE;
  check(PetscOptionsGetString(nullptr, options.prefix.c_str(), "-eps_type", type, sizeof type, &given));
  return type;
}

std::string solver_type(const EigenOptions& options) {
  const std::string asked = asked_type(options);
  return !asked.empty() ? asked : options.window == 0 ? EPSKRYLOVSCHUR : kBlockLanczos;
}

void set_block_lanczos(EPS eps, const EigenOptions& options) {
  block_lanczos_set(eps, {.window = std::max(0, options.window),
                          .block = options.block,
                          .verify_count = options.verify_count,
                          .whole_pairs = options.whole_pairs,
                          .factor = options.factor,
                          .counted_below = options.counted_below,
                          .start = options.start});
}

// Shift-and-invert about 0 by MUMPS' Cholesky.
void set_other_type(EPS eps) {
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  check(EPSSetTarget(eps, 0));
  check(EPSSetPurify(eps, PETSC_FALSE));  // M is definite: purifying costs a solve per mode for nothing
  check(EPSGetST(eps, &st));
  check(STSetType(st, STSINVERT));
  check(STGetKSP(st, &ksp));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
}

// L L' of a definite K does not count eigenvalues, L D L' does.
void allow_counting(Mat K) {
  check(MatSetOption(K, MAT_SPD, PETSC_FALSE));
  check(MatSetOption(K, MAT_SYMMETRIC, PETSC_TRUE));
}

bool is_block_lanczos(EPS eps) {
  PetscBool same = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(eps), kBlockLanczos, &same));
  return same;
}

// The numbers of modes are those of this search, whatever the database says.
void set_extent(EPS eps, const EigenOptions& options, int count) {
  PetscInt ncv = 0, mpd = 0;
  check(EPSGetDimensions(eps, nullptr, &ncv, &mpd));
  if (!options.interval) {
    EPSWhich which = EPS_SMALLEST_REAL;
    check(EPSSetDimensions(eps, count, ncv, mpd));
    check(EPSGetWhichEigenpairs(eps, &which));
    if (which == EPS_ALL)
      check(EPSSetWhichEigenpairs(eps, is_block_lanczos(eps) ? EPS_SMALLEST_REAL : EPS_TARGET_MAGNITUDE));
    return;
  }
  const auto& [lower, upper] = *options.interval;
  check(EPSSetWhichEigenpairs(eps, EPS_ALL));
  check(EPSSetInterval(eps, std::max(lower, PETSC_MIN_REAL), std::min(upper, PETSC_MAX_REAL)));
}

UniqueEPS create_solver(Mat K, Mat M, const EigenOptions& options) {
  UniqueEPS eps;
  const std::string type = solver_type(options);
  const bool ours = type == kBlockLanczos;
  const int count = ours ? options.n_modes : guarded_count(options.n_modes, size_of(K));
  check(EPSCreate(comm_of(K), eps.out()));
  check(EPSSetOptionsPrefix(eps, options.prefix.c_str()));
  check(EPSSetOperators(eps, K, M));
  check(EPSSetProblemType(eps, EPS_GHEP));
  check(EPSSetType(eps, type.c_str()));
  check(EPSSetTolerances(eps, options.tolerance, PETSC_DEFAULT));
  if (ours)
    set_block_lanczos(eps, options);
  else
    set_other_type(eps);
  if (!ours && options.interval) allow_counting(K);
  check(EPSSetFromOptions(eps));
  set_extent(eps, options, count);
  return eps;
}

void require_converged(PetscInt converged, const EigenOptions& options) {
  if (options.interval)
    require(converged > 0, "no eigenvalue lies between ", options.interval->lower, " and ",
            options.interval->upper, " rad^2/s^2 (-", options.prefix,
            "eps_interval, or modes: auto); take one mode (-modes 1)");
  else
    require(converged >= options.n_modes, "the eigensolver found ", converged, " of ", options.n_modes,
            " modes; allow more iterations (-", options.prefix, "eps_max_it) or a larger basis (-",
            options.prefix, "eps_ncv)");
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
  require_converged(converged, options);
}

// In windows, which are delivered as they are found.
Eigenmodes find_by_block_lanczos(EPS eps, Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                                 const Progress& progress) {
  report(progress, "eigenmodes",  // ordering and the first factor take long in silence
         static_cast<double>(options.start.eigenvalue.size()) / options.n_modes);
  block_lanczos_set_handler(eps, {.mode = sink,
                                  .window = options.commit,
                                  .progress = [&](double done) { report(progress, "eigenmodes", done); },
                                  .lowest = [&](double lowest) { require_definite(K, M, lowest); }});
  block_lanczos_check(eps, EPSSolve(eps));
  const SearchState& state = block_lanczos_state(eps);
  require_converged(state.eigenvalue.size(), options);
  return {state.eigenvalue, state.residual, state.orthogonality, state.iterations};
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

// All modes at once by another type; their count is checked afterwards.
Eigenmodes find_by_other_type(UniqueEPS eps, Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                              const Progress& progress) {
  solve(eps, options, progress);
  const auto pairs = sorted_pairs(eps);
  require_definite(K, M, pairs.front().first);
  const int all = static_cast<int>(pairs.size());
  const int count = options.interval      ? all
                    : options.whole_pairs ? whole_group(pairs, options.n_modes)
                                          : options.n_modes;
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
  if (options.verify_count && !options.interval) {
    const auto [sigma, known] = shift_above(pairs, options.n_modes);
    verify_count(K, M, sigma, known);
  }
  commit(options, modes);
  return modes;
}

}  // namespace

bool asks_slepc(const std::string& prefix) {
  char* all = nullptr;
  check(PetscOptionsGetAll(nullptr, &all));
  std::istringstream words(all);
  check(PetscFree(all));
  const auto asks = [&](const std::string& word) {
    return (word.starts_with("-" + prefix + "eps_") || word.starts_with("-" + prefix + "st_")) &&
           word != "-" + prefix + "eps_nev" && word != "-" + prefix + "eps_interval";
  };
  return std::any_of(std::istream_iterator<std::string>(words), {}, asks);
}

int count_eigenvalues_below(Mat K, Mat M, double sigma) { return ShiftedFactor(K, M).factorise(sigma); }

void require_mode_count(int n_modes, int n_free) {
  require(n_modes > 0 && n_modes <= n_free, "modes = ", n_modes,
          ", must be between 1 and the number of free degrees of freedom, ", n_free);
}

Eigenmodes find_eigenmodes(Mat K, Mat M, const EigenOptions& options, const ModeSink& sink,
                           const Progress& progress) {
  if (!options.interval) {
    require_mode_count(options.n_modes, size_of(K));
    const SearchState& start = options.start;
    if (start.eigenvalue.size() >= options.n_modes)
      return {start.eigenvalue, start.residual, start.orthogonality, start.iterations};
    if (options.window != 0 && !asks_slepc(options.prefix) && suits_dense(size_of(K), options.n_modes))
      return find_by_lapack(K, M, options, sink, progress);
  }
  register_block_lanczos();
  UniqueEPS eps = create_solver(K, M, options);
  return is_block_lanczos(eps) ? find_by_block_lanczos(eps, K, M, options, sink, progress)
                               : find_by_other_type(std::move(eps), K, M, options, sink, progress);
}

void fix_sign(Eigen::VectorXd& phi) {
  const double largest = phi.lpNorm<Eigen::Infinity>();
  const auto first = std::find_if(phi.begin(), phi.end(),
                                  [&](double x) { return std::abs(x) >= (1 - kSameModulus) * largest; });
  if (first != phi.end() && *first < 0) phi = -phi;
}

}  // namespace elastogear::reduction
