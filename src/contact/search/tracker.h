#pragma once
// Which nodes and faces of two moving surfaces can touch, where those nodes are and how fast they move. A
// search is made only when the surfaces have used up a skin (docs/theory, section 5.1).

#include <optional>

#include "contact/projection/face_boxes.h"
#include "contact/projection/projection.h"
#include "contact/search/coarse_search.h"
#include "contact/search/neighbour_list.h"
#include "contact/search/node_displacements.h"
#include "elastogear/base/archive.h"
#include "elastogear/contact/deformation_bound.h"

namespace elastogear::contact {

/// One surface with what bounds its motion.
struct Tracked {
  const model::Surface* surface;  ///< borrowed
  Topology topology;
  DeformationBound bound;
  Ball ball;
  Eigen::Matrix3Xd corners;  ///< of a polyhedron around it
};
Tracked tracked(const model::Surface& surface, const Eigen::SparseMatrix<double>* K_r);

/// What is known of the nodes of a surface as slaves, by node.
struct SlaveNodes {
  std::vector<bool> tried;    ///< empty: all
  std::vector<double> spare;  ///< m, by how much less than limits.outside serves; empty: none
};

/// The surfaces that give slave nodes, in the order of the passes. Without a penalty the edges of the master
/// do, too.
std::vector<int> slave_sides(const Settings& settings);

/// Frame of all positions: the BRF of surface b.
class Tracker : private NodePlacer {
 public:
  /// settings: complete, as with_defaults returns them.
  Tracker(std::array<Tracked, 2> sides, const Settings& settings, const Limits& limits,
          std::array<SlaveNodes, 2> slaves);

  /// Places all nodes and finds the candidates of these states. Throws Error for states that are not finite.
  void find(const SurfaceState& a, const SurfaceState& b);
  /// From now on nodes are placed by these motions where they are asked for. Throws Error for motions that
  /// are not finite. Motions and residual displacements must live as long as velocity and all_faces are
  /// called.
  void move_to(const SurfaceMotion& a, const SurfaceMotion& b,
               const std::array<ResidualDisplacement, 2>& residual);
  /// Do the surfaces touch no farther than `distance` (m) from where they were in the last call of find_near,
  /// with faces that can still be nearest?
  bool stays_within(double distance) const;
  /// Finds the nodes that can touch, with a search where one is due; of contact integrated over faces all
  /// that can touch are placed.
  void find_near();
  /// Surfaces do not stay within any distance until the next call of find_near.
  void forget_near() { is_seen_ = false; }
  /// The next call of find_near searches anew.
  void forget();
  /// Nodes of either surface that find_near places whether they can touch or not, until told otherwise.
  void keep(std::array<std::vector<int>, 2> nodes) { kept_ = std::move(nodes); }

  const Tracked& side(int i) const { return side_[i]; }
  const Configuration& configuration() const { return configuration_; }
  SurfaceView view(int i, double extension);
  /// Slave nodes that can touch, with the faces that can be nearest.
  const Neighbours& near(int slave) const { return neighbours_->near[slave]; }
  /// Takes down that a slave node that was found near now is outside the master by that much, m.
  void set_clearance(int slave, int node, double clearance);
  /// Can the node surely not touch, by what has been taken down of it?
  bool is_clear(int slave, int node) const { return clear_until_[slave][node] > way_ + limits_.outside; }
  /// All faces within the depth limit of a slave node.
  std::span<const int> all_faces(int slave, int node) const { return neighbours_->candidates[slave][node]; }
  /// Of the faces of a surface; null where no bound of its deformation is known without displacing all nodes.
  const FaceBounds* bounds(int i) const { return bounds_[i] ? &*bounds_[i] : nullptr; }
  /// Unit normal of a node of the undeformed surface, in the frame of all positions; zero after find.
  Eigen::Vector3d undeformed_normal(int i, int node) const;
  /// Position of a node in the BRF of its surface, m.
  Eigen::Vector3d position_B(int i, int node);
  /// Velocity of a node, m/s, components in the BRF of surface b; zero after find, which knows no motion.
  Eigen::Vector3d velocity(int i, int node);

