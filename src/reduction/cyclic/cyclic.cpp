#include "reduction/cyclic/cyclic.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "reduction/cyclic/condensed_sector.h"
#include "reduction/eigensolver/factorisation.h"
#include "reduction/modes/cutoff.h"

namespace elastogear::reduction {
namespace {

using Eigen::VectorXd;

constexpr int kWindow = 256;           // modes
constexpr double kSurplus = 0.05;      // modes found beyond the wanted ones, at most
constexpr double kMoreSurplus = 0.12;  // of few modes, which take less time than another count
constexpr int kFewSurplus = 50;        // of these at most
constexpr int kLeastSurplus = 8;       // and at least so many may be
constexpr int kPairsInDoubt = 4;       // in a sample
constexpr int kSampleEvery = 5;        // harmonics counted for the first guess of the cutoff
constexpr double kAtCutoff = 1e-6;     // relative: an eigenvalue may lie so close above it
constexpr int kCheckedFields = 4;      // on the whole mesh
constexpr double kResidual = 1e-5;     // of their forces: the mesh repeats to 1e-6 only
constexpr int kTag = 2;

// The ranks that solve harmonics together; each group takes every n-th harmonic.
struct Group {
  MPI_Comm comm = MPI_COMM_NULL;
  int index = 0, n_groups = 1;
  bool first = false;  // this rank is its group's first

  Group(MPI_Comm all, int n_harmonics) {
    int rank = 0, size = 1;
    MPI_Comm_rank(all, &rank);
    MPI_Comm_size(all, &size);
    n_groups = std::min(size, n_harmonics);
    index = rank % n_groups;
    first = rank == index;
    MPI_Comm_split(all, index, rank, &comm);
  }
  ~Group() { MPI_Comm_free(&comm); }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;
};

// A mode of the body: column of its harmonic's z, or i times it.
struct Entry {
  double eigenvalue, residual;
  int k, column;
  bool times_i;

  auto key() const { return std::make_tuple(eigenvalue, k, column, times_i); }
};

// The harmonic whose eigenvalues were counted last: another count takes a factorisation alone.
struct Counted {
  int k = -1;
  fem::Matrices matrices = {};  // none where the factor is that of the sector's border
  std::unique_ptr<ShiftedSolver> factor = {};
};

struct Search {
  MPI_Comm comm;
  const CyclicBody& body;
  const CyclicOptions& options;
  const Progress& progress;
  int rank = 0;
  fem::NodeOrbits node_orbits = {};  // of the whole mesh, on rank 0
  fem::Sector sector = {};
  std::vector<fem::Harmonic> harmonics = {};
  std::vector<int> order = {};  // of harmonics by work
  std::unique_ptr<Group> group = {};
  std::unique_ptr<CondensedSector> condensed = {};  // of ranks that solve harmonics alone, where it pays
  Counted last = {};
  std::map<std::pair<int, double>, int> counts = {};  // eigenvalues of a harmonic below a bound
  std::vector<HarmonicModes> modes = {};              // of each harmonic; z on the first rank of its group
  std::vector<Entry> entries = {};                    // wanted modes, ascending
  int n_wanted = options.eigen.n_modes;

