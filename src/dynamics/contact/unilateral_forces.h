#pragma once
// The forces of contacts without a penalty, and their static responses w = R f, which close the gaps: one
// step of Newton's method from contacts that were found with other forces (docs/theory.md, Eqs. (6.24) and
// (6.25)).

#include <optional>
#include <vector>

#include "dynamics/contact/response_newton.h"
#include "elastogear/dynamics/contact_loads.h"

namespace elastogear::dynamics {

/// 0 <= p, 0 <= g + c p, one of them 0, for the contacts of unilateral pairs (c > 0), with the gaps and the
/// directions of forces linear in the displacements since the contacts were found.
class UnilateralForces {
 public:
  /// Contacts and the members of Compliant are borrowed.
  explicit UnilateralForces(const std::vector<PairContacts>& pairs);
  /// missing: 3 n, m, BRF, R f - w of the forces f found and the static response w they were found with.
  void add(const ResponseNewton::Compliant& compliant, const Eigen::VectorXd& missing);

  /// Returns whether there is a solution; the following are that.
  bool solve();
  /// N, in the order of the unilateral contacts.
  const Eigen::VectorXd& p() const { return p_; }
  /// Gives the contacts, which are those of the constructor, their new forces.
  void set_forces(std::vector<PairContacts>& pairs) const;
  /// 3 n, N, BRF: change of the forces found on the i-th body added.
  const Eigen::VectorXd& force_change(std::size_t i) const { return bodies_[i].change; }

 private:
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, contact::kColumns>;
  struct Touch {  // of a contact and a node, in the frame of the node's body
    Eigen::Index contact, row;
    Eigen::Vector3d F_p, g_x;
    Rows W, V;
  };
  struct Body {
    std::vector<Touch> touches;
    const Eigen::MatrixXd* R;
    Eigen::VectorXd missing;
    Eigen::VectorXd turned = {};  // N, change of the forces at unchanged p: their directions turn
    Eigen::VectorXd change = {};
  };

  using Along = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, contact::kColumns, 1>;
  struct Displacement {  // since a contact was found
    Along k_V;           // k V' dx
    double closing = 0;  // m, g_x' dx
  };

  Eigen::VectorXd gaps() const;
  void set_changes();
  Eigen::VectorXd turned_forces();
  Eigen::VectorXd all_turned() const;
  void turn(const Eigen::VectorXd& all);
  void do_not_turn();

  std::vector<const contact::ContactPoint*> contacts_;
  std::vector<const PairContacts*> pair_;  // of each contact
  std::vector<Body> bodies_;
  std::vector<Displacement> moved_;  // of each contact, as far as forces are turned
  Eigen::MatrixXd C_;
  Eigen::VectorXd p_found_, p_, q_;
};

}  // namespace elastogear::dynamics
