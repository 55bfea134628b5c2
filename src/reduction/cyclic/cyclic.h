#pragma once
// Exact eigenmodes of a cyclically symmetric body, from one sector (D. L. Thomas, "Dynamics of
// rotationally periodic structures", Int. J. Numer. Meth. Eng. 14 (1979) 81-102; docs/theory, section
// 2.6).

#include <functional>
#include <optional>

#include "elastogear/fem/balance.h"
#include "reduction/cyclic/harmonic_modes.h"

namespace elastogear::reduction {

/// Receives the modes one at a time, in ascending order: all displacements (3 n_nodes, node-major, 0 where
/// restrained), mass-normalised, on rank 0, and an empty vector elsewhere. Called on all ranks.
using FieldSink = std::function<void(int index, const Eigen::VectorXd& phi)>;

struct CyclicBody {
  fem::MeshedBody body;  ///< regions and formulation on all ranks, the rest on rank 0
  const mesh::Repetition& repetition;
};

struct CyclicOptions {
  EigenOptions eigen = {};  ///< window = 0: windows of 256 modes
  /// Finished harmonics can be kept and then are not solved again: called for each on one rank. The cutoff is
  /// the same in every run with the same body and number of modes.
  std::function<std::optional<HarmonicModes>(int k, double cutoff)> known = {};
  std::function<void(const HarmonicModes&)> done = {};
  std::function<void(int n_modes)> begin = {};  ///< before the first mode is delivered, on all ranks
};

/// The lowest options.eigen.n_modes modes of the body, and with options.eigen.whole_pairs the last one's
/// partner. For each harmonic the eigenvalues below a common
/// cutoff are counted by inertia; then the harmonics, spread over the ranks, are solved for exactly so many.
/// Modes with equal eigenvalues come with ascending k, and in a pair the amplitude z before i z. Memory: on
/// each rank the matrices and the factor of one harmonic, and its share of the sector's vectors. A few fields
/// are checked against the whole mesh before any is delivered. Reports the stages "mode count" and
/// "eigenmodes". Collective. Throws the same Error on all ranks for what find_eigenmodes throws, and when a
/// harmonic lacks a mode or a field does not fit the mesh.
Eigenmodes find_cyclic_eigenmodes(MPI_Comm comm, const CyclicBody& body, const CyclicOptions& options,
                                  const FieldSink& sink, const Progress& progress = {});

}  // namespace elastogear::reduction
