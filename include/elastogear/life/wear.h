#pragma once
// Worn depth of a flank by Archard's law, in the flank's own coordinates (docs/life.md). The law, h' = k p v,
// holds at each point of a surface; its integral over what a contact passes is the volume k F s, with the
// normal force F and the sliding distance s, whatever the pressure. Volumes are therefore laid where a
// contact has been, and the depth is that of the volume over the area: it depends on no mesh.

#include <Eigen/Core>

namespace elastogear::life {

/// Cells over a flank: u along the profile, v along the face.
struct FlankCells {
  Eigen::VectorXd u, v;    ///< n_u + 1, n_v + 1, m, edges, increasing
  Eigen::VectorXd length;  ///< n_u, m, along the surface across each cell of u

  Eigen::Index n_u() const { return length.size(); }
  Eigen::Index n_v() const { return v.size() - 1; }
};

/// Cells of equal size between these ends. arc: length along the surface up to u, increasing.
template <class Arc>
FlankCells flank_cells(Eigen::Vector2d u, Eigen::Vector2d v, int n_u, int n_v, const Arc& arc) {
  FlankCells cells{Eigen::VectorXd::LinSpaced(n_u + 1, u[0], u[1]),
                   Eigen::VectorXd::LinSpaced(n_v + 1, v[0], v[1]), Eigen::VectorXd(n_u)};
  for (int i = 0; i < n_u; ++i) cells.length[i] = arc(cells.u[i + 1]) - arc(cells.u[i]);
  return cells;
}

/// Where a contact has been in one step of the motion.
struct ContactTrack {
  double u[2] = {0, 0}, v[2] = {0, 0};  ///< m, ends along both coordinates
};

/// Adds a volume (m^3) evenly over the track, in the surface's coordinates; what lies beyond the cells goes
/// to those at their ends, so that nothing is lost.
void lay_volume(const FlankCells& cells, const ContactTrack& track, double volume, Eigen::MatrixXd& sum);

/// Volume (n_u x n_v, m^3) over the area of each cell, m.
Eigen::MatrixXd depth(const FlankCells& cells, const Eigen::MatrixXd& volume);

/// Length of an involute from its base circle (radius r_b, m) to the length of roll u, m: u^2 / (2 r_b).
double involute_arc(double u, double r_b);

}  // namespace elastogear::life
