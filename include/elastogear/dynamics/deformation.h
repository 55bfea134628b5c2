#pragma once
// How much a body is deformed: rotation and strain, which the theory takes to be small (docs/theory,
// section 8.5).

#include <functional>
#include <memory>

#include "elastogear/contact/deformation_bound.h"

namespace elastogear::dynamics {

/// Watches the change of some vectors over their length: edges of faces all over the surface, the body as a
/// whole along three directions (its affine part) and, as small rotations, its markers.
class DeformationWatch {
 public:
  explicit DeformationWatch(const model::ElasticBody& body);
  /// The largest change, -; by the elastic energy where that tells it to be below `limit`, which may then
  /// be too large.
  double largest(const Eigen::VectorXd& q, double limit) const;

 private:
  void read_edges() const;

  mutable std::unique_ptr<const model::BasisRows> rows_;  // 3 n x n_q
  mutable std::function<model::DenseRows()> edges_;       // the rows of the edges, while they are not read
  mutable contact::DeformationBound bound_;               // of all rows
};

}  // namespace elastogear::dynamics
