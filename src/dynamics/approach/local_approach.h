#pragma once
// The local approach of flanks by H. Hertz, in place of what meshes make of it whose faces are wider than the
// patch of contact: docs/theory, section 6.17. Each flank of one body of a pair, in contact with one flank
// of the other, is displaced along its normals by e(F), a function of the force F between both.

#include <map>
#include <optional>
#include <vector>

#include "dynamics/approach/approach_law.h"
#include "dynamics/approach/line_extent.h"
#include "dynamics/approach/mesh_work.h"
#include "dynamics/contact/residual_flexibility.h"
#include "elastogear/base/archive.h"
#include "elastogear/dynamics/system_model.h"

namespace elastogear::dynamics {

class LocalApproach {
 public:
  using Flexibilities = std::vector<std::optional<ResidualFlexibility>>;  // of each body

  /// Of the pairs with contact::FlankApproach::hertz, for which chosen_approach asks what that takes. The
  /// bodies must outlive this.
  explicit LocalApproach(const SystemModel& model);

  bool acts_on(std::size_t b) const { return flanks_[b].has_value(); }
  bool any() const { return !pairs_.empty(); }

  /// Finds the laws of all flanks that bear a force in the state, and goes the given share of the way from
  /// those before to them. Laws that hardly differ stay, so that a search for a state of rest comes to an
  /// end. Returns the largest difference of an approach where one has changed, m.
  double find(const ContactState& state, Flexibilities& flexibility, double share) {
    seeks_rest_ = true;
    return find(state, flexibility, share, kAtRest);
  }
  /// The same of flanks that have none yet; the others keep theirs. Where the mesh is too soft there is none,
  /// but in motion, where it is zero until the end of the step.
  void find_new(const ContactState& state, Flexibilities& flexibility);
  /// Finds the laws at the end of a step at this time: Eq. (7.2b). Those of small differences change as well:
  /// in steps from law to law they would excite vibrations that do not die away.
  void accept(const ContactState& state, Flexibilities& flexibility, double time);
  /// Lets the laws change on from those of the last two ends of steps, as these do, to this time: Eq.
  /// (6.37a).
  void extrapolate(double time);

  /// m, largest change of a displacement of a body by the laws found since the last call.
  double take_change(std::size_t b);

  /// The forces on a body that the following refer to. Returns the largest change of a displacement, m.
  double set_forces(std::size_t b, const NodalForces& forces);
  Eigen::Vector3d displacement(std::size_t b, int node) const;  ///< m, BRF
  /// m, BRF: what is left of the displacement without forces, by its tangent.
  Eigen::Vector3d lag(std::size_t b, int node) const;
  /// Adds the derivative of the displacements of these nodes with the forces on them: 3 n x 3 n, m/N.
  void add_tangent(std::size_t b, const std::vector<int>& node, Eigen::MatrixXd& R) const;
  double largest(std::size_t b) const;     ///< m, displacement
  double energy(std::size_t b) const;      ///< J, stored
  double taken() const { return taken_; }  ///< J, by the laws accepted so far
  void serialize(Archive& archive);

 private:
  static constexpr double kAtRest = 1e-8;  // of a flank's length, differences by which laws do not change

  struct Surface {  // of a body of such a pair
    const model::ElasticBody* body;
    const std::vector<int>* group;                  // of each node
    const std::vector<Eigen::Matrix3d>* curvature;  // of each node
    MeshWork mesh_work;
    double compliance;  // 1/Pa
  };
  struct Flank {
    ApproachLaw law;
    ApproachLaw accepted = {}, before = {};  // at the ends of the last two steps
    double force = 0;                        // N, of those set
    double approach = 0;                     // m, by the law at that force
  };
  struct Flanks {             // of a body
    Eigen::Matrix3Xd normal;  // of each surface node, BRF, outwards
    const std::vector<int>* group;
    std::vector<Flank> flank;    // by group
    std::vector<double> length;  // m, by group, diagonal of the box around its nodes
    double change = 0;           // m, of a displacement, that take_change has not told of
  };
  struct Pair {
    std::size_t number;
    int side;      // whose flanks are displaced
    double face;   // m, of the slave
    double least;  // m, smaller approaches are those of a touch without load
  };
  // Contacts of one pair of flanks.
  using Patches = std::map<int, std::vector<const contact::ContactPoint*>>;  // by group

  double find(const ContactState& state, Flexibilities& flexibility, double share, double least);
  void set_law(std::size_t b, std::size_t group, const ApproachLaw& law);
  Patches patches(const Pair& pair, const PairContacts& contacts) const;
  ApproachLaw law(const Pair& pair, int group, const std::vector<const contact::ContactPoint*>& patch,
                  const ContactState& state, Flexibilities& flexibility);
  static NodalForces normal_forces(const std::vector<const contact::ContactPoint*>& patch, int side,
                                   const Eigen::Matrix3d& R_BW);
  LineExtent line_extent_of(const contact::ContactPoint& point, const PairContacts& contacts,
                            const ContactState& state, const Eigen::Vector3d& x,
                            const Eigen::Vector3d& along) const;
  Eigen::Matrix3d curvature(const contact::ContactPoint& point, int side, std::size_t b) const;
  const Flank& flank_of(std::size_t b, int node) const;

  std::vector<Pair> pairs_;
  std::vector<std::optional<Surface>> surface_;  // of each body
  std::vector<std::optional<Flanks>> flanks_;    // of each body
  double taken_ = 0;
  double accepted_at_ = 0, before_at_ = 0;  // s
  bool seeks_rest_ = false;                 // since the end of the last step
  bool moves_ = false;                      // did that step not seek a state of rest?
};

}  // namespace elastogear::dynamics
