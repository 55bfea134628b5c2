#include <slepc/private/epsimpl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "elastogear/base/error.h"
#include "elastogear/reduction/block_lanczos.h"
#include "reduction/slepc/ldl_preconditioner.h"
#include "reduction/slepc/slab_vectors.h"
#include "reduction/slepc/spectrum_slicing.h"

namespace elastogear::reduction {
namespace {

using UniqueBV = Handle<BV, BVDestroy>;

constexpr double kTolerance = 1e-10;
constexpr PetscInt kNoLimit = std::numeric_limits<int>::max();  // counts of the search are int

struct Method {
  BlockLanczosSettings settings = {};
  BlockLanczosHandler handler = {};
  SearchState state = {};
  UniqueBV basis = {};                        // of a window
  PetscInt default_ncv = 0, default_mpd = 0;  // as they were set here: the user has set none
  int most_columns = 0;                       // of the basis
  bool chose_shell = false;                   // of ST, by default
  std::exception_ptr pending = {};            // what ended the last solve
};

Method& method(EPS eps) { return *static_cast<Method*>(eps->data); }

MPI_Comm comm_of(EPS eps) { return PetscObjectComm((PetscObject)eps); }

PetscErrorCode preconditioner(EPS eps, PC* pc) {
  KSP ksp = nullptr;
  PetscCall(STGetKSP(eps->st, &ksp));
  return KSPGetPC(ksp, pc);
}

// ---- set-up

PetscErrorCode set_default_transform(EPS eps) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  KSPType solver = nullptr;
  PCType type = nullptr;
  if (!((PetscObject)eps->st)->type_name) PetscCall(STSetType(eps->st, STSINVERT));
  PetscCall(STGetKSP(eps->st, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(KSPGetType(ksp, &solver));
  PetscCall(PCGetType(pc, &type));
  if (!solver) PetscCall(KSPSetType(ksp, KSPPREONLY));
  if (type) return 0;
  PetscCall(PCSetType(pc, kLdlType));
  PetscCall(STSetMatMode(eps->st, ST_MATMODE_SHELL));
  method(eps).chose_shell = true;
  return 0;
}

// A factorisation of PETSc needs the matrix K - sigma M, and MUMPS' for its inertia.
PetscErrorCode set_up_factorisation(EPS eps, PC pc) {
  PetscBool cholesky = PETSC_FALSE;
  MatSolverType solver = nullptr;
  Mat K = nullptr;
  if (method(eps).chose_shell) PetscCall(STSetMatMode(eps->st, ST_MATMODE_COPY));
  method(eps).chose_shell = false;
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCCHOLESKY, &cholesky));
  if (!cholesky) return 0;
  PetscCall(PCFactorGetMatSolverType(pc, &solver));
  if (!solver) PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(STGetMatrix(eps->st, 0, &K));  // L L' of a definite K would serve the lowest shift alone
  PetscCall(MatSetOption(K, MAT_SPD, PETSC_FALSE));
  return MatSetOption(K, MAT_SYMMETRIC, PETSC_TRUE);
}

PetscErrorCode set_up_transform(EPS eps) {
  PC pc = nullptr;
  PetscBool ldl = PETSC_FALSE;
  PetscCall(preconditioner(eps, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, kLdlType, &ldl));
  if (!ldl) return set_up_factorisation(eps, pc);
  ldl_set_transform(pc, eps->st);
  ldl_set_factor(pc, method(eps).settings.factor);
  return 0;
}

PetscErrorCode check_problem(EPS eps) {
  EPSCheckHermitianDefinite(eps);
  EPSCheckSinvert(eps);
  EPSCheckUnsupported(eps, EPS_FEATURE_ARBITRARY | EPS_FEATURE_REGION | EPS_FEATURE_EXTRACTION |
                               EPS_FEATURE_CONVERGENCE | EPS_FEATURE_STOPPING | EPS_FEATURE_TWOSIDED);
  EPSCheckIgnored(eps, EPS_FEATURE_BALANCE);
  PetscCheck(eps->isgeneralized, comm_of(eps), PETSC_ERR_SUP,
             "EPS type %s solves K phi = lambda M phi: give M, the unit matrix where there is none",
             kBlockLanczos);
  PetscCheck(eps->nds == 0, comm_of(eps), PETSC_ERR_SUP, "EPS type %s has no deflation space", kBlockLanczos);
  if (!eps->which) eps->which = EPS_SMALLEST_REAL;
  const bool target = eps->which == EPS_TARGET_MAGNITUDE || eps->which == EPS_TARGET_REAL;
  PetscCheck(
      eps->which == EPS_SMALLEST_REAL || eps->which == EPS_ALL || target, comm_of(eps), PETSC_ERR_SUP,
      "EPS type %s finds the lowest eigenvalues (-eps_smallest_real), those above a target below all of "
      "them (-eps_target) or those of an interval (-eps_interval)",
      kBlockLanczos);
  PetscCheck(eps->which != EPS_ALL || eps->inta < eps->intb, comm_of(eps), PETSC_ERR_ARG_WRONG,
             "EPS_ALL needs an interval: -eps_interval a,b");
  return 0;
}

// A number that nobody has set is negative: PETSC_DEFAULT up to SLEPc 3.21, PETSC_DETERMINE since.

void set_dimensions(EPS eps) {
  Method& m = method(eps);
  const bool no_ncv = eps->ncv < 0 || eps->ncv == m.default_ncv,
             no_mpd = eps->mpd < 0 || eps->mpd == m.default_mpd;
  m.most_columns = std::min(no_ncv ? kNoLimit : eps->ncv, no_mpd ? kNoLimit : eps->mpd);
  if (no_ncv) eps->ncv = m.default_ncv = eps->nev;
  if (no_mpd) eps->mpd = m.default_mpd = eps->ncv;
}

// SLEPc's default types, SVEC up to 3.19 and MAT since, refuse 2^31 entries and more.
PetscErrorCode choose_vectors(EPS eps) {
  PetscBool contiguous = PETSC_FALSE;
  if (!eps->V) PetscCall(EPSGetBV(eps, &eps->V));
  PetscCall(PetscObjectTypeCompareAny((PetscObject)eps->V, &contiguous, BVSVEC, BVMAT, ""));
  const bool too_many = static_cast<double>(eps->nev) * eps->n > kNoLimit;
  if (!((PetscObject)eps->V)->type_name || method(eps).handler.mode || (contiguous && too_many))
    PetscCall(BVSetType(eps->V, kSlabsType));
  return 0;
}

PetscErrorCode set_up(EPS eps) {
  PetscCall(check_problem(eps));
  if (eps->tol < 0) eps->tol = kTolerance;
  if (eps->max_it < 0) eps->max_it = kNoLimit;
  set_dimensions(eps);
  PetscCall(set_up_transform(eps));
  PetscCall(choose_vectors(eps));
  return EPSAllocateSolution(eps, std::max<PetscInt>(0, eps->nev - eps->ncv));
}

PetscErrorCode set_up_sort(EPS eps) {
  eps->sc->comparison = SlepcCompareSmallestReal;
  eps->sc->comparisonctx = nullptr;
  eps->sc->map = nullptr;
  eps->sc->mapobj = nullptr;
  return 0;
}

// ---- results

// Room for n eigenpairs.
void reserve(EPS eps, int n) {
  PetscInt m = 0;
  check(BVGetSizes(eps->V, nullptr, nullptr, &m));
  if (n <= m) return;
  const PetscInt larger = std::max<PetscInt>(n, eps->ncv);
  check(PetscFree4(eps->eigr, eps->eigi, eps->errest, eps->perm));
  check(PetscMalloc4(larger, &eps->eigr, larger, &eps->eigi, larger, &eps->errest, larger, &eps->perm));
  check(BVResize(eps->V, larger, PETSC_TRUE));
}

void set_results(EPS eps, const SearchState& state) {
  const int n = static_cast<int>(state.eigenvalue.size());
  reserve(eps, n);
  for (int i = 0; i < n; ++i) {
    eps->eigr[i] = state.eigenvalue(i);
    eps->eigi[i] = 0;
    eps->errest[i] = state.residual(i);
    eps->perm[i] = i;
  }
  eps->nconv = n;
  eps->its = state.iterations;
  eps->reason = n >= eps->nev ? EPS_CONVERGED_TOL : EPS_DIVERGED_ITS;
}

// SLEPc's monitors expect 1 / (lambda - sigma), which they transform back.
void monitor(EPS eps, const Look& look, int n_blocks) {
  if (eps->numbermonitors == 0) return;
  const auto n = static_cast<std::size_t>(look.eigenvalue.size());
  std::vector<PetscScalar> theta(n), zero(n, 0);
  std::vector<PetscReal> error(look.error.begin(), look.error.end());
  for (std::size_t i = 0; i < n; ++i)
    theta[i] = 1 / (look.eigenvalue(static_cast<Eigen::Index>(i)) - look.sigma);
  eps->its = n_blocks;
  check(EPSMonitor(eps, n_blocks, look.n_converged, theta.data(), zero.data(), error.data(),
                   static_cast<PetscInt>(n)));
}

// ---- solution

// Leaves the whole interval to the search, counted by inertia at its ends.
void set_interval(EPS eps, SpectralTransform& transform, Slicing& slicing) {
  int below = static_cast<int>(eps->n);
  if (eps->intb < PETSC_MAX_REAL) {
    slicing.upper = slicing.counted_below = eps->intb;
    below = transform.factorise(slicing.upper);
  }
  if (eps->inta > PETSC_MIN_REAL) {
    slicing.lower = eps->inta;
    slicing.n_below = transform.factorise(slicing.lower);
  }
  slicing.n_modes = below - slicing.n_below;
  slicing.whole_pairs = false;
  eps->nev = slicing.n_modes;
}

void require_lowest(EPS eps, SpectralTransform& transform) {
  const int below = transform.factorise(eps->target);
  require(below == 0, "EPS type ", kBlockLanczos, ": ", below, " eigenvalues lie below -eps_target ",
          eps->target, ", must be none; use -eps_smallest_real, -eps_interval or -eps_type krylovschur");
}

Slicing make_slicing(EPS eps, SpectralTransform& transform) {
  const Method& m = method(eps);
  const BlockLanczosSettings& s = m.settings;
  Slicing slicing;
  slicing.n_modes = static_cast<int>(eps->nev);
  slicing.tolerance = eps->tol;
  slicing.verify_count = s.verify_count;
  slicing.window = {s.window, s.block};
  slicing.most_columns = m.most_columns;
  slicing.first_shift = eps->target;
  slicing.counted_below = s.counted_below;
  slicing.whole_pairs = s.whole_pairs;
  slicing.most_blocks = static_cast<int>(eps->max_it);
  slicing.start = s.start;
  if (eps->which == EPS_ALL) set_interval(eps, transform, slicing);
  if (eps->which == EPS_TARGET_MAGNITUDE || eps->which == EPS_TARGET_REAL) require_lowest(eps, transform);
  return slicing;
}

SliceHooks make_hooks(EPS eps) {
  const BlockLanczosHandler& handler = method(eps).handler;
  SliceHooks hooks{handler.mode, handler.window, {}, handler.progress, handler.lowest};
  if (!hooks.mode)
    hooks.mode = [eps](int i, Vec phi) {
      reserve(eps, i + 1);
      check(BVInsertVec(eps->V, i, phi));
    };
  hooks.look = [eps](const Look& look, int n_blocks) { monitor(eps, look, n_blocks); };
  return hooks;
}

TallBasis& make_basis(EPS eps, int n_columns) {
  Method& m = method(eps);
  UniqueVec layout;
  Mat K = nullptr;
  check(STGetMatrix(eps->st, 0, &K));
  check(MatCreateVecs(K, layout.out(), nullptr));
  check(BVCreate(comm_of(eps), m.basis.out()));
  check(BVSetType(m.basis, kSlabsType));
  check(BVSetSizesFromVec(m.basis, layout, n_columns));
  return slabs(m.basis);
}

void run(EPS eps) {
  Method& m = method(eps);
  Mat K = nullptr, M = nullptr;
  check(STGetMatrix(eps->st, 0, &K));
  check(STGetMatrix(eps->st, 1, &M));
  SpectralTransform transform(eps->st);
  PetscBool own_vectors = PETSC_FALSE;
  check(PetscObjectTypeCompare((PetscObject)eps->V, kSlabsType, &own_vectors));
  if (own_vectors) slabs_set_handed_out(eps->V, static_cast<bool>(m.handler.mode));
  const Slicing slicing = make_slicing(eps, transform);
  reserve(eps, slicing.n_modes);
  m.state = slicing.start;
  if (m.state.eigenvalue.size() < slicing.n_modes)
    m.state = slice_spectrum(K, M, transform, slicing, make_hooks(eps),
                             [eps](int n_columns) -> TallBasis& { return make_basis(eps, n_columns); });
  m.basis = {};
  set_results(eps, m.state);
}

PetscErrorCode solve(EPS eps) {
  Method& m = method(eps);
  m.pending = nullptr;
  std::string message;
  try {
    run(eps);
    return 0;
  } catch (const std::exception& error) {
    m.pending = std::current_exception();
    message = failure_text(error);
  }
  SETERRQ(comm_of(eps), PETSC_ERR_LIB, "%s", message.c_str());
}

// ---- the type

PetscErrorCode set_from_options(EPS eps, PetscOptionItems* PetscOptionsObject) {
  BlockLanczosSettings& s = method(eps).settings;
  PetscInt window = s.window, block = s.block;
  PetscBool count = s.verify_count ? PETSC_TRUE : PETSC_FALSE;
  PetscOptionsHeadBegin(PetscOptionsObject, "Block Lanczos options");
  PetscCall(PetscOptionsInt("-eps_block_lanczos_window", "Eigenpairs found at a time, 0: automatic",
                            "block_lanczos_set", window, &window, nullptr));
  PetscCall(PetscOptionsInt("-eps_block_lanczos_block",
                            "Columns that go through the factor together, 0: automatic", "block_lanczos_set",
                            block, &block, nullptr));
  PetscCall(PetscOptionsBool("-eps_block_lanczos_count", "Count the eigenvalues by inertia",
                             "block_lanczos_set", count, &count, nullptr));
  PetscOptionsHeadEnd();
  PetscCheck(window >= 0 && block >= 0, comm_of(eps), PETSC_ERR_ARG_OUTOFRANGE,
             "-eps_block_lanczos_window %" PetscInt_FMT " and _block %" PetscInt_FMT " must be >= 0", window,
             block);
  s.window = static_cast<int>(window);
  s.block = static_cast<int>(block);
  s.verify_count = count;
  return 0;
}

PetscErrorCode view(EPS eps, PetscViewer viewer) {
  const BlockLanczosSettings& s = method(eps).settings;
  PetscBool ascii = PETSC_FALSE;
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &ascii));
  if (!ascii) return 0;
  return PetscViewerASCIIPrintf(viewer, "  window %d, block %d (0: automatic), %scounted by inertia\n",
                                s.window, s.block, s.verify_count ? "" : "not ");
}

