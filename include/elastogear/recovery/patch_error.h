#pragma once
// Error of stresses that are recovered on free surfaces, from what both recoveries of the same displacements
// give at the nodes around (docs/theory.md, section 1.7).

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

}  // namespace elastogear::recovery
