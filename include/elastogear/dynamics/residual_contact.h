#pragma once
// Contact of bodies with residual flexibility: contact forces f and the answers w = R f to them depend on
// each other, f = f(x + R f). They are brought together by Newton's method at every evaluation, so that f
// stays a function of the coordinates (docs/theory.md, section 6.9).

#include <optional>
#include <vector>

#include "elastogear/base/archive.h"
#include "elastogear/dynamics/residual_flexibility.h"

namespace elastogear::dynamics {

class ResidualContact {
 public:
  /// Bodies without static answers do not residual. They must outlive this.
  explicit ResidualContact(const std::vector<const model::ElasticBody*>& bodies);

  bool any() const;
  bool has_flexibility(std::size_t b) const { return flexibility_[b].has_value(); }
  /// For contact::Pair::detect, once for each pair of the body between two calls of seen().
  contact::ResidualDisplacement residual(std::size_t b);
  void seen();
  Eigen::Vector3d displacement(std::size_t b, int node) {
    return flexibility_[b]->displacement(node);
  }  ///< m, BRF
  /// R among the nodes (model::Surface numbers), m/N; empty for a body that does not residual.
  Eigen::MatrixXd among(std::size_t b, const std::vector<int>& node);

  /// Difference between the forces found and those that the nodes answered to.
  struct ForceResidual {
    double absolute = 0;  ///< N
    double relative = 0;  ///< of the forces found, at most 1
  };
  ForceResidual force_residual(const std::vector<NodalForces>& found) const;
  /// The next trial: the bodies answer to forces that, to first order, will be found.
  void newton_step(const std::vector<PairContacts>& pairs, const std::vector<contact::SurfaceState>& surfaces,
                   const std::vector<NodalForces>& found);
  /// Half of the way back to the answers before the last improvement.
  void backtrack();
  /// Brings contacts and answers together to first order, without another look at the surfaces: for a
  /// force_residual whose square is negligible. False, and nothing done, where forces have no potential.
  bool linear_step(std::vector<PairContacts>& pairs, const std::vector<contact::SurfaceState>& surfaces,
                   const std::vector<NodalForces>& found);

  /// Puts the forces that the bodies answer to in the place of those found.
  void take_forces_of_response(const std::vector<contact::SurfaceState>& surfaces,
                               std::vector<NodalForces>& found) const;
  /// Lets the bodies answer to the forces that the last two accepted states make likely at another time.
  void predict(double time);
  /// The answers of now belong to a step that was accepted.
  void accept(double time);

  double energy(std::size_t b);  ///< J, f'R f / 2
  /// Where the next solution starts from.
  void serialize(Archive& archive);

 private:
  void respond_to(std::size_t b, const NodalForces& forces);
  Eigen::VectorXd step(const std::vector<PairContacts>& pairs,
                       const std::vector<contact::SurfaceState>& surfaces,
                       const std::vector<NodalForces>& found);

  struct Accepted {
    double time = 0;
    std::vector<NodalForces> forces = {};  // of each body; of none before the first
  };

  std::vector<std::optional<ResidualFlexibility>> flexibility_;  // of each body
  Accepted last_, before_;
  std::vector<NodalForces> left_;  // of each body, answered to before the last improvement
  std::vector<double> change_;     // m, not yet seen by all pairs
};

}  // namespace elastogear::dynamics
