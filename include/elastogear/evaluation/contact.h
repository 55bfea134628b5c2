#pragma once
// Contact of two gears by teeth: which pairs of teeth bear, where, and how much.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/evaluation/motion.h"
#include "elastogear/gear/flank.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/model/result.h"

namespace elastogear::evaluation {

/// One contact of two flanks at one time; [0]: the pair's first gear, [1]: its second.
struct FlankContact {
  std::array<gear::Flank, 2> flank;
  std::array<Eigen::Vector3d, 2> x_B;  ///< m, in the body frames
  Eigen::Vector3d x_W;                 ///< m
  Eigen::Vector3d n;                   ///< unit normal in the world, out of the first gear
  Eigen::Vector3d f;                   ///< N, on the second gear, world
  double normal_force = 0;             ///< N, f along n
  double pressure = 0;                 ///< Pa, in the mean over the node's share of the surface, or Hertz's
  double half_width = 0;               ///< m, of the patch by H. Hertz; 0: not known
};

/// Surface of a gear with the flank of each of its groups of faces; nothing for groups that are no flanks.
struct Flanks {
  const model::Surface* surface = nullptr;
  std::vector<std::optional<gear::Flank>> of_group = {};
  std::vector<int> of_node = {};  ///< group of each node: that of its lowest face
};
Flanks flanks(const gear::Toothing& toothing, const model::Surface& surface);

/// z of the layers of nodes on the flanks at corners of cells, m, ascending; empty where they do not lie in
/// few planes. Nodes between corners are none: what a side of the second order bears is shared unevenly among
/// its nodes.
Eigen::VectorXd node_layers(const Flanks& flanks);

/// The contacts of one time. Points are those of the undeformed master's face; on the slave the point of the
/// world that it is at. Contacts with groups that are no flanks are left out. Error where a record names a
/// node or face that a surface does not have.
std::vector<FlankContact> flank_contacts(const std::vector<model::ContactRecord>& records,
                                         const std::array<const Gear*, 2>& gear,
                                         const std::array<Flanks, 2>& flanks, std::size_t step);

/// Which gear's nodes come into contact, 0 or 1: those of most records. Ends of the other one's face are
/// slaves, too.
int slave_side(const std::vector<std::vector<model::ContactRecord>>& records);

using ContactHistory = std::vector<std::vector<FlankContact>>;  ///< by time

/// Normal forces of pairs of teeth.
struct ToothPairs {
  std::vector<std::array<int, 2>> tooth;  ///< n, 0-based, of both gears
  Eigen::MatrixXd force;                  ///< n_t x n, N, normal
  Eigen::MatrixXd share;                  ///< n_t x n, of the sum of all; 0 where nothing bears
  Eigen::VectorXi count;                  ///< n_t, pairs that bear more than kBears of the sum
};
inline constexpr double kBears = 1e-3;  ///< smallest share of a pair of teeth that counts as in contact
ToothPairs tooth_pairs(const ContactHistory& contacts);

/// Operating contact ratio: mean number of pairs of loaded teeth.
double contact_ratio(const ToothPairs& pairs);

/// The side of a gear's teeth (+1 left, -1 right) that carries most over the run, g: 0 or 1; 0 where none
/// does.
int loaded_side(const ContactHistory& contacts, int g);

}  // namespace elastogear::evaluation
