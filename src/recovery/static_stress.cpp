#include "recovery/static_stress.h"

#include <algorithm>
#include <utility>

#include "elastogear/base/dense_product.h"
#include "elastogear/base/error.h"
#include "recovery/crept_response.h"

namespace elastogear::recovery {
namespace {

// Numbers that are kept before a store is emptied, of 4 and of 8 bytes: 256 MB and 1 GB a set.
constexpr Eigen::Index kMaxKeptColumns = Eigen::Index{1} << 26, kMaxKeptUnits = Eigen::Index{1} << 27;

std::vector<int> evaluated_nodes(const model::Stress& stress, const std::vector<int>& nodes) {
  std::vector<int> evaluated;
  for (int node : nodes)
    evaluated.push_back(static_cast<int>(std::lower_bound(stress.node.begin(), stress.node.end(), node) -
                                         stress.node.begin()));
  return evaluated;
}

Eigen::MatrixXd at_times(const Eigen::MatrixXd& force, std::size_t loaded, Range times) {
  return force.block(3 * static_cast<Eigen::Index>(loaded), times.begin, 3, times.count);
}

}  // namespace

StaticStress::StaticStress(StaticResponseOfRun& response, std::vector<int> nodes)
    : response_(response),
      nodes_(std::move(nodes)),
      evaluated_(evaluated_nodes(response.body.stress, nodes_)),
      spread_(response.body) {
  if (is_stored() || response_.node.empty() || nodes_.empty()) return;
  const Eigen::MatrixXd all = unreduced_response(response_).stress(response_.node, nodes_);
  for (std::size_t b = 0; b < response_.node.size(); ++b)
    unit_[static_cast<int>(b)].instantaneous = all.middleCols(static_cast<Eigen::Index>(3 * b), 3);
}

// The rows are those of the instantaneous body, then those of its relaxed states.
const Eigen::MatrixXf& StaticStress::columns(int orbit) {
  const auto known = columns_.find(orbit);
  if (known != columns_.end()) return known->second;
  Eigen::MatrixXf read = io::read_stress_responses(response_.file, orbit);
  const model::Flexibility& flexibility = response_.body.flexibility;
  const auto n_states = 1 + static_cast<Eigen::Index>(flexibility.relaxed.size());
  require(read.rows() == n_states * static_cast<Eigen::Index>(6 * flexibility.stress.node.size()),
          response_.file, ": /flexibility/G lacks the relaxed states");
  if (static_cast<Eigen::Index>(1 + columns_.size()) * read.size() > kMaxKeptColumns) columns_.clear();
  return columns_.emplace(orbit, std::move(read)).first->second;
}

// State 0 is the instantaneous body.
Eigen::MatrixXd StaticStress::unit_stress(int position, Eigen::Index state) {
  const model::Flexibility& flexibility = response_.body.flexibility;
  const auto n_rows = static_cast<Eigen::Index>(6 * flexibility.stress.node.size());
  return model::stress_responses(flexibility, evaluated_, position,
                                 columns(flexibility.surface.orbit[static_cast<std::size_t>(position)])
                                     .middleRows(state * n_rows, n_rows));
}

const Eigen::MatrixXd& StaticStress::instantaneous_unit(int key) {
  Eigen::MatrixXd& unit = unit_[key].instantaneous;
  if (is_stored() && unit.size() == 0) unit = unit_stress(key, 0);
  return unit;
}

const std::vector<Eigen::MatrixXd>& StaticStress::grown_units(int position) {
  Unit& unit = unit_[position];
  if (!unit.grown.empty()) return unit.grown;
  const Eigen::MatrixXd at_once = unit_stress(position, 0);
  for (std::size_t k = 0; k < response_.crept->states.size(); ++k)
    unit.grown.push_back(unit_stress(position, static_cast<Eigen::Index>(1 + k)) - at_once);
  return unit.grown;
}

void StaticStress::forget_units() {
  Eigen::Index kept = 0;
  for (const auto& [position, unit] : unit_) {
    kept += unit.instantaneous.size();
    for (const Eigen::MatrixXd& grown : unit.grown) kept += grown.size();
  }
  if (is_stored() && kept > kMaxKeptUnits) unit_.clear();
}

// Spreads the forces before their stresses are summed: neighbours share most of the nodes that theirs go to.
void StaticStress::add_change(Range times) {
  const model::Flexibility& flexibility = response_.body.flexibility;
  std::map<int, Eigen::MatrixXd> change;  // N, 3 x n_t, by position
  const auto add = [&](int position, double weight, const Eigen::MatrixXd& force) {
    const auto at = change.try_emplace(position, Eigen::MatrixXd::Zero(3, times.count)).first;
    at->second += weight * force;
  };
  for (std::size_t b = 0; b < response_.node.size(); ++b) {
    const Eigen::MatrixXd force = at_times(response_.force, b, times);
    if (force.isZero(0)) continue;
    const int position = response_.position[b];
    const contact::Spread& to = spread_.of(flexibility.node[static_cast<std::size_t>(position)]);
    const auto is_loaded = [&](int node) { return model::find_loaded(flexibility, node) >= 0; };
    if (!std::ranges::all_of(to.node, is_loaded)) continue;
    add(position, -1, force);
    for (std::size_t i = 0; i < to.node.size(); ++i)
      add(model::find_loaded(flexibility, to.node[i]), to.weight[static_cast<Eigen::Index>(i)], force);
  }
  for (auto& [position, force] : change) {
    change_.unit.push_back(&instantaneous_unit(position));
    change_.force.push_back(std::move(force));
  }
}

void StaticStress::add_crept(Range times) {
  const CreptResponse& crept = *response_.crept;
  for (std::size_t b = 0; b < crept.position.size(); ++b)
    for (std::size_t k = 0; k < crept.states.size(); ++k) {
      Eigen::MatrixXd force = at_times(crept.states[k].force, b, times);
      if (force.isZero(0)) continue;
      crept_.unit.push_back(&grown_units(crept.position[b])[k]);
      crept_.force.push_back(std::move(force));
    }
}

void StaticStress::set_times(Range times, bool with_change) {
  forget_units();
  n_times_ = times.count;
  instantaneous_ = crept_ = change_ = {};
  if (nodes_.empty()) return;
  for (std::size_t b = 0; b < response_.node.size(); ++b) {
    Eigen::MatrixXd force = at_times(response_.force, b, times);
    if (force.isZero(0)) continue;  // a node bears at few times of a long run
    instantaneous_.unit.push_back(
        &instantaneous_unit(is_stored() ? response_.position[b] : static_cast<int>(b)));
    instantaneous_.force.push_back(std::move(force));
  }
  if (with_change && is_stored()) add_change(times);
  if (response_.crept) add_crept(times);
}

Eigen::MatrixXd StaticStress::stress_by(const Loads& loads, Range nodes) const {
  const auto n = static_cast<Eigen::Index>(3 * loads.unit.size());
  Eigen::MatrixXd unit(6 * nodes.count, n), force(n, n_times_), stress(6 * nodes.count, n_times_);
  for (std::size_t i = 0; i < loads.unit.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    unit.middleCols<3>(at) = loads.unit[i]->middleRows(6 * nodes.begin, 6 * nodes.count);
    force.middleRows<3>(at) = loads.force[i];
  }
  multiply(Op::plain, Op::plain, 1., unit, force, 0., stress);
  return stress;
}

Eigen::MatrixXd StaticStress::instantaneous(Range nodes) const { return stress_by(instantaneous_, nodes); }
Eigen::MatrixXd StaticStress::change_by_spread(Range nodes) const { return stress_by(change_, nodes); }
Eigen::MatrixXd StaticStress::whole(Range nodes) const {
  if (crept_.unit.empty()) return instantaneous(nodes);
  return instantaneous(nodes) + stress_by(crept_, nodes);
}

}  // namespace elastogear::recovery
