#pragma once
// Smooth loads of fixed stations at a grid of places across the profile. Loads in between are interpolated,
// and so is all that is bilinear in them, exactly (docs/theory, section 6.18).

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <functional>
#include <vector>

#include "elastogear/contact/station_places.h"

namespace elastogear::contact {

struct FlankGrid;

/// Half widths of a smooth load across the profile and along the face, m. Eq. (6.43).
struct LoadWidth {
  double a, c;
};

/// Weights of four neighbouring places of the grid: the cubics of E. Catmull and R. Rom, which sum to 1 and
/// keep the centroid of loads.
struct Stencil {
  int first = 0;
  std::array<double, 4> N{}, dN{};  ///< -, 1/m
};

/// Loads on n strips of all flanks of one side of a body, at n_v places each, Eq. (6.51). Row i n_v + g:
/// strip i at the place g. Each strip bears the forces of `pieces` stations, which are equal pieces of it.
struct LoadTable {
  std::vector<Strip> strips;  ///< m, of the face, side by side
  int pieces = 1;
  double v_0 = 0, step = 0;  ///< m, places v_0 + g step
  int n_v = 0;
  LoadWidth width{};
  double q = 0;                                    ///< m, half width of pressures on the half-space
  LineScale scale;                                 ///< in the middle of the flank
  Eigen::SparseMatrix<double, Eigen::RowMajor> W;  ///< n n_v x nodes: forces of 1 N on each strip alone
  Eigen::MatrixXd Z;                               ///< stations x n: spread along the face. Eq. (6.45)
  Eigen::MatrixXd smooth;                          ///< n n_v x n n_v, 1/m: half-space below. Eq. (6.46)
  Eigen::MatrixXd line;  ///< stations x stations, 1/m: of pressures of the half width q

  int n() const { return static_cast<int>(strips.size()); }
};

/// Stations: equal pieces of each strip.
std::vector<Strip> pieces_of(const std::vector<Strip>& strips, int pieces);
/// slope: dv/dz of lines of contact at v. Strips have one length. q: m.
LoadTable load_table(const FlankGrid& flank, const std::vector<Strip>& strips, int pieces,
                     const std::function<double(double v)>& slope, const LineScale& scale, double q);

/// At the place v, m; beyond the ends of the flank that of the end.
Stencil stencil(const LoadTable& table, double v);

/// Among stations, 1/m: the half-space below loads of strips at these places, spread along the face.
Eigen::MatrixXd smooth_kernel(const LoadTable& table, const std::vector<Stencil>& at);

/// n x nodes: nodal forces of 1 N on each strip alone.
Eigen::MatrixXd weights(const LoadTable& table, const std::vector<Stencil>& at);

/// m/N: displacement of node a by unit forces on node b, of the whole body.
using NodalResponse = std::function<Eigen::Matrix3d(int a, int b)>;
/// 3 n n_v x 3 n n_v, m/N: static responses at the places of one flank to unit forces at those of another
/// one, whose tables' nodes are these; x, y and z of each place after each other.
Eigen::MatrixXd response_table(const LoadTable& a, const std::vector<int>& nodes_a, const LoadTable& b,
                               const std::vector<int>& nodes_b, const NodalResponse& response);
/// m/N: among stations on strips at these places with these directions, 3 x n, from their response_table.
Eigen::MatrixXd responses(const LoadTable& a, const std::vector<Stencil>& at_a,
                          const Eigen::Matrix3Xd& direction_a, const LoadTable& b,
                          const std::vector<Stencil>& at_b, const Eigen::Matrix3Xd& direction_b,
                          const Eigen::MatrixXd& table);

/// Displacements at n strips on one body.
struct StationDisplacements {
  Eigen::Matrix3Xd u;    ///< m
  Eigen::Matrix3Xd u_v;  ///< -, by how much they grow with the place v of the station
};
/// Adds those of a loaded flank, by the forces of b's strips, 3 x n, N.
void add_responses(const LoadTable& a, const std::vector<Stencil>& at_a, const LoadTable& b,
                   const std::vector<Stencil>& at_b, const Eigen::Matrix3Xd& force_b,
                   const Eigen::MatrixXd& table, StationDisplacements& displacements);
/// Those by displacements of the nodes, 3 x nodes, m.
StationDisplacements displacements(const LoadTable& table, const std::vector<Stencil>& at,
                                   const Eigen::Matrix3Xd& of_nodes);
/// N/m^2: by how much the displacement of the half-space below forces of strips, N, grows with the place of
/// each station; over the compliance of the body, 1/Pa.
Eigen::VectorXd smooth_slopes(const LoadTable& table, const std::vector<Stencil>& at,
                              const Eigen::VectorXd& force);

}  // namespace elastogear::contact
