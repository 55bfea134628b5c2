#pragma once
// Static responses of a free body: loads are balanced by inertia, and responses are orthogonal to rigid
// motions (docs/theory, section 2.4).

#include <Eigen/Core>

#include "elastogear/base/petsc.h"
#include "elastogear/reduction/free_body.h"

namespace elastogear::reduction {

/// Own rows of rigid motions R, orthonormal in the inner product of M, and of their inertia forces M R. Of a
/// held body both are empty.
struct RigidFields {
  Eigen::MatrixXd R, M_R;
};

/// P = I - M R R', R the rigid motions, orthonormal in the inner product of M. Rows are those of K and M that
/// this rank owns. Eq. (2.9).
class InertiaRelief {
 public:
  /// R: own rows of independent fields that K moves without force; of any scale. Collective. Throws Error
  /// when they are not independent.
  InertiaRelief(Mat M, Eigen::MatrixXd R);
  InertiaRelief(Mat M, const RigidModes& rigid);

  /// F := P F, forces that leave rigid motions at rest. Collective.
  void balance(Eigen::Ref<Eigen::MatrixXd> F) const;
  /// U := P' U, displacements without rigid motion. Collective.
  void release(Eigen::Ref<Eigen::MatrixXd> U) const;

  /// K with a spring on as many displacements as there are rigid motions: definite. Springs that hold a body
  /// just so stay without force when loads are balanced, and K u = f then is solved exactly, up to a rigid
  /// motion. Collective.
  UniqueMat ground(Mat K) const;

  RigidFields fields() const { return {R_, M_R_}; }

 private:
  MPI_Comm comm_;
  Eigen::MatrixXd R_, M_R_;
};

}  // namespace elastogear::reduction
