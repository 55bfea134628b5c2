#include "elastogear/model/side_shape.h"

namespace elastogear::model {

SideShape side_shape(int n, double xi, double eta) {
  SideShape N(n);
  if (n % 3 == 0) {
    const Eigen::Vector3d L(1 - xi - eta, xi, eta);
    for (int i = 0; i < 3; ++i) N[i] = n == 3 ? L[i] : L[i] * (2 * L[i] - 1);
    for (int i = 3; i < n; ++i) N[i] = 4 * L[i - 3] * L[(i - 2) % 3];
    return N;
  }
  constexpr double kXi[] = {-1, 1, 1, -1, 0, 1, 0, -1}, kEta[] = {-1, -1, 1, 1, -1, 0, 1, 0};
  for (int i = 0; i < n; ++i) {
    const double u = 1 + kXi[i] * xi, v = 1 + kEta[i] * eta;
    if (i < 4)
      N[i] = u * v / 4 * (n == 4 ? 1 : u + v - 3);
    else
      N[i] = kXi[i] == 0 ? (1 - xi * xi) * v / 2 : (1 - eta * eta) * u / 2;
  }
  return N;
}

}  // namespace elastogear::model
