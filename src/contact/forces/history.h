#pragma once
// History of contact: what is kept of one slave surface from one evaluation, and one step, to the next.

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "contact/forces/law.h"
#include "elastogear/base/archive.h"

namespace elastogear::contact {

/// Where and how fast a gap was, and the share of forces that was left there over a free boundary.
struct GapRate {
  double gap, rate, fade;  ///< m, m/s, -
};

/// A point of a slave face that may carry a force in a step, and a face of the master near it.
struct StandingPoint {
  int face;
  Eigen::Vector2d at;   ///< (u, v) of the face: where the gap was least after the last accepted step
  Eigen::Vector2d way;  ///< by which that has moved in the step
  int master_face;
};

/// By slave node, forces and gaps by slave point.
struct History {
  std::vector<int> last_face;            ///< master face each node touched last; -1
  std::vector<int> nearest_face;         ///< where a node's search begins, which nothing depends on; -1
  std::map<int, StickPoint> stuck = {};  ///< after the last accepted step
  std::map<int, StickPoint> open = {};   ///< where the last look found the other nodes that are near
  std::map<int, double> p = {};          ///< N, normal forces given
  std::map<int, double> p_before = {};   ///< N, of the step before
  std::map<int, GivenFriction> t = {};   ///< of nodes that stick, in the frame that contacts are found in
  std::optional<ImpactStep> step = {};   ///< the last one; nothing at rest, and with other laws
  bool in_step = false;                  ///< is that step being made, or has it been?
  std::set<int> closed = {};             ///< points whose rate is held in this step
  std::map<int, GapRate> start = {};     ///< after the last accepted step, of points that are near
  std::map<int, GapRate> near = {};      ///< of the last look between steps
  std::map<int, StandingPoint> standing = {};  ///< local minimum-gap points, of an impact law
};
using Histories = std::array<History, 2>;  ///< of both surfaces

/// N; 0 where none is given.
double given_force(const History& history, int point);
/// Null where the node did not stick after the last step.
const StickPoint* stuck_at(const History& history, int node);
GivenFriction friction_at(const History& history, int node);

/// Gives the points of these contacts their forces, all others none. R: from the frame of the contacts to
/// that in which contacts are found.
void set_forces(Histories& histories, const std::vector<ContactPoint>& contacts, const Eigen::Matrix3d& R);
/// Largest change, m, that set_forces would make in forces over the stiffness (N/m) of a side and point.
double unclosed(const Histories& histories, const std::vector<ContactPoint>& contacts,
                const std::function<double(int side, int point)>& stiffness);

/// At the end of a step: open candidates of the unilateral law have been found there, too; those that close
/// in the next step slide from there.
void accept(Histories& histories, const std::vector<ContactPoint>& contacts, bool sticks);

/// surface: of the slave, and its master. Throws Error for nodes or faces that these do not have.
void serialize(History& history, const model::Surface& slave, const model::Surface& master, Archive& archive);

}  // namespace elastogear::contact