  int n_harmonics() const { return static_cast<int>(harmonics.size()); }
  int n_found() const { return static_cast<int>(entries.size()); }
  int group_of(int k) const {
    const auto at = std::find(order.begin(), order.end(), k) - order.begin();
    return static_cast<int>(at) % group->n_groups;
  }
  bool mine(int k) const { return group_of(k) == group->index && harmonics[k].size() > 0; }
  fem::Matrices assemble(int k) const {
    return fem::assemble(group->comm, sector, harmonics[k], body.body.regions, body.body.formulation);
  }
};

void make_problems(Search& search) {
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
  search.group = std::make_unique<Group>(search.comm, search.n_harmonics());
  search.modes.resize(search.harmonics.size());
  collectively(search.comm, [&] {
    int n_ranks = 1;
    MPI_Comm_size(search.group->comm, &n_ranks);
    if (n_ranks == 1 && condensing_pays(search.sector))
      search.condensed = std::make_unique<CondensedSector>(search.sector, body.regions, body.formulation);
  });
}

// Eigenvalues below sigma of a harmonic of this rank's group.
int count_below(Search& search, int k, double sigma) {
  Counted& last = search.last;
  if (last.k != k) {
    last = {};
    if (search.condensed) {
      last.factor = std::make_unique<HarmonicFactor>(*search.condensed, search.harmonics[k]);
    } else {
      last.matrices = search.assemble(k);
      last.factor = std::make_unique<ShiftedFactor>(last.matrices.K, last.matrices.M);
    }
    last.k = k;
  }
  return last.factor->factorise(sigma);
}

// Eigenvalues below sigma of each of the harmonics `which`. Pairs are never split, even where roundoff may.
std::vector<int> count_below(Search& search, const std::vector<int>& which, double sigma) {
  std::vector<int> count(search.harmonics.size(), 0);
  collectively(search.comm, [&] {
    for (std::size_t i = 0; i < which.size(); ++i) {
      const int k = which[i];
      report(search.progress, "mode count", static_cast<double>(i) / which.size());
      if (!search.mine(k) || search.counts.contains({k, sigma})) continue;
      const int below = count_below(search, k, sigma);
      if (search.group->first) count[k] = search.harmonics[k].real ? below : below + below % 2;
    }
  });
  MPI_Allreduce(MPI_IN_PLACE, count.data(), static_cast<int>(count.size()), MPI_INT, MPI_SUM, search.comm);
  for (int k : which) count[k] = search.counts.try_emplace({k, sigma}, count[k]).first->second;
  return count;
}

double share_of_coordinates(const Search& search, const std::vector<int>& harmonics) {
  double share = 0, all = 0;
  for (int k : harmonics) share += search.harmonics[k].size();
  for (const fem::Harmonic& harmonic : search.harmonics) all += harmonic.size();
  return share / all;
}

// A sigma with about n eigenvalues below it, by counting those of every few harmonics.
double estimate_cutoff(Search& search, int n) {
  const double weyl = weyl_cutoff(search.sector, search.body.body.regions, n);
  std::vector<int> sample;
  for (int k = kSampleEvery / 2; k < search.n_harmonics(); k += kSampleEvery) sample.push_back(k);
  const double share = share_of_coordinates(search, sample);
  if (share == 0) return weyl;
  const auto estimate = [&](double sigma) {
    const std::vector<int> count = count_below(search, sample, sigma);
    return static_cast<int>(std::accumulate(count.begin(), count.end(), 0) / share);
  };
  const int doubt = static_cast<int>(std::max(kPairsInDoubt / share, kSurplus * n));
  return find_cutoff(estimate, {std::max(1, n - doubt), n + doubt}, weyl);
}

struct Cutoff {
  double sigma;
  std::vector<int> count;  // of each harmonic
};

int sum(const std::vector<int>& counts) { return std::accumulate(counts.begin(), counts.end(), 0); }

// All harmonics of the interval, whose number of modes becomes that of the search.
Cutoff cutoff_of_interval(Search& search) {
  const auto& [lower, upper] = *search.options.eigen.interval;
  std::vector<int> all(search.harmonics.size());
  std::iota(all.begin(), all.end(), 0);
  Cutoff cutoff{upper, {}};
  if (std::isfinite(upper)) {
    cutoff.count = count_below(search, all, upper);
  } else {
    for (const fem::Harmonic& harmonic : search.harmonics) cutoff.count.push_back(harmonic.size());
  }
  if (lower > 0) {  // the body is held: none lies below zero
    const std::vector<int> below = count_below(search, all, lower);
    for (std::size_t k = 0; k < all.size(); ++k) cutoff.count[k] -= below[k];
  }
  search.n_wanted = sum(cutoff.count);
  require(search.n_wanted > 0, "no eigenvalue lies between ", lower, " and ", upper,
          " rad^2/s^2 (-eps_interval, or modes: auto); take one mode (-modes 1)");
  return cutoff;
}

Cutoff choose_cutoff(Search& search) {
  const int n = search.n_wanted;
  const int surplus = std::max({kLeastSurplus, static_cast<int>(kSurplus * n),
                                std::min(kFewSurplus, static_cast<int>(kMoreSurplus * n))});
  std::vector<int> all(search.harmonics.size());
  std::iota(all.begin(), all.end(), 0);
  Cutoff cutoff{0, {}};
  const auto count = [&](double sigma) {
    cutoff.count = count_below(search, all, sigma);
    return sum(cutoff.count);
  };
  cutoff.sigma = find_cutoff(count, {n, n + surplus}, estimate_cutoff(search, n + surplus / 2));
  return cutoff;
}

// Returns the harmonic when the hook `known` has it, on all ranks of the group; z only on the first of them.
std::optional<HarmonicModes> recall(const Search& search, int k, double sigma) {
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

void keep(const Search& search, int k) {
  if (!search.options.done) return;
  collectively(search.group->comm, [&] {
    if (search.group->first) search.options.done(search.modes[k]);
  });
}

HarmonicModes solve(Search& search, int k, const Cutoff& cutoff, const Progress& progress) {
  EigenOptions options = search.options.eigen;
  options.n_modes = cutoff.count[k];
  options.counted_below = cutoff.sigma;
  options.window = std::min(options.window > 0 ? options.window : kWindow, options.n_modes + options.block);
  options.whole_pairs = false;  // the cutoff cuts none
  if (options.interval && options.interval->lower <= 0) options.interval.reset();
  const bool known_matrices = search.last.k == k && search.last.matrices.K;
  const fem::Matrices matrices = known_matrices ? std::move(search.last.matrices) : search.assemble(k);
  search.last = {};
  std::optional<HarmonicFactor> factor;
  if (search.condensed) options.factor = &factor.emplace(*search.condensed, search.harmonics[k]);
  const int first_orbit = fem::own_orbits(search.group->comm, search.sector).first;
  HarmonicModes modes = find_harmonic_modes(matrices, search.harmonics[k], first_orbit, options, progress);
  modes.cutoff = cutoff.sigma;
  const double last = modes.eigenvalue.tail<1>()(0);
  require(last <= cutoff.sigma * (1 + kAtCutoff), "the eigensolver missed a mode of harmonic ", k, ": its ",
          modes.eigenvalue.size(), " lowest should lie below ", std::sqrt(cutoff.sigma) / (2 * M_PI),
          " Hz, the last is at ", std::sqrt(last) / (2 * M_PI), " Hz; use larger blocks of vectors");
  return modes;
}

void solve_all(Search& search, const Cutoff& cutoff) {
  const std::vector<int>& order = search.order;
  collectively(search.comm, [&] {
    if (search.last.k >= 0 && cutoff.count[search.last.k] == 0) search.last = {};
    for (std::size_t i = 0; i < order.size(); ++i) {
      const int k = order[i];
      if (!search.mine(k) || cutoff.count[k] == 0) continue;
      const auto progress = [&](std::string_view stage, double fraction) {
        report(search.progress, stage, (i + fraction) / order.size());
      };
      auto known = recall(search, k, cutoff.sigma);
      search.modes[k] = known ? std::move(*known) : solve(search, k, cutoff, progress);
      if (!known) keep(search, k);
    }
  });
}

// Eigenvalues and residuals of every harmonic on all ranks; those of the body in order.
void merge(Search& search, const Cutoff& cutoff) {
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
            [](const Entry& a, const Entry& b) { return a.key() < b.key(); });
  auto n = static_cast<std::size_t>(search.n_wanted);
  const bool cut = n < search.entries.size() && search.entries[n].times_i;
  search.entries.resize(n + (cut && search.options.eigen.whole_pairs));
}

// The whole body's displacements on rank 0.
VectorXd field(const Search& search, const Entry& entry) {
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

void check_fields(const Search& search) {
  std::set<int> chosen;
  for (int i = 0; i < kCheckedFields; ++i) chosen.insert(i * (search.n_found() - 1) / (kCheckedFields - 1));
  const auto n = static_cast<Eigen::Index>(chosen.size());
  Eigen::MatrixXd fields(search.rank == 0 ? 3 * search.body.body.mesh.n_nodes() : 0, n);
  VectorXd eigenvalue(n);
  Eigen::Index column = 0;
  for (int i : chosen) {
    eigenvalue(column) = search.entries[i].eigenvalue;
    fields.col(column++) = field(search, search.entries[i]);
  }
  collectively(search.comm, [&] {
    if (search.rank != 0) return;
    const double worst = fem::residual(search.body.body, fields, eigenvalue).maxCoeff();
    require(worst <= kResidual, "the modes of one sector leave ", worst,
            " of their forces unbalanced in the whole mesh, allowed are ", kResidual,
            ": the mesh does not repeat well enough");
  });
}

Eigenmodes deliver(const Search& search, const FieldSink& sink) {
  const int n = search.n_found();
  Eigenmodes result;
  result.eigenvalue.resize(n);
  result.residual.resize(n);
  if (search.options.begin) search.options.begin(n);
  for (int i = 0; i < n; ++i) {
    const Entry& entry = search.entries[i];
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
  Search search{comm, body, options, progress};
  make_problems(search);
  const Cutoff cutoff = options.eigen.interval ? cutoff_of_interval(search) : choose_cutoff(search);
  solve_all(search, cutoff);
  merge(search, cutoff);
  report(progress, "eigenmodes", 1);
  check_fields(search);
  return deliver(search, sink);
}

}  // namespace elastogear::reduction
