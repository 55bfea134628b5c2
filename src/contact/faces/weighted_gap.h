#pragma once
// The gap of a slave node weighted with its interpolation function, and its force: docs/theory, Eqs.
// (6.28) and (6.29).

#include <functional>
#include <optional>
#include <vector>

#include "contact/faces/second_order.h"
#include "contact/forces/slave_point.h"

namespace elastogear::contact {

/// A point of a slave face over the master.
struct HeldPoint {
  const SlaveGeometry& geometry;
  const OpenPoint& open;
  double g;                       ///< m, gap over the sides
  Eigen::Vector4i slave, master;  ///< nodes of both faces
  const SideWeights &slave_side, &master_side;
};

using NodeVelocity = std::function<Eigen::Vector3d(int side, int node)>;  ///< m/s
/// m, since the last step; nothing where it is not known
using NodeMotion = std::function<std::optional<Eigen::Vector3d>(int side, int node)>;

/// Motion of both surfaces, and what is known of a slave node that sticks.
struct Sliding {
  const SurfaceView& master;
  const NodeVelocity& velocity;
  const NodeMotion& moved;
  const StickPoint* stuck;  ///< after the last step, or null
  GivenFriction friction;   ///< of a unilateral law
};

/// Sums over points of the faces around one slave node.
class WeightedGap {
 public:
  WeightedGap(int slave_side, int node) : slave_side_(slave_side), node_(node) {}
  /// weight: m^2, area times interpolation function.
  void add(const HeldPoint& point, double weight);
  /// The contact of the points that were added. law: of the whole node, whose undeformed area is given (m^2).
  /// Nothing where the gap of a penalty is open.
  std::optional<ContactPoint> contact(Law law, double node_area, const Sliding& sliding) const;

 private:
  struct Node {
    int node;
    double N = 0;                                   // m^2, by the faces alone
    Eigen::Matrix3d T = Eigen::Matrix3d::Zero();    // m^2, of the slave's velocity against the master
    Eigen::Vector3d g_x = Eigen::Vector3d::Zero();  // m^2
  };
  static Node& at(std::vector<Node>& nodes, int node);
  void set_nodes(ContactPoint& contact) const;
  std::optional<Eigen::Vector3d> moved(const Sliding& sliding) const;

  int slave_side_, node_;
  double area_ = 0, gap_ = 0;  // m^2, m^3
  Eigen::Vector3d n_ = Eigen::Vector3d::Zero();
  std::vector<Node> slave_, master_;
  double most_ = 0;  // m^2, weight of the point that the next two are of
  int face_ = 0;
  Eigen::Vector2d at_ = Eigen::Vector2d::Zero();  // (u, v)
};

}  // namespace elastogear::contact
