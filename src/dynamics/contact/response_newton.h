#pragma once
// One Newton step for contact forces f and the static responses w = R f of the bodies to them, at unchanged
// closest points (docs/theory, Eq. (6.21)).

#include <vector>

#include "elastogear/dynamics/contact_loads.h"

namespace elastogear::dynamics {

/// (I + H k) lambda = sum over the bodies of L_V' (R f - w), H that of L_V' R L. Columns are those of the
/// contacts' W and V, one contact after the other.
class ResponseNewton {
 public:
  /// Contacts and the members of Compliant are borrowed.
  explicit ResponseNewton(const std::vector<PairContacts>& pairs);

  /// Residual flexibility of a body in contact: its touched nodes (ascending) and R among them (m/N, BRF).
  struct Compliant {
    std::size_t body;
    const Eigen::Matrix3d& R_WB;
    const std::vector<int>& node;
    const Eigen::MatrixXd& R;
  };
  /// missing: 3 n, m, BRF, R f - w of the forces f found and the present static response w.
  void add(const Compliant& compliant, const Eigen::VectorXd& missing);

  Eigen::VectorXd solve() const;  ///< lambda
  /// 3 n, N, BRF: L k lambda of the i-th body added.
  Eigen::VectorXd force_change(std::size_t i, const Eigen::VectorXd& lambda) const;

 private:
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, contact::kColumns>;
  struct Contact {
    const contact::ContactPoint* point;
    const PairContacts* pair;
    Eigen::Index column, leading;  // its first one, in all and among the leading ones
  };
  struct SlaveContact {  // of a contact and a node, in the frame of the node's body
    Contact contact;
    Eigen::Index row;  // the node's first
    Rows W_B, V_B;
  };
  struct Body {
    std::vector<SlaveContact> touches;
    const Eigen::MatrixXd* R;
  };

  static Eigen::VectorXd loads(const Body& body, const Eigen::VectorXd& k_lambda);
  Eigen::VectorXd multiply_k(const Eigen::VectorXd& lambda) const;
  Eigen::VectorXd multiply(const Eigen::VectorXd& lambda) const;
  Eigen::MatrixXd leading_block() const;
  static void add_leading(const Body& body, Eigen::MatrixXd& A);

  std::vector<Contact> contacts_;
  std::vector<Body> bodies_;
  std::vector<Eigen::Index> leading_;  // columns that change the force at an unchanged closest point
  Eigen::VectorXd right_;
};

}  // namespace elastogear::dynamics
