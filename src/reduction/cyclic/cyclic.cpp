#include "reduction/cyclic/cyclic.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "reduction/cyclic/cyclic_search.h"
#include "reduction/cyclic/harmonic_krylov.h"

namespace elastogear::reduction {
namespace {

using Eigen::VectorXd;

constexpr int kWindow = 256;          // modes
constexpr double kAtCutoff = 1e-6;    // relative: an eigenvalue may lie so close above it
constexpr int kCheckedFields = 4;     // on the whole mesh
constexpr double kResidual = 1e-5;    // of their forces, above that in the sector: the mesh repeats to 1e-6
constexpr std::size_t kTogether = 4;  // harmonics whose blocks go through the factor together
constexpr int kTag = 2;

void make_problems(CyclicSearch& search) {
  const fem::MeshedBody& body = search.body.body;
  MPI_Comm_rank(search.comm, &search.rank);
  collectively(search.comm, [&] {
    if (search.rank != 0) return;
    search.node_orbits = fem::free_node_orbits(search.body.repetition, body.is_free);
    search.sector = fem::make_sector(body.mesh, search.body.repetition, body.region, search.node_orbits);
  });
  fem::broadcast(search.comm, search.sector);
  int n_free = 0;
  for (int k = 0; 2 * k <= search.sector.turn.n_sectors; ++k) {
    search.harmonics.push_back(fem::make_harmonic(search.sector, k));
    search.order.push_back(k);
    n_free += search.harmonics.back().size();
  }
  if (!search.options.eigen.interval) require_mode_count(search.n_wanted, n_free);
  std::stable_sort(search.order.begin(), search.order.end(),
                   [&](int a, int b) { return search.harmonics[a].size() > search.harmonics[b].size(); });
  search.group = std::make_unique<RankGroup>(search.comm, search.n_harmonics());
  search.modes.resize(search.harmonics.size());
  collectively(search.comm, [&] {
    int n_ranks = 1;
    MPI_Comm_size(search.group->comm, &n_ranks);
    if (n_ranks == 1 && condensing_pays(search.sector))
      search.condensed = std::make_unique<CondensedSector>(search.sector, body.regions, body.formulation);
  });
}

// Returns the harmonic when the hook `known` has it, on all ranks of the group; z only on the first of them.
std::optional<HarmonicModes> recall(const CyclicSearch& search, int k, double sigma) {
  std::optional<HarmonicModes> known;
  if (!search.options.known) return known;
  collectively(search.group->comm, [&] {
    if (search.group->first) known = search.options.known(k, sigma);
  });
  int is_known = known.has_value();
  MPI_Bcast(&is_known, 1, MPI_INT, 0, search.group->comm);
  if (is_known && !known) known.emplace();
  return known;
}

void keep(const CyclicSearch& search, int k) {
  if (!search.options.done) return;
  collectively(search.group->comm, [&] {
    if (search.group->first) search.options.done(search.modes[k]);
  });
}

HarmonicModes solve(CyclicSearch& search, int k, const Cutoff& cutoff, const Progress& progress) {
  EigenOptions options = search.options.eigen;
  options.n_modes = cutoff.count[k];
  options.counted_below = cutoff.sigma;
  options.window = std::min(options.window > 0 ? options.window : kWindow, options.n_modes + options.block);
  options.whole_pairs = false;  // the cutoff cuts none
  if (options.interval && options.interval->lower <= 0) options.interval.reset();
  CountedHarmonic known = search.last.k == k ? std::exchange(search.last, {}) : CountedHarmonic{};
  search.last = {};
  const fem::Matrices matrices = known.matrices.K ? std::move(known.matrices) : search.assemble(k);
  std::unique_ptr<ShiftedSolver> factor = std::move(known.factor);
  if (search.condensed)
    factor = std::make_unique<HarmonicFactor>(*search.condensed, search.harmonics[k]);
  else if (!factor)
    factor = search.make_factor(matrices);
  options.factor = factor.get();
  const int first_orbit = fem::own_orbits(search.group->comm, search.sector).first;
  HarmonicModes modes = find_harmonic_modes(matrices, search.harmonics[k], first_orbit, options, progress);
  modes.cutoff = cutoff.sigma;
  const double last = modes.eigenvalue.tail<1>()(0);
  require(last <= cutoff.sigma * (1 + kAtCutoff), "the eigensolver missed a mode of harmonic ", k, ": its ",
          modes.eigenvalue.size(), " lowest should lie below ", std::sqrt(cutoff.sigma) / (2 * M_PI),
          " Hz, the last is at ", std::sqrt(last) / (2 * M_PI),
          " Hz; use larger blocks of vectors (-eps_block_lanczos_block) or the whole body (-symmetry none)");
  return modes;
}

// Returns whether one shift is enough for the modes of harmonic k, at most as many as a window holds, and the
// user has given no option of SLEPc.
bool suits_one_shift(const CyclicSearch& search, int k, const Cutoff& cutoff) {
  const EigenOptions& options = search.options.eigen;
  const bool from_zero = !options.interval || options.interval->lower <= 0;
  return search.condensed && !asks_slepc(options.prefix) && options.window != 0 && from_zero &&
         cutoff.count[k] <= kWindow;
}

// Enters the modes of those of the harmonics that are found at one shift.
void solve_together(CyclicSearch& search, const std::vector<int>& which, const Cutoff& cutoff,
                    const Progress& progress) {
  std::vector<HarmonicTask> tasks;
  for (int k : which)
    if (suits_one_shift(search, k, cutoff)) {
      const fem::Harmonic& harmonic = search.harmonics[k];
      tasks.push_back({&harmonic, harmonic.real ? cutoff.count[k] : cutoff.count[k] / 2});
    }
  if (tasks.empty()) return;
  search.last = {};
  const EigenOptions& options = search.options.eigen;
  for (auto& found : find_modes_together(*search.condensed, tasks,
                                         {cutoff.sigma, options.tolerance, options.block}, progress))
    if (found) search.modes[found->k] = std::move(*found);
}

// Harmonics that this rank's group is to solve.
std::vector<int> unknown_harmonics(CyclicSearch& search, const Cutoff& cutoff) {
  std::vector<int> unknown;
  for (int k : search.order) {
    if (!search.mine(k) || cutoff.count[k] == 0) continue;
    if (auto known = recall(search, k, cutoff.sigma))
      search.modes[k] = std::move(*known);
    else
      unknown.push_back(k);
  }
  return unknown;
}

void solve_all(CyclicSearch& search, const Cutoff& cutoff) {
  collectively(search.comm, [&] {
    if (search.last.k >= 0 && cutoff.count[search.last.k] == 0) search.last = {};
    const std::vector<int> unknown = unknown_harmonics(search, cutoff);
    const std::size_t step = search.condensed ? kTogether : 1;
    for (std::size_t i = 0; i < unknown.size(); i += step) {
      const std::vector<int> which(unknown.begin() + i, unknown.begin() + std::min(i + step, unknown.size()));
      const auto progress = [&](std::string_view stage, double fraction) {
        report(search.progress, stage, (i + fraction * which.size()) / unknown.size());
      };
      solve_together(search, which, cutoff, progress);
      for (int k : which) {
        if (search.modes[k].eigenvalue.size() == 0) search.modes[k] = solve(search, k, cutoff, progress);
        keep(search, k);
      }
    }
  });
}

// Eigenvalues and residuals of every harmonic on all ranks; those of the body in order.
void merge(CyclicSearch& search, const Cutoff& cutoff) {
  for (int k = 0; k < search.n_harmonics(); ++k) {
    const bool real = search.harmonics[k].real;
    const int n = real ? cutoff.count[k] : cutoff.count[k] / 2, from = search.group_of(k);
    HarmonicModes& modes = search.modes[k];
    modes.eigenvalue.conservativeResize(n);
    modes.residual.conservativeResize(n);
    MPI_Bcast(modes.eigenvalue.data(), n, MPI_DOUBLE, from, search.comm);
    MPI_Bcast(modes.residual.data(), n, MPI_DOUBLE, from, search.comm);
    for (int i = 0; i < n; ++i)
      for (bool times_i : {false, true})
        if (!times_i || !real)
          search.entries.push_back({modes.eigenvalue(i), modes.residual(i), k, i, times_i});
  }
  std::sort(search.entries.begin(), search.entries.end(),
            [](const ModeEntry& a, const ModeEntry& b) { return a.key() < b.key(); });
  auto n = static_cast<std::size_t>(search.n_wanted);
  const bool cut = n < search.entries.size() && search.entries[n].times_i;
  search.entries.resize(n + (cut && search.options.eigen.whole_pairs));
}

// The whole body's displacements on rank 0.
VectorXd field(const CyclicSearch& search, const ModeEntry& entry) {
  const int from = search.group_of(entry.k);  // the rank, too
  const fem::Harmonic& harmonic = search.harmonics[entry.k];
  VectorXd z;
  if (search.rank == from) z = search.modes[entry.k].z.col(entry.column);
  if (from != 0 && search.rank == from) MPI_Send(z.data(), harmonic.size(), MPI_DOUBLE, 0, kTag, search.comm);
  if (search.rank != 0) return {};
  z.resize(harmonic.size());
  if (from != 0) MPI_Recv(z.data(), harmonic.size(), MPI_DOUBLE, from, kTag, search.comm, MPI_STATUS_IGNORE);
  if (entry.times_i) z = fem::times_i(harmonic, 0, z).eval();
  return fem::unfold(harmonic, search.node_orbits, z);
}

void check_fields(const CyclicSearch& search) {
  std::set<int> chosen;
  for (int i = 0; i < kCheckedFields; ++i) chosen.insert(i * (search.n_found() - 1) / (kCheckedFields - 1));
  const auto n = static_cast<Eigen::Index>(chosen.size());
  Eigen::MatrixXd fields(search.rank == 0 ? 3 * search.body.body.mesh.n_nodes() : 0, n);
  VectorXd eigenvalue(n);
  double allowed = kResidual;
  Eigen::Index column = 0;
  for (int i : chosen) {
    allowed = std::max(allowed, kResidual + search.entries[i].residual);
    eigenvalue(column) = search.entries[i].eigenvalue;
    fields.col(column++) = field(search, search.entries[i]);
  }
  collectively(search.comm, [&] {
    if (search.rank != 0) return;
    const double worst = fem::residual(search.body.body, fields, eigenvalue).maxCoeff();
    require(worst <= allowed, "the modes of one sector leave ", worst,
            " of their forces unbalanced in the whole mesh, allowed are ", allowed,
            ": the mesh does not repeat well enough; reduce the whole body (-symmetry none)");
  });
}

Eigenmodes deliver(const CyclicSearch& search, const FieldSink& sink) {
  const int n = search.n_found();
  Eigenmodes result;
  result.eigenvalue.resize(n);
  result.residual.resize(n);
  if (search.options.begin) search.options.begin(n);
  for (int i = 0; i < n; ++i) {
    const ModeEntry& entry = search.entries[i];
    result.eigenvalue(i) = entry.eigenvalue;
    result.residual(i) = entry.residual;
    sink(i, field(search, entry));
  }
  for (const HarmonicModes& modes : search.modes) {
    result.iterations += search.group->first ? modes.iterations : 0;
    result.orthogonality = std::max(result.orthogonality, modes.orthogonality);
  }
  MPI_Allreduce(MPI_IN_PLACE, &result.iterations, 1, MPI_INT, MPI_SUM, search.comm);
  MPI_Allreduce(MPI_IN_PLACE, &result.orthogonality, 1, MPI_DOUBLE, MPI_MAX, search.comm);
  return result;
}

}  // namespace

Eigenmodes find_cyclic_eigenmodes(MPI_Comm comm, const CyclicBody& body, const CyclicOptions& options,
                                  const FieldSink& sink, const Progress& progress) {
  CyclicSearch search{comm, body, options, progress};
  make_problems(search);
  const Cutoff cutoff = find_cutoff(search);
  solve_all(search, cutoff);
  merge(search, cutoff);
  report(progress, "eigenmodes", 1);
  check_fields(search);
  return deliver(search, sink);
}

}  // namespace elastogear::reduction
