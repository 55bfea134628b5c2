#pragma once
// Inverse and signs of eigenvalues of dense symmetric matrices by LAPACK.

#include <Eigen/Core>

namespace elastogear::reduction {

struct Inverted {
  int n_negative = 0;    ///< eigenvalues
  double condition = 1;  ///< reciprocal condition number, estimated; 0: singular, there is no inverse
};

/// A becomes its inverse. The lower triangle is read, all of it is set.
Inverted invert_symmetric(Eigen::MatrixXd& A);

}  // namespace elastogear::reduction