  /// Keeps the positions of the nodes placed since the last call of move_to, for moved.
  void remember();
  /// How far a node has moved since then, m, in the frame of all positions; nothing where it was not placed.
  std::optional<Eigen::Vector3d> moved(int i, int node) const;

  int n_searches() const { return n_searches_; }
  int n_displaced() const { return n_displaced_; }  ///< since the last call of move_to

  /// All that later calls of find_near take from earlier ones.
  void serialize(Archive& archive);

 private:
  void place(const SurfaceState& a, const SurfaceState& b);
  void place(bool deformed);
  void place_node(int i, int node) final;
  void place_around(int i, int node);
  void place_face(int i, int face);
  void place_for(int slave, const Neighbours& near);
  Eigen::Vector3d position(int i, int node);
  Eigen::Vector3d elastic_velocity(int i, int node);
  void start_stage();
  void start_look();
  FaceBounds face_bounds(int i) const;
  double distance_since(const SurfaceMotion then[2]) const;
  void go_on();
  void forget_way();
  struct Ahead {  // a place on the way of both surfaces, and how far away it is, m
    SurfaceMotion motion[2];
    double way = 0;
  };
  std::optional<Ahead> motion_ahead() const;
  void search();
  void measure_clearance(double limit, double way_left);
  void take_near(double distance);
  void leave_out(int slave, double clear);
  double largest_deformation(int i) const;
  void update_neighbours();
  void serialize_neighbours(Archive& archive);
  void find_candidates(double margin);
  void find_candidates();

  std::array<Tracked, 2> side_;
  Settings settings_;
  Limits limits_;
  std::array<SlaveNodes, 2> slaves_;
  CoarseSearch search_;
  std::array<FaceBoxes, 2> boxes_;
  std::array<std::optional<FaceBounds>, 2> bounds_;  // of this look
  std::array<Eigen::Matrix3Xd, 2> normals_;          // of the nodes of the undeformed surfaces, BRF
  double reach_;  // m, largest distance of a slave node from a master face's corners that can still matter
  Configuration configuration_;
  std::optional<NeighbourList> neighbours_;
  std::array<std::vector<int>, 2> kept_;
  const SurfaceMotion* now_[2] = {};                               // while contacts are detected by motions
  const std::array<ResidualDisplacement, 2>* residual_ = nullptr;  // beside them
  bool has_residual_ = false;  // did anything in the last call of move_to?
  double residual_since_found_ = 0, residual_since_measured_ = 0;  // m, bounds of the change
  SurfaceMotion seen_at_[2];                                       // in the last call of find_near,
  bool is_seen_ = false;                                           // unless that is forgotten
  double residual_since_seen_ = 0;                                 // m, bound of the change
  double way_ = 0;              // m, of the surfaces, from one call of find_near to the next,
  bool knows_way_ = false;      // unless there was none since the last call of forget
  bool is_near_found_ = false;  // since the last call of move_to
  std::array<std::vector<double>, 2> clear_until_;  // by slave side and node: the way without touch, m
  std::array<NodeDisplacements, 2> displaced_;      // by q, while residual displacements may change
  struct Rates {  // Phi q_dot of the nodes with the present number, which changes with q_dot
    Eigen::VectorXd q_dot;
    Eigen::Matrix3Xd x_dot_B;
    std::vector<long> node;
    long number = 0;
  };
  std::array<Rates, 2> rates_;
  struct Look {                            // what is placed now: entries with the present number
    std::vector<long> node, around, face;  // by node: itself, and all nodes of the faces there; by face
    std::vector<int> nodes;
  };
  std::array<Look, 2> look_;
  long n_looks_ = 0;
  struct Placed {
    std::vector<int> node;  // ascending
    Eigen::Matrix3Xd x;
  };
  std::array<Placed, 2> remembered_;
  int n_searches_ = 0, n_displaced_ = 0;
};

}  // namespace elastogear::contact
