#pragma once
// Elastic displacements of the nodes of a surface at the coordinates of successive looks. Those of a time
// step are linear combinations of earlier ones but for one unknown vector, and so are the displacements.

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "elastogear/base/archive.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::contact {

class NodeDisplacements {
 public:
  /// surface: borrowed.
  explicit NodeDisplacements(const model::Surface& surface) : surface_(&surface) {}

  /// Begins with the coordinates q, unless they are those of the last call. docs/theory, Eq. (5.6).
  void start(const Eigen::VectorXd& q);
  /// Phi_i q of a node, m, with q of the last call of start. Same numbers at every call.
  Eigen::Vector3d at(int node);
  /// Has the node been displaced by q?
  bool has(int node) const { return stages_.front().age[static_cast<std::size_t>(node)] >= 0; }
  const Eigen::VectorXd& q() const { return stages_.front().q; }

  /// All that later displacements follow from.
  void serialize(Archive& archive);

 private:
  struct Stage {
    Eigen::VectorXd q;
    Eigen::Matrix3Xd u;      // m, by node
    std::vector<short> age;  // by node: of how many successive combinations it is the end; -1: not displaced
    std::vector<int> nodes;  // that are displaced
  };
  Eigen::VectorXd combination(const Eigen::VectorXd& q) const;
  bool combine(int node);
  void enter(Stage& stage, int node, const Eigen::Vector3d& u, int age);
  Stage empty_stage() const;

  const model::Surface* surface_;
  std::deque<Stage> stages_;  // the latest first
  Eigen::VectorXd weight_;    // of the stages before in the latest; empty: it is none of their combinations
};

}  // namespace elastogear::contact
