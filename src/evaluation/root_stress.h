#pragma once
// Stress at the roots of teeth over the roll angle.

#include <Eigen/Core>
#include <vector>

#include "elastogear/evaluation/contact.h"
#include "elastogear/evaluation/motion.h"
#include "elastogear/gear/flank.h"
#include "elastogear/io/stress_file.h"

namespace elastogear::evaluation {

/// One value of a tooth's stress at a place on its way, where all teeth are taken for each other's copies.
struct ToothStress {
  double place = 0;      ///< pitches, of its way through the mesh
  double tension = 0;    ///< Pa, at the copies of the node of the largest one
  double von_mises = 0;  ///< Pa, at the copies of its node
  double stress = 0;     ///< Pa, principal stress of largest size with its sign, where `tension` is
};

/// A largest stress: value and estimated errors of the reduction, of the mesh, of the contact's resolution
/// and of the steps in time (Pa; < 0: not estimated), tooth (0-based), mesh node, time.
struct StressPeak {
  double value = 0, error = -1, mesh_error = -1, contact_error = -1, time_error = -1;
  int tooth = 0, node = 0, step = 0;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();  ///< m, of the node, body frame
};

struct RootStress {
  int side = 0;               ///< of the loaded flanks: tension is looked for at this side's roots
  std::vector<int> tooth;     ///< 0-based, that have nodes
  Eigen::MatrixXd tension;    ///< n_t x teeth, Pa, largest principal stress at the loaded side
  Eigen::MatrixXd von_mises;  ///< n_t x teeth, Pa, largest at both sides
  StressPeak largest_tension, largest_von_mises;
  std::vector<ToothStress> way;  ///< ascending places
  double range = 0;              ///< Pa, largest less smallest `stress` of one node on that way
};

/// Nodes and times (n x n_t) at which stress is that of a contact and not of a root: nodes at or beyond the
/// form circle, and those within two half widths of a patch that bears on gear g. A set without any node
/// below the form circle has the latter alone.
using Beside = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;
Beside beside_contacts(const io::StressSet& set, const Gear& gear, const ContactHistory& contacts,
                       std::size_t g);

/// set: stresses at the roots; side: of the loaded flanks; beside: what is left out; empty: nothing. Error
/// when the set has no positions or no node at that side.
RootStress root_stress(const io::StressSet& set, const Gear& gear, const Gear& mate, int side,
                       const Beside& beside = {});

}  // namespace elastogear::evaluation
