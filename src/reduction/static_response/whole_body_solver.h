#pragma once
// K^-1 of a whole body on this process alone.

#include <Eigen/Core>
#include <functional>
#include <memory>

#include "elastogear/io/body_file.h"
#include "elastogear/mesh/repetition.h"

namespace elastogear::reduction {

/// Displacements, m, of forces at all nodes, N, 3 n_nodes x n each, node-major. Forces on restrained nodes do
/// nothing.
using Solve = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& f)>;

/// Parts whose displacements add up to K^-1 f.
class WholeBodySolver {
 public:
  virtual ~WholeBodySolver() = default;
  virtual void visit_parts(const std::function<void(const Solve& part)>& visit) = 0;
};

/// By one factor of K, which it keeps. The source outlives the solver. floating: nothing holds the body,
/// whose loads are balanced by the inertia of its cells, and whose displacements are orthogonal to rigid
/// motions. Throws Error when a body is neither held nor floating, or the factorisation fails.
std::unique_ptr<WholeBodySolver> factorise_whole(const io::BodySource& source, bool floating);

/// Of a held cyclically symmetric body, a part for each harmonic: Eq. (4.3a). Factors live as long as their
/// part is visited, one at a time, and take the less memory the more sectors there are. The source outlives
/// the solver. Visiting throws Error when a factorisation fails.
std::unique_ptr<WholeBodySolver> factorise_harmonics(const io::BodySource& source,
                                                     const mesh::Repetition& repetition);

}  // namespace elastogear::reduction
