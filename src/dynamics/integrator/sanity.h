#pragma once
// Checks that a computed state is one that the theory describes (docs/theory, section 8.5). Private to
// module dynamics.

#include <algorithm>
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
  /// Error when energy came from nowhere: in ten successive steps more than a tenth of what is turned over,
  /// or a hundred times as much at once. docs/theory, section 8.5.
  void require_balance(double time, const model::Energies& now);
  /// J, stored at the start and turned over by loads and motions since: what a balance is to be compared
  /// with.
  double turned_over() const { return std::max(start_, 0.0) + turnover_; }
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
