#include "elastogear/life/wear.h"

#include <algorithm>
#include <cmath>

namespace elastogear::life {
namespace {

// Shares of [from, to] in the intervals between the edges; what lies beyond is in the first and the last one.
Eigen::VectorXd shares(const Eigen::VectorXd& edges, double from, double to) {
  const Eigen::Index n = edges.size() - 1;
  if (from > to) std::swap(from, to);
  Eigen::VectorXd share = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double low = i == 0 ? -INFINITY : edges[i], high = i + 1 == n ? INFINITY : edges[i + 1];
    if (to > from)
      share[i] = std::max(0.0, std::min(to, high) - std::max(from, low)) / (to - from);
    else
      share[i] = from >= low && from < high ? 1 : 0;
  }
  return share;
}

}  // namespace

void lay_volume(const FlankCells& cells, const ContactTrack& track, double volume, Eigen::MatrixXd& sum) {
  sum +=
      volume * shares(cells.u, track.u[0], track.u[1]) * shares(cells.v, track.v[0], track.v[1]).transpose();
}

Eigen::MatrixXd depth(const FlankCells& cells, const Eigen::MatrixXd& volume) {
  Eigen::MatrixXd depth = volume;
  for (Eigen::Index i = 0; i < cells.n_u(); ++i)
    for (Eigen::Index j = 0; j < cells.n_v(); ++j)
      depth(i, j) /= cells.length[i] * (cells.v[j + 1] - cells.v[j]);
  return depth;
}

double involute_arc(double u, double r_b) { return u * u / (2 * r_b); }

}  // namespace elastogear::life
