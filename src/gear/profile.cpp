#include "gear/profile.h"

#include <cmath>

namespace elastogear::gear {

Eigen::Vector2d Profile::point(double c, double r) const {
  return polar ? Eigen::Vector2d(r * std::sin(c), r * std::cos(c)) : Eigen::Vector2d(c, r);
}

double Profile::lateral(const Eigen::Vector2d& x) const { return polar ? std::atan2(x[0], x[1]) : x[0]; }

}  // namespace elastogear::gear
