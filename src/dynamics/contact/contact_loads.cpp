#include "elastogear/dynamics/contact_loads.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "elastogear/base/sort_unique.h"

namespace elastogear::dynamics {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

Eigen::Index slot(const std::vector<int>& node, int number) {
  return std::lower_bound(node.begin(), node.end(), number) - node.begin();
}

// Twist i at the point x_B: v_i + w_i x x_B.
Eigen::Vector3d twist_at(const body::MotionSubspace& H, Eigen::Index i, const Eigen::Vector3d& x_B) {
  return H.col(i).head<3>() + H.col(i).tail<3>().cross(x_B);
}

// Rows of W, V and V_dot at one local node, turned into one body's frame, added to its W_s, V_s and L from
// `column` on.
struct NodeColumns {
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, contact::kColumns>;
  Eigen::Index column, first_row;  // first_row: of the node in L
  Eigen::Vector3d x_B, v_B;
  Rows W_B, V_B, V_dot_B;
};

// Sparse columns of W and V on the body's E.
struct SparseColumns {
  Triplets L, L_V, L_x;
};

void add_columns(const JointTwists& twists, const NodeColumns& c, BodyTerms& terms, SparseColumns& sparse) {
  for (Eigen::Index j = 0; j < c.W_B.cols(); ++j) {
    for (Eigen::Index i = 0; i < twists.H.cols(); ++i) {
      terms.W_s(i, c.column + j) += twist_at(twists.H, i, c.x_B).dot(c.W_B.col(j));
      terms.V_s(i, c.column + j) += twist_at(twists.P, i, c.x_B).dot(c.V_B.col(j));
    }
    for (Eigen::Index d = 0; d < 3; ++d) {
      sparse.L.emplace_back(c.first_row + d, c.column + j, c.W_B(d, j));
      sparse.L_V.emplace_back(c.first_row + d, c.column + j, c.V_B(d, j));
      sparse.L_x.emplace_back(c.first_row + d, c.column + j, c.V_B(d, j));
    }
  }
}

// d(velocity): s_i turns it and adds P_dot_i at x_B; Phi q' grows by shift_v Phi q and turns with w. What
// residual flexibility adds to positions has no rate of its own, but turns, too. docs/theory.md, Eq. (6.12).
void add_rate_columns(const JointTwists& twists, const NodeColumns& c, BodyTerms& terms,
                      SparseColumns& sparse) {
  for (Eigen::Index j = 0; j < c.V_dot_B.cols(); ++j) {
    const Eigen::Vector3d row = c.V_dot_B.col(j);
    for (Eigen::Index i = 0; i < twists.P.cols(); ++i)
      terms.V_s(i, c.column + j) +=
          row.dot(twist_at(twists.P_dot, i, c.x_B) + twists.P.col(i).tail<3>().cross(c.v_B));
    const Eigen::Vector3d turning = row.cross(twists.w), elastic = twists.shift_v * row + turning;
    for (Eigen::Index d = 0; d < 3; ++d) {
      sparse.L_V.emplace_back(c.first_row + d, c.column + j, elastic[d]);
      sparse.L_x.emplace_back(c.first_row + d, c.column + j, turning[d]);
    }
  }
}

NodeColumns node_columns(const contact::ContactPoint& point, int i, Eigen::Index column,
                         const BodyTerms& terms, const contact::SurfaceState& state) {
  const int node = local_node(point, i).node;
  const Eigen::Index n_u = terms.beta.rows() - 3 * static_cast<Eigen::Index>(terms.node.size());
  const Eigen::Matrix3d R_BW = state.R_WB.transpose();
  const bool has_rate = point.V_dot.cols() > 0;
  return {column,
          n_u + 3 * slot(terms.node, node),
          state.x_B.col(node),
          has_rate ? Eigen::Vector3d(R_BW * point.v.col(i)) : Eigen::Vector3d(Eigen::Vector3d::Zero()),
          R_BW * point.W.middleRows(3 * i, 3),
          R_BW * point.V.middleRows(3 * i, 3),
          R_BW * point.V_dot.middleRows(3 * i, 3)};
}

template <class Matrix>
void add_block(const Matrix& block, Eigen::Index first, Triplets& triplets) {
  for (Eigen::Index i = 0; i < block.rows(); ++i)
    for (Eigen::Index j = 0; j < block.cols(); ++j) triplets.emplace_back(first + i, first + j, block(i, j));
}

void set_sparse(Eigen::SparseMatrix<double>& A, Eigen::Index rows, Eigen::Index cols,
                const Triplets& triplets) {
  A.resize(rows, cols);
  A.setFromTriplets(triplets.begin(), triplets.end());
}

Eigen::Index column_count(const std::vector<PairContacts>& pairs) {
  Eigen::Index r = 0;
  for (const PairContacts& pair : pairs)
    for (const auto& point : pair.points) r += point.W.cols();
  return r;
}

bool without_potential(const std::vector<PairContacts>& pairs) {
  for (const PairContacts& pair : pairs)
    for (const auto& point : pair.points)
      if (point.V_dot.cols() > 0 || point.V != point.W) return true;
  return false;
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
  for (Eigen::Index p = 0; p < forces.f_B.cols(); ++p) {
    const Eigen::Vector3d f = forces.f_B.col(p);
    for (Eigen::Index i = 0; i < eq.n_s(); ++i) h.s[i] += twist_at(eq.H, i, forces.x_B.col(p)).dot(f);
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

void set_contact_columns(const std::vector<JointTwists>& twists, const std::vector<PairContacts>& pairs,
                         const std::vector<contact::SurfaceState>& states, EffectiveMatrix& A) {
  const Eigen::Index r = column_count(pairs);
  std::vector<SparseColumns> sparse(twists.size());
  Triplets k;
  for (std::size_t b = 0; b < twists.size(); ++b) {
    A.body[b].W_s.setZero(twists[b].H.cols(), r);
    A.body[b].V_s.setZero(twists[b].P.cols(), r);
  }
  Eigen::Index column = 0;
  for (const PairContacts& pair : pairs)
    for (const auto& point : pair.points) {
      for (int i = 0; i < point.n_local(); ++i) {
        const int b = pair.body[local_node(point, i).side];
        const NodeColumns columns = node_columns(point, i, column, A.body[b], states[b]);
        add_columns(twists[b], columns, A.body[b], sparse[b]);
        add_rate_columns(twists[b], columns, A.body[b], sparse[b]);
      }
      add_block(point.k, column, k);
      column += point.W.cols();
    }
  set_sparse(A.k, r, r, k);
  const bool two = without_potential(pairs);
  for (std::size_t b = 0; b < twists.size(); ++b) {
    const Eigen::Index n_e = A.body[b].beta.rows();
    set_sparse(A.body[b].L, n_e, r, sparse[b].L);
    if (!two) continue;
    set_sparse(A.body[b].L_V, n_e, r, sparse[b].L_V);
    set_sparse(A.body[b].L_x, n_e, r, sparse[b].L_x);
  }
}

}  // namespace elastogear::dynamics
