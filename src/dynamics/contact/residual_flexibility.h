#pragma once
// Residual flexibility R = F - Phi_c K_r^-1 Phi_c' of one modal body: what the modes leave out of its static
// response to contact forces (docs/theory, Eq. (6.20)), and how that creeps where the body is viscoelastic
// (section 2.9).

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "dynamics/creep/creep_history.h"
#include "elastogear/base/archive.h"
#include "elastogear/body/creep.h"
#include "elastogear/dynamics/contact_loads.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/model/relaxed_state.h"

namespace elastogear::dynamics {

/// Blocks of R are computed when they are first asked for, and kept. For nodes that the body's flexibility
/// does not provide for R = 0: forces there deform the modes alone. Nodes are those of the surface. The
/// residual displacement is w = R f of an elastic body; of a viscoelastic one it has a history, which the
/// nodes keep that have been loaded, and R is what forces add to it within the step.
class ResidualFlexibility {
 public:
  /// The body must outlive this.
  explicit ResidualFlexibility(const model::ElasticBody& body);

  /// The forces that displacement, largest and change refer to; x_B is not read.
  void set_forces(const NodalForces& forces);
  const NodalForces& forces() const { return forces_; }
  Eigen::Vector3d displacement(int node);  ///< m, BRF: w of the node
  /// m, BRF: what is left of w without forces; zero for an elastic body.
  Eigen::Vector3d lag(int node);
  double largest() const { return largest_; }  ///< m/N, bound of |R(b, b)|
  double bound(const NodalForces& forces);     ///< m, no node is displaced farther by these forces at once
  double lag_bound() const { return lag_bound_; }  ///< m, no node that has been loaded lags farther
  /// R among the given nodes: 3 n x 3 n, m/N, symmetric. The reference is valid until other nodes are asked
  /// for.
  const Eigen::MatrixXd& among(const std::vector<int>& node);

  bool is_viscoelastic() const { return laws().creeps(); }
  /// Does w have a history?
  bool creeps() const { return laws().creeps() && moduli_ == body::Moduli::relaxing; }
  /// From here on states are at this point of a step. Returns the largest change of w by that, m.
  double set_point(body::Moduli moduli, const body::StepPoint& at);
  /// The forces in place are those at the end of the step: it becomes the start of the next one.
  void accept();
  /// Change of w of a node since the last accepted state, in which these were the forces, m; where it creeps.
  Eigen::Vector3d change_since(const NodalForces& then, int node);
  double energy();  ///< J, stored by the forces in place. Eq. (3.28)
  /// J, that the material has taken up to the last accepted state.
  double loss() const { return history_.loss(); }
  /// The forces and their history.
  void serialize(Archive& archive);
  /// The history alone, of the last accepted state.
  void get_history(model::RelaxedState& state) const { history_.get(state); }
  /// Begins with it. Throws Error where it is not one of this body.
  void set_history(const model::RelaxedState& state);

 private:
  using Columns = Eigen::Matrix<float, Eigen::Dynamic, 3>;
  using ThreeRows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;
  struct Response {    // of the body with one set of moduli to a node
    const Columns* F;  // of its orbit
    ThreeRows Phi_over_K;
  };
  struct Loaded {
    int position;  // in the flexibility
    Response response;
    std::vector<Response> relaxed;  // of each state
  };
  using Blocks = Eigen::Matrix3Xd;   // 3 x 3 n, side by side
  struct Row {                       // of one node a
    std::vector<Eigen::Matrix3d> R;  // R_0(a, b) by the number of b; not yet known: NaN
    std::vector<Blocks> D = {};      // D_j(a, b) of all laws, where that is not R_0; not yet known: empty
  };
  struct Bearing {  // a node that carries a force
    int number;
    Eigen::Vector3d f;
  };
  struct RelaxedState {
    Eigen::MatrixXd K_inverse;  // of the reduced body
    std::unordered_map<int, Columns> columns = {};
  };
  struct Displaced {  // of a node, by the forces in place
    Eigen::Vector3d by_R;
    Eigen::Matrix3Xd by_D;  // 3 x n_laws
  };

  bool relaxes_alike() const { return body_->flexibility.relaxed.empty(); }
  void set_bounds();
  double growth(const Eigen::VectorXd& before) const;
  int number(int node);
  const Columns& columns(int orbit);
  Eigen::Matrix3d residual(int a, const Response& b, int position_b) const;
  const Eigen::Matrix3d& block(Row& row, int a, int number);
  const Blocks& creep_blocks(Row& row, int a, int number);
  Eigen::Matrix3d at_once(Row& row, int a, int number);
  Eigen::Matrix3d never_creeping(Row& row, int a, int number);
  Blocks creep_blocks(int a, const Loaded& b, const Eigen::Matrix3d& R_0) const;
  body::CreepState displaced_by(int a, int b, const body::CreepState& force);
  Row& row(int node);
  Displaced displaced(int node);
  const body::CreepLaws& laws() const { return history_.laws(); }
  CreepHistory::Response response();

  const model::ElasticBody* body_;
  CreepHistory history_;
  Eigen::MatrixXd C_ = {};                 // where the body relaxes in different ratios. Eq. (2.23)
  std::vector<RelaxedState> states_ = {};  // of it
  body::Moduli moduli_ = body::Moduli::relaxing;
  double largest_ = 0, largest_R_0_ = 0;  // m/N, of |R(b, b)|, of |R_0(b, b)|
  double lag_bound_ = 0;
  NodalForces forces_;
  std::vector<Bearing> bearing_;              // of the nodes of forces_
  std::unordered_map<int, int> number_of_;    // node -> number among those that were loaded so far, -1: R = 0
  std::unordered_map<int, Columns> columns_;  // of F, by orbit: images share them
  std::vector<Loaded> loaded_;                // these
  std::vector<Row> rows_;                     // of each node of the surface, empty before it is asked for
  std::size_t n_rows_ = 0;
  struct Among {
    std::vector<int> node = {};
    Eigen::MatrixXd R = {};
  };
  std::array<Among, 2> among_;  // asked for last, and before
};

}  // namespace elastogear::dynamics
