#include "contact/projection/face_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/projection/closest_point.h"

namespace elastogear::contact {

FaceBoxes face_boxes(const SurfaceView& surface) {
  FaceBoxes boxes{surface.x(Eigen::all, surface.face.row(0)), {}};
  boxes.high = boxes.low;
  for (int f = 0; f < surface.face.cols(); ++f) {
    const Face face = face_of(surface, f);
    auto low = boxes.low.col(f), high = boxes.high.col(f);
    for (int i = 1; i < face.sides; ++i) low = low.cwiseMin(face.x[i]), high = high.cwiseMax(face.x[i]);
    const double extension = *std::max_element(face.extension.begin(), face.extension.end());
    const double reach = 4 * extension * (high - low).norm();
    low.array() -= reach;
    high.array() += reach;
  }
  return boxes;
}

namespace {

double squared_distance(const FaceBoxes& boxes, const Eigen::Vector3d& x, int f) {
  const Eigen::Vector3d out = (boxes.low.col(f) - x).cwiseMax(x - boxes.high.col(f)).cwiseMax(0.0);
  return out.squaredNorm();
}

}  // namespace

double FaceBounds::least(int f, const Eigen::Vector3d& x_B) const {
  return std::max(0.0, std::sqrt(squared_distance(*boxes, x_B, f)) - deformed);
}

bool FaceBounds::is_farther(int f, const Eigen::Vector3d& x_B, double distance) const {
  return contact::is_farther(face_of(undeformed, f), x_B, distance + deformed);
}

double distance(const FaceBoxes& boxes, const Eigen::Vector3d& x, std::span<const int> faces) {
  double least = std::numeric_limits<double>::infinity();
  for (int f : faces) least = std::min(least, squared_distance(boxes, x, f));
  return std::sqrt(least);
}

}  // namespace elastogear::contact
