#include "elastogear/dynamics/contact_loads.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "dynamics/contact/low_rank_columns.h"
#include "elastogear/base/sort_unique.h"

namespace elastogear::dynamics {
namespace {

Eigen::Index slot(const std::vector<int>& node, int number) {
  return std::lower_bound(node.begin(), node.end(), number) - node.begin();
}

// Twist i at the point x_B: v_i + w_i x x_B.
Eigen::Vector3d twist_at(const body::MotionSubspace& H, Eigen::Index i, const Eigen::Vector3d& x_B) {
  return H.col(i).head<3>() + H.col(i).tail<3>().cross(x_B);
}

// Rows of W, V and V_dot of one contact at its nodes on one body, each node once, in the body's frame.
struct BodyColumns {
  struct Node {
    int node, local;   // one of its local nodes
    Eigen::Index row;  // of the node in L
    bool operator<(const Node& other) const { return node < other.node; }
    bool operator==(const Node& other) const { return node == other.node; }
  };
  std::vector<Node> nodes;            // ascending
  std::vector<Eigen::Index> place;    // among these of each local node; -1: on the other body
  contact::LocalColumns W, V, V_dot;  // 3 rows a node; V without columns is W, V_dot without columns zero

  Eigen::Index n() const { return static_cast<Eigen::Index>(nodes.size()); }
  bool has_rates() const { return V_dot.cols() > 0; }
  const contact::LocalColumns& displacement_columns() const { return V.cols() > 0 ? V : W; }
};

// A contact, its pair and one of the bodies there.
struct ContactOfBody {
  const PairContacts& pair;
  const contact::ContactPoint& point;
  int body;

