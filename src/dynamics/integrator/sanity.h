#pragma once
// Checks that a computed state is one that the theory describes (docs/theory.md, section 8.5). Private to
// module dynamics.

#include <vector>

#include "elastogear/base/error.h"
#include "elastogear/dynamics/deformation.h"
#include "elastogear/dynamics/system.h"

namespace elastogear::dynamics {

/// Error that ends a run whose state is not worth keeping.
struct Insane : Error {
  using Error::Error;
};

/// Watches the states after successive steps.
class Sanity {
 public:
  explicit Sanity(const System& system);
  /// Error, which says why, for a body deformed by half its size or more, and for a mass matrix of inertia
  /// level linear that is no longer positive definite.
  void require_small(const model::Snapshot& now) const;
  /// Error when energy came from nowhere: more of it than the run began with and the loads have turned over.
  void require_balance(const model::Energies& now);
  void serialize(Archive& archive);

 private:
  struct Body {
    DeformationWatch deformation;
    Eigen::Matrix<double, 6, 6> carried;  // C'M_r^-1 C, C = [C_l, C_r]; level linear only
  };
  void require_positive_mass(std::size_t b, const model::Snapshot& now) const;

  const System* system_;
  std::vector<Body> bodies_;
  double start_ = -1;    // J, stored at the start; negative: not yet known
  double turnover_ = 0;  // J, sum of |work| of the loads in all steps
  double work_ = 0;      // J, up to the last step
  int beyond_ = 0;       // successive steps with a balance beyond the energy
};

}  // namespace elastogear::dynamics
