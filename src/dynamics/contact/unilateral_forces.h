#pragma once
// The forces of contacts without a penalty, and their static responses w = R f, which close the gaps: one
// step of Newton's method from contacts that were found with other forces (docs/theory, Eqs. (6.24) and
// (6.25)).

#include <optional>
#include <vector>

#include "dynamics/contact/coulomb.h"
#include "dynamics/contact/response_newton.h"
#include "elastogear/dynamics/contact_loads.h"

namespace elastogear::dynamics {

/// 0 <= p, 0 <= g + c p, one of them 0, for the contacts of unilateral pairs (c > 0), and the tangential
/// forces t of those that stick, with the gaps, the displacements along the master and the directions of
/// forces linear in the displacements since the contacts were found.
class UnilateralForces {
 public:
  /// Contacts and the members of Compliant are borrowed.
  explicit UnilateralForces(const std::vector<PairContacts>& pairs);
  /// missing: 3 n, m, BRF, R f - w of the forces f found and the static response w they were found with.
  void add(const ResponseNewton::Compliant& compliant, const Eigen::VectorXd& missing);

  /// Returns whether there is a solution; the following are that. tolerance: of the forces as they turn.
  bool solve(double tolerance = 1e-10);
  /// Does a contact slide that stuck in the forces found, or stick that slid?
  bool slides_anew() const;
  /// Is what these forces leave of second order in their change? Not where directions stay as they were
  /// found, or nodes stick.
  bool takes_turning_in() const { return turns_ && !any_sticks_; }
  /// Gives the contacts, which are those of the constructor, their new forces.
  void set_forces(std::vector<PairContacts>& pairs) const;
  /// 3 n, N, BRF: change of the forces found on the i-th body added.
  const Eigen::VectorXd& force_change(std::size_t i) const { return bodies_[i].change; }

 private:
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, contact::kColumns>;
  using Vectors = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>;  // by p, and t where it sticks
  struct Contact {
    const contact::ContactPoint* point;
    const PairContacts* pair;
    Eigen::Index first, n;                        // of its forces p, t
    Eigen::Index turn = 0, n_turns = 0;           // of its displacements by which its force turns, V_turn' dx
    contact::LocalColumns W_k = {}, V_turn = {};  // dF = -W_k V_turn' dx at unchanged p and t
  };
  struct Touch {  // of a contact and a node, in the frame of the node's body
    std::size_t contact;
    Eigen::Index row;
    Vectors F_z, y_x;  // change of the force with p and t, gradients of the gap and of u
    Rows W, V;
    int local;  // number of the node among those of the contact
  };
  struct Body {
    std::vector<Touch> touches;
    const Eigen::MatrixXd* R;
    Eigen::Matrix3d R_BW;
    Eigen::VectorXd missing;
    Eigen::MatrixXd response;     // R L_p
    Eigen::VectorXd turned = {};  // N, change of the forces at unchanged p and t: their directions turn
    Eigen::VectorXd change = {};
  };

  using Along = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, contact::kColumns, 1>;
  struct Displacement {                                  // since a contact was found
    Along k_V;                                           // k V' dx
    Eigen::Vector3d way = Eigen::Vector3d::Zero();       // m, change of gap and u
    Eigen::Vector3d answered = Eigen::Vector3d::Zero();  // N, part of k V' dx that p and t make up for
  };

  auto forces_of(const Contact& contact, const Eigen::VectorXd& z) const {
    return z.segment(contact.first, contact.n);
  }
  std::vector<bool> likely() const;
  std::optional<Eigen::VectorXd> forces(const Eigen::MatrixXd& C, const Eigen::VectorXd& q);
  Eigen::VectorXd gaps() const;
  void set_changes();
  void set_moved(bool bearing = false);
  Eigen::VectorXd turned_forces();
  Eigen::VectorXd all_turned() const;
  void turn(const Eigen::VectorXd& all);
  void freeze_directions();
  bool turn_step_by_step(double tolerance);
  // Complementarity of y = q + C z, and the displacements a + B z by which forces turn: Eq. (6.25a).
  struct Turning {
    Eigen::MatrixXd C, B;
    Eigen::VectorXd q, a;
  };
  static void couple_direction(Contact& contact);
  std::optional<Turning> turning() const;
  bool leave_out(const Eigen::VectorXd& z, const Eigen::VectorXd& u);
  bool couple_directions();

  std::vector<Contact> contacts_;
  std::vector<CoulombContact> laws_;  // of each contact
  bool any_sticks_ = false, turns_ = true;
  std::vector<Body> bodies_;
  std::vector<Displacement> moved_;  // of each contact, as far as forces are turned
  Eigen::MatrixXd C_;
  Eigen::VectorXd z_found_, z_, q_;  // p and t of each contact
};

}  // namespace elastogear::dynamics
