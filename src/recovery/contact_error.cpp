#include "recovery/contact_error.h"

#include <map>

#include "elastogear/contact/load_spread.h"
#include "elastogear/recovery/stress.h"

namespace elastogear::recovery {
namespace {

// Delta f by the position of a node in the flexibility, 3 x n_t, N.
std::map<int, Eigen::Matrix3Xd> change_of_forces(const StaticResponseOfRun& known_response) {
  const model::ElasticBody& body = known_response.body;
  contact::LoadSpread spread(body);
  const Eigen::Index n_t = known_response.force.cols();
  std::map<int, Eigen::Matrix3Xd> change;
  for (std::size_t b = 0; b < known_response.position.size(); ++b) {
    const auto f = known_response.force.middleRows(static_cast<Eigen::Index>(3 * b), 3);
    const auto add = [&](int position, double weight) {
      change.try_emplace(position, Eigen::Matrix3Xd::Zero(3, n_t)).first->second += weight * f;
    };
    const int position = known_response.position[b], node = body.flexibility.node[position];
    const contact::Spread& to = spread.of(node);
    for (std::size_t i = 0; i < to.node.size(); ++i)
      add(model::find_loaded(body.flexibility, to.node[i]), to.weight[static_cast<Eigen::Index>(i)]);
    add(position, -1);
  }
  return change;
}

}  // namespace

Eigen::MatrixXd contact_error(const StaticResponseOfRun& known_response, const std::vector<int>& nodes) {
  if (known_response.position.empty() || nodes.empty()) return {};
  const std::map<int, Eigen::Matrix3Xd> change = change_of_forces(known_response);
  std::vector<int> positions;
  Eigen::MatrixXd force(3 * static_cast<Eigen::Index>(change.size()), known_response.force.cols());
  for (const auto& [position, f] : change) {
    force.middleRows(3 * static_cast<Eigen::Index>(positions.size()), 3) = f;
    positions.push_back(position);
  }
  return von_mises(stored_stress(known_response, positions, force, nodes));
}

}  // namespace elastogear::recovery
