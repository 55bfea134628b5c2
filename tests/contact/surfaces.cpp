#include "surfaces.h"

#include <map>

namespace elastogear::contact::test {

model::Surface cube(int n, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map) {
  std::map<std::array<int, 3>, int> number;
  std::vector<Eigen::Vector3d> points;
  const auto node = [&](const std::array<int, 3>& p) {
    const auto [entry, is_new] = number.try_emplace(p, static_cast<int>(points.size()));
    if (is_new) points.push_back(map(Eigen::Vector3d(p[0], p[1], p[2]) * 2 / n - Eigen::Vector3d::Ones()));
    return entry->second;
  };
  std::vector<Eigen::Vector4i> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (int end : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          Eigen::Vector4i f;
          const int di[4] = {0, 1, 1, 0}, dj[4] = {0, 0, 1, 1};
          for (int c = 0; c < 4; ++c) {
            std::array<int, 3> p;
            p[axis] = end, p[(axis + 1) % 3] = i + di[c], p[(axis + 2) % 3] = j + dj[c];
            f[end == 0 ? 3 - c : c] = node(p);
          }
          faces.push_back(f);
        }
  model::Surface s;
  s.X.resize(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) s.X.col(i) = points[i];
  s.face.resize(4, faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) s.face.col(i) = faces[i];
  s.c_f = Eigen::VectorXd::Constant(s.face.cols(), 1e12);
  return s;
}

}  // namespace elastogear::contact::test
