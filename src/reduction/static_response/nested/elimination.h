#pragma once
// Elimination of a sparse matrix by nested dissection, with what is wanted of its inverse (docs/theory, Eq.
// (6.20a)).

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <vector>

#include "elastogear/base/petsc.h"
#include "elastogear/model/elastic_body.h"
#include "reduction/static_response/nested/contribution.h"

namespace elastogear::reduction {

/// What rows of K that are kept are left with, when all others are eliminated. Eq. (6.20a).
struct KeptRows {
  Eigen::MatrixXd S;  ///< Schur complement, in their order
  Eigen::MatrixXd E;  ///< P by their displacements
};

struct EliminationTask {
  Mat K;                          ///< sequential, symmetric, positive definite
  const model::SparseRows& P;     ///< what is wanted of the displacements, a row each
  const std::vector<int>& loads;  ///< rows of P
  int largest_leaf;               ///< rows of K
  std::vector<int> kept = {};     ///< rows of K that stay, ascending
};

/// The terms of P K_ii^-1 P', i the rows of K that are not kept; left: of the kept ones, or null. T:
/// precision of the terms. progress: takes the share that is done of the time that elimination and the
/// products of the terms are expected to take; may be empty. Throws Error when K_ii is not positive definite.
template <class T>
Contributions<T> eliminate(const EliminationTask& task, KeptRows* left,
                           const std::function<void(double)>& progress);

}  // namespace elastogear::reduction
