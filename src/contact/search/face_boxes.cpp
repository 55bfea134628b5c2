#include "contact/search/face_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

double distance(const FaceBoxes& boxes, const Eigen::Vector3d& x, std::span<const int> faces) {
  double least = std::numeric_limits<double>::infinity();
  for (int f : faces) {
    const Eigen::Vector3d out = (boxes.low.col(f) - x).cwiseMax(x - boxes.high.col(f)).cwiseMax(0.0);
    least = std::min(least, out.squaredNorm());
  }
  return std::sqrt(least);
}

}  // namespace elastogear::contact
