#include "contact/forces/friction.h"

#include <algorithm>
#include <cmath>

namespace elastogear::contact {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Friction regularised(const Vector3d& z, double v_0, double limit) {
  Friction f;
  const double s = std::sqrt(z.squaredNorm() + v_0 * v_0);
  f.direction = z / s;
  f.K = limit / s * (Matrix3d::Identity() - f.direction * f.direction.transpose());
  return f;
}

Friction sticking(const Vector3d& z, double c_t, double limit) {
  Friction f;
  const double length = z.norm();
  f.at_limit = c_t * length > limit;
  if (f.at_limit) {
    f.direction = z / length;
    f.K = limit / length * (Matrix3d::Identity() - f.direction * f.direction.transpose());
  } else {
    f.direction = limit > 0 ? Vector3d(c_t / limit * z) : Vector3d(Vector3d::Zero());
    f.K = c_t * Matrix3d::Identity();
  }
  return f;
}

Friction given_friction(const Vector3d& t, const Vector3d& u, double c, double limit, bool slides) {
  Friction f;
  f.at_limit = slides;
  f.direction = limit > 0 ? Vector3d(-t / limit) : Vector3d(Vector3d::Zero());
  if (slides)
    f.K = limit / std::max(u.norm(), c * limit) *
          (Matrix3d::Identity() - f.direction * f.direction.transpose());
  else
    f.K = Matrix3d::Identity() / c;
  return f;
}

}  // namespace elastogear::contact
