#include "contact/faces/weighted_gap.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "contact/forces/contact_point.h"

namespace elastogear::contact {
namespace {

using Eigen::Matrix3d, Eigen::Vector2d, Eigen::Vector3d;
using NodalColumns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

// Normal force p with dp = -k (by_gap dg + by_rate dg_t).
struct NormalLaw {
  double p, k, by_gap, by_rate;  // N; N/m, -, s, or of an impact N s/m, 0, 1
  double energy, power, work;    // J, W, J
  double excess_rate;            // m/s
};

NormalLaw normal_law(const Law& law, double gap, double rate) {
  if (law.unilateral) {
    const double c = unilateral_compliance(law, 1), p = law.p_given;
    return {p, 1 / c, 1, 0, 0.5 * c * p * p, 0, 0, 0};
  }
  const NormalForce f = normal_force(law, gap, rate);
  if (law.impact) return {f.p, -f.p_r, 0, 1, 0, 0, f.work, f.excess_rate};
  return {f.p, -f.p_g, 1, f.p_r / f.p_g, f.energy, f.power, 0, 0};
}

// Friction of a node against the mean motion of its part of the faces.
struct NodeFriction {
  Stuck stuck;  // z in m/s where it does not stick
  bool sticks = false;
};

// Stretch of the tangential spring after the last step, m.
Vector3d stretch(const SurfaceView& master, const StickPoint& stuck) {
  const Face face = face_of(master, stuck.face);
  const Shape s = shape(face.sides, stuck.u, stuck.v);
  return stuck.e_u * combine(face, s.N_u) + stuck.e_v * combine(face, s.N_v);
}

NodeFriction node_friction(const Law& law, double p, const Sliding& sliding, const Matrix3d& along,
                           const Vector3d& slip, const std::optional<Vector3d>& moved) {
  if (law.v_0 > 0) return {{regularised(slip, law.v_0, law.mu * p), law.mu, p, false, slip}};
  if (law.mu == 0 || !sliding.stuck || !moved) return {};
  const bool slid = sliding.stuck->slides;
  const Vector3d z = along * (*moved + stretch(sliding.master, *sliding.stuck));
  if (!law.unilateral) return {stuck_on_spring(law, z, p, slid), true};
  const GivenFriction& given = sliding.friction;
  const double mu = slid || given.slides ? law.mu : law.mu_static;
  return {{given_friction(along * given.t, z, tangential_compliance(law), mu * p, given.slides && p > 0), mu,
           p, slid, z},
          true};
}

// Columns: the normal force, then the three of friction where there is any. Directions and shares of the
// nodes are those of this moment.
void set_tangent(const NormalLaw& normal, const NodalColumns& T, const NodeFriction& node, ContactPoint& c) {
  const bool rubs = node.stuck.mu > 0, damped = normal.by_rate != 0;
  const Eigen::Index n = rubs ? 4 : 1;
  c.W.setZero(T.rows(), n);
  c.V.setZero(T.rows(), n);
  c.k.setIdentity(n, n);
  c.W.col(0) = c.g_x.reshaped();
  c.V.col(0) = normal.by_gap * c.g_x.reshaped();
  c.k(0, 0) = normal.k;
  c.V_dot.setZero(T.rows(), rubs || damped ? n : 0);
  if (damped) c.V_dot.col(0) = normal.by_rate * c.g_x.reshaped();
  if (!rubs) return;
  if (node.stuck.friction.at_limit) c.W.col(0) -= node.stuck.mu * T * node.stuck.friction.direction;
  c.W.rightCols<3>() = T;
  const Matrix3d along = Matrix3d::Identity() - c.n * c.n.transpose();
  (node.sticks ? c.V : c.V_dot).rightCols<3>() = T * along * node.stuck.friction.K;
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
  at_ = {closest.u, closest.v};
}

void WeightedGap::set_nodes(ContactPoint& c) const {
  c.slave_side = slave_side_;
  c.slave_point = c.slave_node = c.stick.slave_node = node_;
  c.stick.slave_side = slave_side_;
  const auto set = [&](const std::vector<Node>& nodes, NodeNumbers& numbers, NodeWeights& N) {
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
  c.n = n_.normalized();
  c.g_n = gap_ / area_;
}

// Mean motion of the slave over the master since the last step.
std::optional<Vector3d> WeightedGap::moved(const Sliding& sliding) const {
  if (!sliding.stuck) return {};
  Vector3d sum = Vector3d::Zero();
  for (const auto* nodes : {&slave_, &master_})
    for (const Node& node : *nodes) {
      const auto x = sliding.moved(nodes == &slave_ ? slave_side_ : 1 - slave_side_, node.node);
      if (!x) return {};
      sum += node.T * *x;
    }
  return Vector3d(sum / area_);
}

std::optional<ContactPoint> WeightedGap::contact(Law law, double node_area, const Sliding& sliding) const {
  ContactPoint c;
  set_nodes(c);
  const Face face = face_of(sliding.master, face_);
  const Vector2d natural = natural_coordinates(face.sides, at_[0], at_[1]);
  c.xi = natural[0];
  c.eta = natural[1];
  c.area = std::min(area_, node_area);
  law.c_p *= c.area / node_area;
  law.c_t *= c.area / node_area;
  if (law.impact) law.impact->d *= c.area / node_area;
  if (is_open(law, c.g_n)) return {};
  const Eigen::Index n = c.n_local();
  NodalColumns T(3 * n, 3);
  c.g_x.resize(3, n);
  c.v.resize(3, n);
  Eigen::Index i = 0;
  for (const auto* nodes : {&slave_, &master_})
    for (const Node& node : *nodes) {
      T.middleRows<3>(3 * i) = node.T.transpose() / area_;
      c.g_x.col(i) = node.g_x / area_;
      c.v.col(i++) = sliding.velocity(nodes == &slave_ ? slave_side_ : 1 - slave_side_, node.node);
    }
  const Matrix3d along = Matrix3d::Identity() - c.n * c.n.transpose();
  const NormalLaw normal = normal_law(law, c.g_n, c.g_x.reshaped().dot(c.v.reshaped()));
  c.slip = along * (T.transpose() * c.v.reshaped());
  const NodeFriction node = node_friction(law, normal.p, sliding, along, c.slip, moved(sliding));
  const Eigen::VectorXd rubbing = node.stuck.mu * T * node.stuck.friction.direction;
  c.F_p = c.g_x;
  if (!node.sticks) c.F_p.reshaped() -= rubbing;
  c.F = normal.p * c.g_x;
  c.F.reshaped() -= normal.p * rubbing;
  c.f = slave_force(c);
  c.p = normal.p;
  c.energy = normal.energy;
  c.power = normal.power;
  c.work = normal.work;
  c.excess_rate = normal.excess_rate;
  if (!node.sticks) c.friction_power = normal.p * node.stuck.mu * node.stuck.friction.direction.dot(c.slip);
  if (law.unilateral) c.c = 1 / normal.k;
  set_tangent(normal, T, node, c);
  if (node.sticks && law.unilateral) {
    c.tangential = tangential_force(law, node.stuck, c.n);
    c.tangential->F_t = c.tangential->u_x = T * c.tangential->T;
  } else if (node.sticks) {
    set_spring(law, node.stuck, c);
  }
  set_stick_point(face, face_, at_, c);
  return c;
}

}  // namespace elastogear::contact
