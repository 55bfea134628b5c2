#pragma once
// Error of stresses that are recovered on free surfaces, from what both recoveries of the same displacements
// give at the nodes around (docs/theory, section 1.7).

#include <Eigen/Core>

namespace elastogear::recovery {

/// Pa, at one node.
struct PatchError {
  double error = 0;    ///< of the von Mises stress
  double of_mean = 0;  ///< of that of the means: the root mean square difference over the patch
  double largest = 0;  ///< von Mises stress in the patch
};

/// Eq. (1.17). difference, stress: von Mises stresses, Pa, of the difference of both recoveries (1.16) and of
/// the recovered stress at the nodes of the patch that are on free surfaces; order: degree of the
/// displacements in the cells at the node.
PatchError patch_error(const Eigen::Ref<const Eigen::VectorXd>& difference,
                       const Eigen::Ref<const Eigen::VectorXd>& stress, int order);

/// Pa, first factor of Eq. (1.18a): of a mean at a loaded node, by what its patch tells of the strains within
/// the surface. difference, stress: von Mises stresses, Pa, of (1.16a) and of the means at the loaded nodes
/// of the patch.
double error_within_surface(const Eigen::Ref<const Eigen::VectorXd>& difference,
                            const Eigen::Ref<const Eigen::VectorXd>& stress, int order);

/// Pa, Eq. (1.18a), of the mean at a loaded node with the von Mises stress `stress`, Pa. within: Pa, by the
/// strains within the surface there; share: of errors in the means near by.
double loaded_error(double within, double stress, double share);

}  // namespace elastogear::recovery
