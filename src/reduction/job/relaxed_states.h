#pragma once
// States of relaxation between which static responses of a viscoelastic body of several materials are
// interpolated (docs/theory, section 2.9).

#include <Eigen/Core>
#include <vector>

#include "elastogear/fem/relaxing_stiffness.h"

namespace elastogear::reduction {

constexpr int kMostRelaxedStates = 8;  ///< n_s

struct RelaxedStates {
  Eigen::MatrixXd share;  ///< n_p x n_s, gamma_p of the parts in each state
  Eigen::MatrixXd law;    ///< n_s x n_p, mu_jp. Eq. (2.22)
  double error = 0;       ///< largest relative error of a response in the family of section 2.9

  int size() const { return static_cast<int>(share.cols()); }
};

/// The states and laws, by empirical interpolation of the family (M. Barrault, Y. Maday, N. C. Nguyen, A. T.
/// Patera, C. R. Acad. Sci. Paris I 339 (2004) 667-672): n of them, or as many as the tolerance takes (n =
/// 0), fewer where nothing is left to interpolate. The first state is that after all relaxation.
RelaxedStates choose_relaxed_states(const std::vector<fem::RelaxingModuli>& parts, int n = 0);

}  // namespace elastogear::reduction