  bool touches() const { return pair.body[0] == body || pair.body[1] == body; }
  bool has(int i) const { return pair.body[local_node(point, i).side] == body; }
};

// Rows of all local nodes on the body, added up by node.
void add_up(const BodyColumns& columns, const Eigen::Matrix3d& R_BW, const contact::LocalColumns& of_local,
            contact::LocalColumns& rows) {
  rows.setZero(3 * columns.n(), of_local.cols());
  for (std::size_t i = 0; i < columns.place.size(); ++i)
    if (columns.place[i] >= 0)
      rows.middleRows<3>(3 * columns.place[i]) +=
          R_BW.lazyProduct(of_local.middleRows<3>(3 * static_cast<Eigen::Index>(i)));
}

void set_nodes(const ContactOfBody& contact, const BodyTerms& terms, BodyColumns& columns) {
  const contact::ContactPoint& point = contact.point;
  const Eigen::Index n_u = terms.beta.rows() - 3 * static_cast<Eigen::Index>(terms.node.size());
  columns.nodes.clear();
  columns.place.clear();
  if (!contact.touches()) return;
  for (int i = 0; i < point.n_local(); ++i)
    if (contact.has(i)) columns.nodes.push_back({local_node(point, i).node, i, 0});
  sort_unique(columns.nodes);
  for (BodyColumns::Node& node : columns.nodes) node.row = n_u + 3 * slot(terms.node, node.node);
  for (int i = 0; i < point.n_local(); ++i) {
    const BodyColumns::Node node{local_node(point, i).node, i, 0};
    const auto at = std::lower_bound(columns.nodes.begin(), columns.nodes.end(), node);
    columns.place.push_back(contact.has(i) ? at - columns.nodes.begin() : -1);
  }
}

void set_columns(const ContactOfBody& contact, const BodyTerms& terms, const Eigen::Matrix3d& R_BW,
                 BodyColumns& columns) {
  const contact::ContactPoint& point = contact.point;
  set_nodes(contact, terms, columns);
  const bool has_rates = columns.n() > 0 && !point.V_dot.isZero(0);
  add_up(columns, R_BW, point.W, columns.W);
  if (point.V.size() > 0) add_up(columns, R_BW, point.V, columns.V);
  if (point.V.size() == 0) columns.V.resize(0, 0);
  if (has_rates) add_up(columns, R_BW, point.V_dot, columns.V_dot);
  if (!has_rates) columns.V_dot.resize(0, 0);
}

// Rows of W and V along the twists of the joint.
void add_joint_rows(const JointTwists& twists, const BodyColumns& c, const contact::SurfaceState& state,
                    Eigen::Index first, BodyTerms& terms) {
  const contact::LocalColumns& V = c.displacement_columns();
  for (Eigen::Index a = 0; a < c.n(); ++a) {
    const Eigen::Vector3d x_B = state.x_B.col(c.nodes[a].node);
    for (Eigen::Index i = 0; i < twists.H.cols(); ++i) {
      terms.W_s.row(i).segment(first, c.W.cols()) +=
          twist_at(twists.H, i, x_B).transpose().lazyProduct(c.W.middleRows<3>(3 * a));
      terms.V_s.row(i).segment(first, V.cols()) +=
          twist_at(twists.P, i, x_B).transpose().lazyProduct(V.middleRows<3>(3 * a));
    }
  }
}

// d(velocity): s_i turns it and adds P_dot_i at x_B. docs/theory, Eq. (6.12).
void add_joint_rates(const JointTwists& twists, const BodyColumns& c, const contact::ContactPoint& point,
                     const contact::SurfaceState& state, Eigen::Index first, BodyTerms& terms) {
  for (Eigen::Index a = 0; a < c.n(); ++a) {
    const Eigen::Vector3d x_B = state.x_B.col(c.nodes[a].node),
                          v_B = state.R_WB.transpose() * point.v.col(c.nodes[a].local);
    for (Eigen::Index i = 0; i < twists.P.cols(); ++i) {
      const Eigen::Vector3d rate = twist_at(twists.P_dot, i, x_B) + twists.P.col(i).tail<3>().cross(v_B);
      terms.V_s.row(i).segment(first, c.V_dot.cols()) +=
          rate.transpose().lazyProduct(c.V_dot.middleRows<3>(3 * a));
    }
  }
}

// Appends the rows of a contact to the columns from `first` on, which are the next ones.
void append(const BodyColumns& c, const contact::LocalColumns& rows, Eigen::Index first, Eigen::Index count,
            Eigen::SparseMatrix<double>& A) {
  constexpr double kMore = 1;  // of the entries so far, where there is no room for the next ones
  const Eigen::Index n = 3 * c.n(), before = A.outerIndexPtr()[first];
  A.data().resize(before + n * count, kMore);
  for (Eigen::Index j = 0, at = before; j < count; ++j, at += n) {
    int* row = A.innerIndexPtr() + at;
    for (const BodyColumns::Node& node : c.nodes)
      for (int d = 0; d < 3; ++d) *row++ = static_cast<int>(node.row) + d;
    std::copy_n(rows.col(j).data(), n, A.valuePtr() + at);
    A.outerIndexPtr()[first + j + 1] = static_cast<int>(at + n);
  }
}

void begin(Eigen::Index rows, Eigen::Index cols, Eigen::SparseMatrix<double>& A) {
  A.resize(rows, cols);
  A.reserve(12 * cols);  // four nodes
}

Eigen::Index column_count(const std::vector<PairContacts>& pairs) {
  Eigen::Index r = 0;
  for (const PairContacts& pair : pairs)
    for (const auto& point : pair.points) r += point.W.cols();
  return r;
}

// Does V of any contact differ from W, and has any a part of the velocities?
struct Differences {
  bool V = false, V_dot = false;
};

Differences differences(const std::vector<PairContacts>& pairs) {
  Differences any;
  for (const PairContacts& pair : pairs)
    for (const auto& point : pair.points) {
      any.V = any.V || point.V.size() > 0;
      any.V_dot = any.V_dot || !point.V_dot.isZero(0);
    }
  return any;
}

// The part of the force on a local node that lies along the master.
Eigen::Vector3d local_friction(const contact::ContactPoint& point, int i) {
  const int n_slave = point.n_slave();
  const double weight = i < n_slave ? point.slave_N[i] : -point.N[i - n_slave];
  return weight * (point.f - point.n * point.n.dot(point.f));
}

// Sums of a force on each local node of each contact.
template <class Force>
std::vector<NodalForces> gather(const std::vector<PairContacts>& pairs,
                                const std::vector<contact::SurfaceState>& states, const Force& force) {
  std::vector<NodalForces> forces(states.size());
  for (const PairContacts& pair : pairs)
    for (const auto& point : pair.points)
      for (int i = 0; i < point.n_local(); ++i) {
        const LocalNode local = local_node(point, i);
        forces[pair.body[local.side]].node.push_back(local.node);
      }
  for (std::size_t b = 0; b < states.size(); ++b) {
    sort_unique(forces[b].node);
    forces[b].x_B = states[b].x_B(Eigen::all, forces[b].node);
    forces[b].f_B.setZero(3, forces[b].x_B.cols());
  }
  for (const PairContacts& pair : pairs)
    for (const auto& point : pair.points)
      for (int i = 0; i < point.n_local(); ++i) {
        const LocalNode local = local_node(point, i);
        const int b = pair.body[local.side];
        forces[b].f_B.col(slot(forces[b].node, local.node)) += states[b].R_WB.transpose() * force(point, i);
      }
  return forces;
}

}  // namespace

LocalNode local_node(const contact::ContactPoint& point, int i) {
  const int n_slave = point.n_slave();
  if (i < n_slave) return {point.slave_side, point.slave_nodes[i]};
  return {1 - point.slave_side, point.master_nodes[i - n_slave]};
}

Eigen::Vector3d local_force(const contact::ContactPoint& point, int i) { return point.F.col(i); }

std::vector<NodalForces> nodal_forces(const std::vector<PairContacts>& pairs,
                                      const std::vector<contact::SurfaceState>& states) {
  return gather(pairs, states, local_force);
}

std::vector<NodalForces> friction_forces(const std::vector<PairContacts>& pairs,
                                         const std::vector<contact::SurfaceState>& states) {
  return gather(pairs, states, local_friction);
}

body::Force contact_force(const body::Equations& eq, const NodalForces& forces) {
  body::Force h{Eigen::VectorXd::Zero(eq.n_s()), Eigen::VectorXd::Zero(eq.n_q())};
  if (forces.joint.size() > 0) h.s = forces.joint;
  for (Eigen::Index p = 0; p < forces.f_B.cols(); ++p) {
    const Eigen::Vector3d f = forces.f_B.col(p);
    for (Eigen::Index i = 0; i < eq.n_s() && forces.joint.size() == 0; ++i)
      h.s[i] += twist_at(eq.H, i, forces.x_B.col(p)).dot(f);
    model::add_force(eq.body->surface.Phi, forces.node[p], f, h.q);
  }
  return h;
}

void add_geometric_stiffness(const JointTwists& twists, const NodalForces& forces, BodyTerms& terms) {
  const Eigen::Index first = terms.beta.rows() - 3 * forces.f_B.cols();
  for (Eigen::Index p = 0; p < forces.f_B.cols(); ++p) {
    const Eigen::Vector3d f = forces.f_B.col(p);
    for (Eigen::Index i = 0; i < twists.H.cols(); ++i) {
      terms.beta.col(i).segment<3>(first + 3 * p) -= f.cross(twists.P.col(i).tail<3>());
      terms.rho.col(i).segment<3>(first + 3 * p) -= f.cross(twists.H.col(i).tail<3>());
      for (Eigen::Index j = 0; j < twists.P.cols(); ++j) {
        const Eigen::Vector3d theta_j = twists.P.col(j).tail<3>();
        terms.C(i, j) -= f.dot(theta_j.cross(twist_at(twists.H, i, forces.x_B.col(p))));
      }
    }
  }
}

body::MotionSubspace velocity_twists(const body::Joint& joint, const body::MotionSubspace& H,
                                     const body::JointMotion& m, double shift_v) {
  body::MotionSubspace P_dot = shift_v * H;
  if (joint.type != body::JointType::free) return P_dot;
  const body::FrameDerivative d = body::frame_derivative(joint, H, m, {shift_v, 0});
  const Eigen::Vector3d v = body::frame_motion(joint, H, m).v;  // keeps its components in W
  for (Eigen::Index i = 0; i < H.cols(); ++i)
    P_dot.col(i).head<3>() = shift_v * d.r.col(i) + v.cross(d.theta.col(i));
  return P_dot;
}

namespace {

// Phi q' grows by shift_v Phi q and turns with w. What residual flexibility adds to positions has no rate of
// its own, but turns, too. docs/theory, Eq. (6.12).
void append_rows(const JointTwists& twists, const BodyColumns& c, Eigen::Index first, Eigen::Index count,
                 BodyTerms& terms) {
  append(c, c.W, first, count, terms.L);
  if (terms.L_V.rows() == 0) return;
  if (!c.has_rates()) {
    if (terms.L_x.rows() > 0) append(c, c.displacement_columns(), first, count, terms.L_x);
    return append(c, c.displacement_columns(), first, count, terms.L_V);
  }
  contact::LocalColumns V = c.displacement_columns();
  for (Eigen::Index a = 0; a < c.n(); ++a)
    for (Eigen::Index j = 0; j < count; ++j)
      V.col(j).segment<3>(3 * a) += Eigen::Vector3d(c.V_dot.col(j).segment<3>(3 * a)).cross(twists.w);
  if (terms.L_x.rows() > 0) append(c, V, first, count, terms.L_x);
  V += twists.shift_v * c.V_dot;
  append(c, V, first, count, terms.L_V);
}

void set_body_columns(int b, const JointTwists& twists, const std::vector<PairContacts>& pairs,
                      const contact::SurfaceState& state, BodyTerms& terms) {
  const Eigen::Matrix3d R_BW = state.R_WB.transpose();
  Eigen::Index first = 0;
  BodyColumns c;
  for (const PairContacts& pair : pairs)
    for (const auto& point : pair.points) {
      set_columns({pair, point, b}, terms, R_BW, c);
      add_joint_rows(twists, c, state, first, terms);
      if (c.has_rates()) add_joint_rates(twists, c, point, state, first, terms);
      append_rows(twists, c, first, point.W.cols(), terms);
      first += point.W.cols();
    }
}

// Writes the columns of F and G, of which the first `first` are there, to L, and to those of L_V and L_x that
// are wanted.
class StationColumns {
 public:
  StationColumns(const JointTwists& twists, const NodalForces& forces, Eigen::Index first, BodyTerms& terms)
      : twists_(twists),
        forces_(forces),
        terms_(terms),
        column_(first),
        shift_(terms.L.rows() - 3 * static_cast<Eigen::Index>(terms.node.size())) {}

