#pragma once
// The data of a contact pair, and the functions that find its contacts: at nodes and local minimum-gap points
// of each slave in its own pass, or integrated over the faces of one slave.

#include <array>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "contact/forces/gap_minima.h"
#include "contact/forces/history.h"
#include "contact/kept_minima.h"
#include "contact/projection/heights.h"
#include "contact/search/reach.h"
#include "contact/search/tracker.h"
#include "contact/valley.h"
#include "elastogear/contact/pair.h"

namespace elastogear::contact {

struct Side {
  std::vector<Law> law;               // of each node as slave
  Heights heights;                    // over its faces
  std::vector<bool> responds;         // of each node: has it a static response? Empty: all have
  Eigen::VectorXd area;               // m^2, of each node, undeformed; of contact integrated over faces
  std::vector<bool> stands_out = {};  // of each node: does the surface stand out of it, as deviations do?
};

// A point of the slave: its number, and its place between nodes, or at one.
struct OnSlave {
  int side, point;
  const Eigen::Vector4i& nodes;
  const Eigen::Vector4d& N;
};

// Functions that capture it and one thing more fit into std::function, which allocates nothing for them.
struct PlacedNode {
  int side, node;
  Eigen::Vector3d x;  // m
};

// Tells whether all points of a surface are tried as slaves, and not those of its edges alone.
inline bool is_whole(const Settings& settings, int slave_side) {
  return settings.two_pass || slave_side == settings.slave;
}

inline double radians(double degrees) { return degrees * std::numbers::pi / 180; }

struct Pair::Data {
  Settings given, settings;
  Side side[2];
  Histories history;
  Reach reach;
  Tracker tracker;
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  // from the frame that contacts are found in
  std::vector<Minimum> minima[2] = {};                 // of the last look
  KeptMinima kept[2] = {};                             // that bore a force since the last release
  std::vector<std::size_t> touching[2] =
      {};                    // slave nodes with a contact in the last look at all, among those near
  double follow_within = 0;  // m, motion since then over which its contacts are followed
  bool follows_far = false;  // in place of follow_within any

  static std::unique_ptr<Data> make(const Settings& given, const Settings& settings,
                                    std::array<Tracked, 2> both, std::array<Side, 2> side);
  bool sticks() const { return settings.friction.mu > 0 && settings.friction.law == FrictionLaw::stick; }
  const model::Surface& surface(int i) const { return *tracker.side(i).surface; }
  bool is_between_steps() const { return history[0].step && !history[0].in_step; }
  bool is_whole(int slave_side) const { return contact::is_whole(settings, slave_side); }
  void keep_stuck();
  void stand();
  Law law(const OnSlave& at, int master_face) const;
  Eigen::Vector3d node_height(int slave_side, const SurfaceView& slave, int node) const;
  std::optional<ContactPoint> node_contact(const MasterSide& master, const PlacedNode& slave,
                                           const Projection& w, double share, std::map<int, NodeGap>& gaps);
  std::optional<ContactPoint> beside_contact(const MasterSide& master, const PlacedNode& slave,
                                             const FaceOfValley& face);
  bool has_valleys() const;
  std::optional<ContactPoint> contact(const MasterSide& master, int slave_side, const Minimum& m);
  double stiffness(int slave_side, int point) const;
  std::optional<Projection> project(const MasterSide& master, const SurfaceView& slave,
                                    const PlacedNode& placed, std::span<const int> faces);
  bool is_left_to_slave(int tried, const SurfaceView& other, const Projection& w) const;
  bool may_follow() const;
  void add_node(const MasterSide& master, const SurfaceView& slave, std::size_t i,
                std::map<int, NodeGap>& gaps, std::vector<ContactPoint>& contacts);
  bool run_pass(int slave_side, bool follows, std::vector<ContactPoint>& contacts);
  bool follow_minima(const GapField& field, std::vector<Minimum>& followed) const;
  bool add_minima(const MasterSide& master, int slave_side, const std::map<int, NodeGap>* gaps,
                  std::vector<ContactPoint>& contacts);
  std::map<int, NodeGap> node_gaps(int slave_side, const MasterSide& master);
  Eigen::Vector3d curved(int i, int node) const;
  std::vector<ContactPoint> integrated_contacts();
  std::vector<ContactPoint> room() const;
  std::vector<ContactPoint> contacts(const Eigen::Matrix3d& R);
  std::optional<std::vector<ContactPoint>> followed_contacts(const Eigen::Matrix3d& R);
};

}  // namespace elastogear::contact
