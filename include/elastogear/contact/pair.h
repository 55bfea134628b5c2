#pragma once
// Contact of two deformed surfaces: coarse search (k-DOP trees), fine search (closest point, one projection
// per slave node), penalty forces and their consistent tangent.

#include <Eigen/SparseCore>
#include <array>
#include <memory>
#include <vector>

#include "elastogear/base/archive.h"
#include "elastogear/contact/true_surface.h"
#include "elastogear/contact/types.h"

namespace elastogear::contact {

/// Two surfaces in contact, with their trees and the faces found last. The surfaces must outlive the pair.
class Pair {
 public:
  /// K_r of both bodies serve the bounds of the deformation and may be left out; so may what is known of the
  /// true surfaces. responds: of each node, whether its body has a static response to forces there; empty:
  /// none is known to be without. Throws Error for settings out of range, for surfaces that are empty,
  /// inconsistent or not finite, and for true surfaces of other faces or nodes.
  Pair(const model::Surface& a, const model::Surface& b, const Settings& settings,
       const std::array<const Eigen::SparseMatrix<double>*, 2>& K_r = {},
       const std::array<const TrueSurface*, 2>& known = {},
       const std::array<std::vector<bool>, 2>& responds = {});
  /// The surfaces of another pair with other settings, which take gaps from the same surface with the same
  /// feature angle. No node is known to be without a static response.
  Pair(const Pair& like, const Settings& settings);
  /// As the other pair is now, with all that it has found; the surfaces are shared.
  Pair(const Pair& other);
  ~Pair();
  Pair(Pair&&) noexcept;

  /// Active contacts in the given configuration, ordered by pass and slave node (deterministic).
  /// Throws Error when a surface has non-finite positions.
  std::vector<ContactPoint> detect(const SurfaceState& a, const SurfaceState& b);
  /// Active contacts of the given motions. Only nodes that can touch are displaced, and a search is made only
  /// when the surfaces have moved by the skin since the last one.
  std::vector<ContactPoint> detect(const SurfaceMotion& a, const SurfaceMotion& b,
                                   const std::array<ResidualDisplacement, 2>& residual = {});

  /// Bound of the distance, in m, that a node of a surface goes from one motion to another, without residual
  /// displacements.
  double travel(int side, const SurfaceMotion& from, const SurfaceMotion& to) const;

  /// m, in its BRF, of a node that a contact of the last detect (by motion) names; residual included.
  Eigen::Vector3d position(int side, int node) const;

  /// Local minimum-gap points without a penalty: of motions that differ little from one at which all that can
  /// touch was looked at the same points touch. From now on detect by motion follows them to where the gap is
  /// least, as long as that is sure.
  void follow_points();
  /// The next call of detect by motion looks at all that can touch.
  void look_at_all();
  /// Whether detect by motion follows points wherever bodies have gone since all was looked at, as long as
  /// these are found and the nodes that could touch then are those that can now. What has touched
  /// since is missed.
  void follow_far(bool far);

  /// Local minimum-gap points that carry a force here are also found where they are no minima any more, at
  /// their last places, until they are released: they are kept from entering like all points of the slave.
  void keep_minima(const std::vector<ContactPoint>& contacts);
  /// Returns whether any is no minimum any more.
  bool release_minima();

  /// Unilateral law: later calls of detect find these contacts with these forces, all others with none.
  void set_forces(const std::vector<ContactPoint>& contacts);

  /// Augmented law: by how much gaps change, at most, when these contacts are given their forces by
  /// set_forces; m, change of forces over the penalty stiffness.
  double unclosed(const std::vector<ContactPoint>& contacts) const;
  /// Multiplies the penalty stiffness of all nodes.
  void stiffen(double factor);

  /// Augmented law, of bodies in motion: mass, in kg, that an impulse at each node of a surface moves, or
  /// less.
  void set_masses(int side, const Eigen::VectorXd& mass);
  /// Augmented law, of bodies in motion: detect finds the forces of this step from now on.
  void begin_step(const ImpactStep& step);
  /// Updates the active set of contacts, at the end of the step. contacts:
  /// that solve it with those held so far. Returns whether anything has changed.
  bool change_closed(const std::vector<ContactPoint>& contacts);
  /// The contacts that solve the step; null where it is not solved. From now on detect finds them with their
  /// forces, and with the gaps that the next step starts from. delivered: share of an impulse that changes
  /// the velocities at the end of the step. Returns whether there has been one.
  bool end_step(const std::vector<ContactPoint>* contacts, double delivered);
  /// Makes the sticking of these contacts what the next step starts from.
  void accept(const std::vector<ContactPoint>& contacts);

  /// The settings in force: as given, with stiffness, depth and skin filled in where they were 0.
  const Settings& settings() const;
  const Settings& given() const;
  const model::Surface& surface(int side) const;
  /// Searches made so far, and nodes displaced in the last call of detect.
  int n_searches() const;
  int n_displaced() const;

  /// The stick points that accept has kept, and all else that later calls of detect (by motion) take from
  /// earlier ones. Throws Error for nodes or faces that the surfaces do not have.
  void serialize(Archive& archive);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace elastogear::contact
