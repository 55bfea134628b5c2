#include "gear/profile.h"

#include <cmath>

namespace elastogear::gear {

Eigen::Vector2d Profile::point(double c, double r) const {
  const double y = inwards ? -r : r;
  return polar ? Eigen::Vector2d(r * std::sin(c), y * std::cos(c)) : Eigen::Vector2d(c, r);
}

double Profile::lateral(const Eigen::Vector2d& x) const {
  return polar ? std::atan2(x[0], inwards ? -x[1] : x[1]) : x[0];
}

}  // namespace elastogear::gear
