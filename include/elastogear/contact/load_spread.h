#pragma once
// The force on a node of a contact surface, spread over the sides of cells around it (docs/theory, section
// 4.6).

#include <Eigen/Core>
#include <unordered_map>
#include <vector>

#include "elastogear/model/elastic_body.h"

namespace elastogear::contact {

/// How the force on a node is spread over n nodes around it. Eq. (4.13).
struct Spread {
  std::vector<int> node;   ///< n, local numbers of surface nodes
  Eigen::VectorXd weight;  ///< n, sums to 1, with its centre at the node
};

/// n, Eq. (4.13): weights of least square sum of places that lie away from a force by 3 x n m. They sum to 1,
/// with their centre at the force in the plane that the places lie in.
Eigen::VectorXd spread_weights(const Eigen::Matrix3Xd& away);

/// sides: of the surface, lists of local nodes; those at `node` count. Nodes for which `may_bear` is 0 are
/// left out.
Spread spread(const Eigen::Matrix3Xd& X, const std::vector<std::vector<int>>& sides, int node,
              const std::vector<char>& may_bear);

/// The spreads of all nodes of a body's contact surface, over nodes of which its file has the static
/// response.
class LoadSpread {
 public:
  /// The body must outlive this.
  explicit LoadSpread(const model::ElasticBody& body);
  /// Of a local node of the surface; found when it is first asked for.
  const Spread& of(int node);

 private:
  const Eigen::Matrix3Xd* X_;
  std::vector<std::vector<int>> sides_;
  std::vector<std::vector<int>> at_node_;  // numbers of sides
  std::vector<char> may_bear_;             // of each node
  std::unordered_map<int, Spread> known_;
};

}  // namespace elastogear::contact