PetscErrorCode reset(EPS eps) {
  Method& m = method(eps);
  m.basis = {};
  m.state = {};
  m.default_ncv = m.default_mpd = 0;
  return 0;
}

PetscErrorCode destroy(EPS eps) {
  delete static_cast<Method*>(eps->data);
  eps->data = nullptr;
  eps->categ = EPS_CATEGORY_KRYLOV;  // as of a new EPS, for a type that is set instead may not set it
  return 0;
}

PetscErrorCode create(EPS eps) {
  eps->data = new Method{};
  eps->categ = EPS_CATEGORY_CONTOUR;  // its eigenvalues need no transformation back, ST solves systems only
  eps->useds = PETSC_FALSE;
  eps->ops->solve = solve;
  eps->ops->setup = set_up;
  eps->ops->setupsort = set_up_sort;
  eps->ops->setfromoptions = set_from_options;
  eps->ops->view = view;
  eps->ops->reset = reset;
  eps->ops->destroy = destroy;
  eps->ops->setdefaultst = set_default_transform;
  return 0;
}

bool is_block_lanczos(EPS eps) { return eps->ops->solve == solve; }

Method& own_method(EPS eps) {
  EPSType type = nullptr;
  check(EPSGetType(eps, &type));
  require(is_block_lanczos(eps), "EPS type ", type ? type : "(none)", ": must be ", kBlockLanczos);
  return method(eps);
}

}  // namespace

void register_block_lanczos() {
  register_ldl();
  register_slabs();
  check(EPSRegister(kBlockLanczos, create));
}

void block_lanczos_set(EPS eps, const BlockLanczosSettings& settings) { own_method(eps).settings = settings; }

void block_lanczos_set_handler(EPS eps, BlockLanczosHandler handler) {
  own_method(eps).handler = std::move(handler);
}

const SearchState& block_lanczos_state(EPS eps) { return own_method(eps).state; }

void block_lanczos_check(EPS eps, PetscErrorCode code) {
  if (code != 0 && is_block_lanczos(eps) && method(eps).pending)
    std::rethrow_exception(std::exchange(method(eps).pending, nullptr));
  check(code);
}

}  // namespace elastogear::reduction