  // Forces F by displacements along G.
  void add(const Eigen::SparseMatrix<double>& F, const Eigen::SparseMatrix<double>& G) {
    for (Eigen::Index j = 0; j < F.cols(); ++j, ++column_) {
      append(F, j, 1, terms_.L);
      append(G, j, 1, terms_.L_V);
      append(G, j, 1, terms_.L_x);
      add_twists(twists_.H, F, j, terms_.W_s);
      add_twists(twists_.P, G, j, terms_.V_s);
    }
  }
  // Forces F by velocities along F.
  void add_rates(const Eigen::SparseMatrix<double>& F) {
    for (Eigen::Index j = 0; j < F.cols(); ++j, ++column_) {
      append(F, j, 1, terms_.L);
      append(F, j, twists_.shift_v, terms_.L_V);
      append(F, j, 0, terms_.L_x);
      add_twists(twists_.H, F, j, terms_.W_s);
      add_twists(twists_.P_dot, F, j, terms_.V_s);
    }
  }
  void finalize() {
    for (Eigen::SparseMatrix<double>* L : {&terms_.L, &terms_.L_V, &terms_.L_x}) L->finalize();
  }

 private:
  void append(const Eigen::SparseMatrix<double>& S, Eigen::Index j, double factor,
              Eigen::SparseMatrix<double>& L) const {
    if (L.rows() == 0) return;
    L.startVec(column_);
    if (factor == 0) return;
    for (Eigen::SparseMatrix<double>::InnerIterator at(S, j); at; ++at)
      L.insertBack(shift_ + at.row(), column_) = factor * at.value();
  }
  void add_twists(const body::MotionSubspace& H, const Eigen::SparseMatrix<double>& S, Eigen::Index j,
                  Eigen::MatrixXd& rows) const {
    for (Eigen::Index i = 0; i < H.cols(); ++i)
      for (Eigen::SparseMatrix<double>::InnerIterator at(S, j); at; ++at)
        rows(i, column_) += twist_at(H, i, forces_.x_B.col(at.row() / 3))[at.row() % 3] * at.value();
  }

