#pragma once
// How far recovered stresses are from those of the unreduced body on the same mesh (docs/theory, section
// 4.3). Everything is taken at one time, so that the output interval does not matter.

#include <Eigen/Core>
#include <vector>

#include "elastogear/model/elastic_body.h"
#include "elastogear/recovery/finite_elements.h"

namespace elastogear::recovery {

/// Elastic coordinates of a body over n_t times, split by its contact forces f; q = q_d + q_s.
struct SplitCoordinates {
  Eigen::MatrixXd q_d;  ///< n_q x n_t, dynamic part
  Eigen::MatrixXd q_s;  ///< n_q x n_t, static response K_r^-1 Phi' f of the modes
};

/// Stresses at n nodes over n_t times.
struct RecoveredStress {
  Eigen::MatrixXd stress;    ///< 6 n x n_t, Pa, as recovered
  Eigen::MatrixXd residual;  ///< 6 n x n_t, Pa, static response to f beside that of the modes; empty: unknown
  bool has_residual = true;  ///< whether `stress` contains it
  /// 6 n x n_t, Pa, what of the residual has come by creep as in states of relaxation; empty: nothing.
  Eigen::MatrixXd crept = {};
};

/// Eq. (4.8), n_t: dynamic over static amplitude of the upper half of the modes, in the norm of the
/// energy and at most 1; 0 of bodies without modes, which have no states but equilibria. body: its K_r is
/// diagonal.
Eigen::VectorXd dynamic_share(const model::ElasticBody& body, const SplitCoordinates& coordinates);

/// q_d with zeros in place of all but the upper half of the first n_modes coordinates.
Eigen::MatrixXd upper_half(const Eigen::MatrixXd& q_d, Eigen::Index n_modes);

/// von Mises stresses at one time, n each, Pa: as recovered, with the whole static response, of that response
/// beside the modes' own, and of the upper half of the modes in their dynamic part.
struct FieldStress {
  Eigen::VectorXd found, whole, residual, upper;
};
/// Eq. (4.9), n, Pa. share: dynamic_share at this time.
Eigen::VectorXd field_error(const FieldStress& stress, double share);

/// The largest von Mises stresses over nodes, n_t each, Pa.
struct Peaks {
  Eigen::VectorXd found, exact;  ///< as recovered, and with the residual
  Eigen::VectorXd error;         ///< at the node of the largest exact one, but for the difference of the two

  /// Estimated error of the largest value.
  Eigen::VectorXd whole_error() const { return (exact - found).cwiseAbs() + error; }
};
/// Those of no node.
Peaks no_peaks(Eigen::Index n_t);
/// Those over the nodes of both.
void join(Peaks& peaks, const Peaks& others);

/// Estimated errors of the von Mises stress.
struct StressError {
  Eigen::MatrixXd at_node;  ///< n x n_t, Pa
  Peaks peaks;              ///< over the nodes
};

/// n x n_modes / 2, Pa^2: squares of the von Mises stresses of the upper half of the modes. members: n local
/// numbers in the body's stress.node.
Eigen::MatrixXd upper_modes_stress(const model::ElasticBody& body, const std::vector<int>& members);

/// Eqs. (4.6) to (4.9), and Eq. (4.12b) of viscoelastic bodies. upper: upper_modes_stress at the n nodes. The
/// body's basis is modal.
StressError reduction_error(const model::ElasticBody& body, const Eigen::Ref<const Eigen::MatrixXd>& upper,
                            const SplitCoordinates& coordinates, const RecoveredStress& recovered);

/// Errors of means at loaded nodes by the strains within the surface.
struct LoadedNodes {
  std::vector<int> node;   ///< n, mesh numbers
  Eigen::VectorXd within;  ///< n, Pa, first factor of Eq. (1.18a)
};

/// Estimated error of a whole field by the mesh at one time, Pa, at all nodes. difference: von Mises stress
/// of Eq. (1.16), 0 where no free surface is, inside the body and on flanks. patches: of the nodes with a
/// difference, ascending, for Eq. (1.17); of means none. What is near by (1.18a) are all of these nodes.
Eigen::VectorXd mesh_error_field(const Eigen::VectorXd& difference, const Eigen::VectorXd& von_mises,
                                 SurfacePatches patches, const LoadedNodes& loaded = {});

}  // namespace elastogear::recovery
