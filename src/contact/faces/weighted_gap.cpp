#include "contact/faces/weighted_gap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace elastogear::contact {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
using NodalColumns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

// Friction -mu p d of a node against the mean sliding of its part of the faces, Eq. (6.17).
struct NodeFriction {
  Vector3d slip, d;  // m/s, -
  Matrix3d d_v;      // s/m, derivative of d by the velocity
};

NodeFriction node_friction(const Law& law, const Vector3d& n, const Vector3d& v) {
  const Matrix3d along = Matrix3d::Identity() - n * n.transpose();
  const Vector3d slip = along * v;
  const double s = std::sqrt(slip.squaredNorm() + law.v_0 * law.v_0);
  const Vector3d d = slip / s;
  return {slip, d, (along - d * d.transpose()) / s};
}

// Normal force p with dp = -k (dg + damping dg_t).
struct NormalLaw {
  double p, k, damping, energy, power;  // N, N/m, s, J, W
};

NormalLaw normal_law(const Law& law, double gap, double rate) {
  if (law.unilateral) {
    const double c = unilateral_compliance(law, 1), p = law.p_given;
    return {p, 1 / c, 0, 0.5 * c * p * p, 0};
  }
  const NormalForce f = normal_force(law, gap, rate);
  return {f.p, -f.p_g, f.p_r / f.p_g, f.energy, f.power};
}

// Columns: the normal force, then the three of friction where there is any. Directions and shares of the
// nodes are those of this moment.
void set_tangent(const NormalLaw& normal, const NodalColumns& T, double mu, const NodeFriction& friction,
                 ContactPoint& c) {
  const bool slides = mu > 0, damped = normal.damping != 0;
  const Eigen::Index n = slides ? 4 : 1;
  c.W.setZero(T.rows(), n);
  c.V.setZero(T.rows(), n);
  c.k.setIdentity(n, n);
  c.W.col(0) = c.F_p.reshaped();
  c.V.col(0) = c.g_x.reshaped();
  c.k(0, 0) = normal.k;
  c.V_dot.setZero(T.rows(), slides || damped ? n : 0);
  if (damped) c.V_dot.col(0) = normal.damping * c.g_x.reshaped();
  if (!slides) return;
  c.W.rightCols<3>() = T;
  c.V_dot.rightCols<3>() = mu * normal.p * T * friction.d_v;
}

}  // namespace

WeightedGap::Node& WeightedGap::at(std::vector<Node>& nodes, int node) {
  const auto found = std::find_if(nodes.begin(), nodes.end(), [&](const Node& n) { return n.node == node; });
  return found == nodes.end() ? nodes.emplace_back(Node{node}) : *found;
}

void WeightedGap::add(const HeldPoint& p, double weight) {
  const Gap& gap = p.open.gap;
  const ClosestPoint& closest = p.open.projection.point;
  area_ += weight;
  gap_ += weight * p.g;
  n_ += weight * gap.n;
  const Eigen::Matrix<double, 3, 24> rows = on_nodes_of_faces(p.geometry, p.open.kinematics.G);
  const auto add_motion = [&](Node& node, const Matrix3d& T) {
    node.T += T;
    node.g_x += T.transpose() * gap.n;
  };
  const auto add_node = [&](Node& node, double N, int i) {
    node.N += weight * N;
    add_motion(node, weight * rows.middleCols<3>(3 * i));
  };
  const auto add_side = [&](std::vector<Node>& nodes, const SideWeights& side, double sign) {
    for (int i = 0; i < side.n; ++i)
      add_motion(at(nodes, side.node[i]), sign * weight * side.d[i] * Matrix3d::Identity());
  };
  const int sides = p.master[2] == p.master[3] ? 3 : 4;
  for (int i = 0; i < p.geometry.face.sides; ++i) add_node(at(slave_, p.slave[i]), p.geometry.N[i], i);
  for (int i = 0; i < sides; ++i) add_node(at(master_, p.master[i]), closest.N[i], 4 + i);
  add_side(slave_, p.slave_side, 1);
  add_side(master_, p.master_side, -1);
  if (weight <= most_) return;
  most_ = weight;
  face_ = p.open.projection.face;
  natural_ = natural_coordinates(sides, closest.u, closest.v);
}

void WeightedGap::set_nodes(ContactPoint& c) const {
  c.slave_side = slave_side_;
  c.slave_point = c.slave_node = c.stick.slave_node = node_;
  c.stick.slave_side = slave_side_;
  const auto set = [&](const std::vector<Node>& nodes, Eigen::VectorXi& numbers, Eigen::VectorXd& N) {
    numbers.resize(static_cast<Eigen::Index>(nodes.size()));
    N.resize(numbers.size());
    for (Eigen::Index i = 0; const Node& node : nodes) {
      numbers[i] = node.node;
      N[i++] = node.N / area_;
    }
  };
  set(slave_, c.slave_nodes, c.slave_N);
  set(master_, c.master_nodes, c.N);
  c.face = face_;
  c.xi = natural_[0];
  c.eta = natural_[1];
  c.n = n_.normalized();
  c.g_n = gap_ / area_;
}

std::optional<ContactPoint> WeightedGap::contact(Law law, double node_area,
                                                 const NodeVelocity& velocity) const {
  ContactPoint c;
  set_nodes(c);
  c.area = std::min(area_, node_area);
  law.c_p *= c.area / node_area;
  const Eigen::Index n = c.n_local();
  NodalColumns T(3 * n, 3);
  c.g_x.resize(3, n);
  c.v.resize(3, n);
  Eigen::Index i = 0;
  for (const auto* nodes : {&slave_, &master_})
    for (const Node& node : *nodes) {
      T.middleRows<3>(3 * i) = node.T.transpose() / area_;
      c.g_x.col(i) = node.g_x / area_;
      c.v.col(i++) = velocity(nodes == &slave_ ? slave_side_ : 1 - slave_side_, node.node);
    }
  if (!law.unilateral && is_open(law, c.g_n)) return {};
  const NormalLaw normal = normal_law(law, c.g_n, c.g_x.reshaped().dot(c.v.reshaped()));
  const NodeFriction friction = node_friction(law, c.n, T.transpose() * c.v.reshaped());
  c.F_p = c.g_x;
  if (law.mu > 0) c.F_p.reshaped() -= law.mu * T * friction.d;
  c.F = normal.p * c.F_p;
  c.f = slave_force(c);
  c.p = normal.p;
  c.slip = friction.slip;
  c.energy = normal.energy;
  c.power = normal.power;
  c.friction_power = law.mu * normal.p * friction.d.dot(friction.slip);
  if (law.unilateral) c.c = 1 / normal.k;
  set_tangent(normal, T, law.mu, friction, c);
  return c;
}

}  // namespace elastogear::contact