  const JointTwists& twists_;
  const NodalForces& forces_;
  BodyTerms& terms_;
  Eigen::Index column_, shift_;
};

// Columns of stations come after those of contact points.
void append_stations(std::size_t b, const JointTwists& twists, const ContactState& contact,
                     BodyTerms& terms) {
  const StationLoads& stations = contact.stations;
  if (b >= stations.body.size()) return;
  StationColumns columns(twists, contact.force[b],
                         terms.W_s.cols() - stations.K.cols() - stations.resistance.size(), terms);
  const bool rubs = !stations.with_friction.empty();
  columns.add(rubs ? stations.with_friction[b] : stations.body[b], stations.body[b]);
  if (rubs) columns.add_rates(stations.sliding[b]);
  columns.finalize();
}

void set_stiffness(const ContactState& contact, Eigen::SparseMatrix<double>& k) {
  Eigen::Index first = 0;
  k.reserve(contact::kColumns * k.cols());
  for (const PairContacts& pair : contact.pair)
    for (const auto& point : pair.points) {
      for (Eigen::Index j = 0; j < point.k.cols(); ++j) {
        k.startVec(first + j);
        for (Eigen::Index i = 0; i < point.k.rows(); ++i)
          if (point.k(i, j) != 0) k.insertBack(first + i, first + j) = point.k(i, j);
      }
      first += point.k.cols();
    }
  const Eigen::MatrixXd& K = contact.stations.K;
  for (Eigen::Index j = 0; j < K.cols(); ++j) {
    k.startVec(first + j);
    for (Eigen::Index i = 0; i < K.rows(); ++i) k.insertBack(first + i, first + j) = K(i, j);
  }
  for (Eigen::Index j = 0; j < contact.stations.resistance.size(); ++j) {
    k.startVec(first + K.cols() + j);
    k.insertBack(first + K.cols() + j, first + K.cols() + j) = contact.stations.resistance[j];
  }
  k.finalize();
}

}  // namespace

void set_contact_columns(const std::vector<JointTwists>& twists, const ContactState& contact,
                         EffectiveMatrix& A) {
  const Eigen::Index r =
      column_count(contact.pair) + contact.stations.K.cols() + contact.stations.resistance.size();
  Differences differ = differences(contact.pair);
  if (!contact.stations.with_friction.empty()) differ = {true, true};
  A.n_contact = r;
  A.k.resize(r, r);
  set_stiffness(contact, A.k);
  for (std::size_t b = 0; b < twists.size(); ++b) {
    BodyTerms& terms = A.body[b];
    const Eigen::Index n_e = terms.beta.rows();
    terms.W_s.setZero(twists[b].H.cols(), r);
    terms.V_s.setZero(twists[b].P.cols(), r);
    begin(n_e, r, terms.L);
    if (differ.V || differ.V_dot) begin(n_e, r, terms.L_V);
    if (differ.V_dot) begin(n_e, r, terms.L_x);
    set_body_columns(static_cast<int>(b), twists[b], contact.pair, contact.surface[b], terms);
    append_stations(b, twists[b], contact, terms);
  }
}

}  // namespace elastogear::dynamics
