#pragma once
// Stresses of a body's static response at the nodes of a set, for some output times after others and in parts
// of the set that fit into a processor's cache (docs/theory, sections 4.1, 4.5 and 4.6).

#include <Eigen/Core>
#include <map>
#include <vector>

#include "elastogear/contact/load_spread.h"
#include "elastogear/recovery/static_response.h"

namespace elastogear::recovery {

/// Some of the nodes of a set, or some of a run's output times.
struct Range {
  Eigen::Index begin, count;
};

class StaticStress {
 public:
  /// nodes: n mesh numbers. The response must outlive this.
  StaticStress(StaticResponseOfRun& response, std::vector<int> nodes);

  /// Reads what the forces at these times ask for, of which the other functions then tell. with_change: and
  /// what change_by_spread asks for.
  void set_times(Range times, bool with_change);

  /// 6 n x n_t, Pa, at some of the nodes: S K^-1 f, and in states of relaxation the first sum of Eq. (4.12).
  Eigen::MatrixXd whole(Range nodes) const;
  /// S K^-1 f of the instantaneous body alone.
  Eigen::MatrixXd instantaneous(Range nodes) const;
  /// S K^-1 Delta f of Eq. (4.14).
  Eigen::MatrixXd change_by_spread(Range nodes) const;

  /// Does the body file hold the responses, without which change_by_spread cannot be told?
  bool is_stored() const { return !response_.position.empty(); }

 private:
  // Stresses by unit forces on one node, 6 n x 3 each, Pa/N.
  struct Unit {
    Eigen::MatrixXd instantaneous;
    std::vector<Eigen::MatrixXd> grown;  // of relaxed states, less the instantaneous
  };
  // Stresses by unit forces, and the forces at the times.
  struct Loads {
    std::vector<const Eigen::MatrixXd*> unit;
    std::vector<Eigen::MatrixXd> force;  // 3 x n_t each, N
  };

  const Eigen::MatrixXf& columns(int orbit);
  Eigen::MatrixXd unit_stress(int position, Eigen::Index state);
  const Eigen::MatrixXd& instantaneous_unit(int key);
  const std::vector<Eigen::MatrixXd>& grown_units(int position);
  void add_change(Range times);
  void add_crept(Range times);
  void forget_units();
  Eigen::MatrixXd stress_by(const Loads& loads, Range nodes) const;

  StaticResponseOfRun& response_;
  std::vector<int> nodes_;
  std::vector<int> evaluated_;  // of the nodes, local numbers in the body's stress
  contact::LoadSpread spread_;
  std::map<int, Eigen::MatrixXf> columns_;  // of G, by orbits
  std::map<int, Unit> unit_;  // by positions in the flexibility; of a factor of K by numbers of loaded nodes
  Eigen::Index n_times_ = 0;
  Loads instantaneous_, crept_, change_;
};

}  // namespace elastogear::recovery
