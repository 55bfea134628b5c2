#pragma once
// A modal body file beside the same body in the full basis, for tests.

#include <Eigen/Core>
#include <string>

#include "elastogear/io/body_file.h"

namespace elastogear::test {

/// Modes of one file in the coordinates of the full basis in the other.
inline Eigen::MatrixXd modes_in_full_basis(const std::string& modal, const std::string& full) {
  const auto dof = io::read_body_source(full).free_dof;
  const Eigen::Index n_q = io::read_body(modal).n_q();
  Eigen::MatrixXd Phi(dof.size(), n_q);
  for (Eigen::Index k = 0; k < n_q; ++k) {
    const Eigen::VectorXd phi = io::read_displacement_field(modal, Eigen::VectorXd::Unit(n_q, k)).reshaped();
    Phi.col(k) = phi(dof);
  }
  return Phi;
}

}  // namespace elastogear::test
