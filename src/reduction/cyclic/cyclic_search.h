#pragma once
// The state of a search for the modes of a cyclically symmetric body, and the bound up to which they are
// found.

#include <algorithm>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "reduction/cyclic/condensed_sector.h"
#include "reduction/cyclic/cyclic.h"
#include "reduction/eigensolver/nested_factor.h"

namespace elastogear::reduction {

/// The ranks that solve harmonics together; each group takes every n-th harmonic.
struct RankGroup {
  MPI_Comm comm = MPI_COMM_NULL;
  int index = 0, n_groups = 1;
  bool first = false;  // this rank is its group's first

  RankGroup(MPI_Comm all, int n_harmonics) {
    int rank = 0, size = 1;
    MPI_Comm_rank(all, &rank);
    MPI_Comm_size(all, &size);
    n_groups = std::min(size, n_harmonics);
    index = rank % n_groups;
    first = rank == index;
    MPI_Comm_split(all, index, rank, &comm);
  }
  ~RankGroup() { MPI_Comm_free(&comm); }
  RankGroup(const RankGroup&) = delete;
  RankGroup& operator=(const RankGroup&) = delete;
};

/// A mode of the body: column of its harmonic's z, or i times it.
struct ModeEntry {
  double eigenvalue, residual;
  int k, column;
  bool times_i;

  auto key() const { return std::make_tuple(eigenvalue, k, column, times_i); }
};

/// The harmonic whose eigenvalues were counted last: another count takes a factorisation alone.
struct CountedHarmonic {
  int k = -1;
  fem::Matrices matrices = {};  // none where the factor is that of the sector's border
  std::unique_ptr<ShiftedSolver> factor = {};
};

struct CyclicSearch {
  MPI_Comm comm;
  const CyclicBody& body;
  const CyclicOptions& options;
  const Progress& progress;
  int rank = 0;
  fem::NodeOrbits node_orbits = {};  // of the whole mesh, on rank 0
  fem::Sector sector = {};
  std::vector<fem::Harmonic> harmonics = {};
  std::vector<int> order = {};  // of harmonics by work
  std::unique_ptr<RankGroup> group = {};
  std::unique_ptr<CondensedSector> condensed = {};  // of ranks that solve harmonics alone, where it pays
  CountedHarmonic last = {};
  std::map<std::pair<int, double>, int> counts = {};  // eigenvalues of a harmonic below a bound
  std::vector<HarmonicModes> modes = {};              // of each harmonic; z on the first rank of its group
  std::vector<ModeEntry> entries = {};                // wanted modes, ascending
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
  std::unique_ptr<ShiftedSolver> make_factor(const fem::Matrices& matrices) const {
    int n_ranks = 1;
    MPI_Comm_size(group->comm, &n_ranks);
    if (n_ranks == 1) return std::make_unique<NestedFactor>(matrices.K, matrices.M);
    return std::make_unique<ShiftedFactor>(matrices.K, matrices.M);
  }
};

/// Eigenvalues below a bound.
struct Cutoff {
  double sigma;
  std::vector<int> count;  // of each harmonic
};

/// A bound with as many eigenvalues below it as modes are wanted, and a few more, or the upper end of the
/// interval, whose number of modes becomes that of the search. All are counted by inertia, except where the
/// interval has no end. Collective.
Cutoff find_cutoff(CyclicSearch& search);

}  // namespace elastogear::reduction
