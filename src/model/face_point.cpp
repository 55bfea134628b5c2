#include "elastogear/model/face_point.h"

namespace elastogear::model {

Eigen::Vector4d face_shares(double xi, double eta) {
  return 0.25 * Eigen::Vector4d((1 - xi) * (1 - eta), (1 + xi) * (1 - eta), (1 + xi) * (1 + eta),
                                (1 - xi) * (1 + eta));
}

Eigen::Vector3d point_on_face(const Surface& surface, int face, double xi, double eta) {
  return surface.X(Eigen::all, surface.face.col(face)) * face_shares(xi, eta);
}

}  // namespace elastogear::model
