#pragma once
// Points of the slave surface that are not nodes: on a face or one of its sides, on the smooth surface behind
// it (docs/theory, section 6.12).

#include <Eigen/Core>

#include "contact/forces/contact_point.h"

namespace elastogear::contact {

struct SlavePoint {
  int number = 0;  ///< among the slave's nodes, then the edges, then the faces of its topology
  int face = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< (u, v)
  int n_dir = 0;                                 ///< directions in which it moves: face 2, edge 1, node 0
  Eigen::Matrix2d along = Eigen::Matrix2d::Identity();  ///< d(u, v) / dxi of these
};

/// Where a slave point is in one configuration.
struct SlaveGeometry {
  Face face;           ///< the facet
  Eigen::Vector2d at;  ///< (u, v)
  Eigen::Vector3d x;   ///< m, facet plus height
  Eigen::Vector3d e;   ///< m, the height, along the normal of the facet
  Eigen::Vector3d n;   ///< outward unit normal of the facet
  Eigen::Vector4d N;   ///< interpolation functions of the facet
  Eigen::Matrix<double, 4, 2> N_a = Eigen::Matrix<double, 4, 2>::Zero();  ///< dN/dxi
  Eigen::Matrix<double, 3, 2> a = Eigen::Matrix<double, 3, 2>::Zero();    ///< m, dx/dxi
  Eigen::Vector3d a_b[2][2];                                              ///< m, d2x/dxi2
};

/// slave: without extensions. heights: of its faces; empty: facets. The turning of the facet's normal along
/// xi is left out of a.
SlaveGeometry slave_geometry(const SurfaceView& slave, const Heights& heights, const SlavePoint& point);

/// dx/d(u, v) at a corner of a slave face, m.
Eigen::Matrix<double, 3, 2> corner_tangents(const SurfaceView& slave, const Heights& heights, int f,
                                            int corner);

/// Second derivatives of the gap by the xi of the directions that the point has, m; 1 on the diagonal of
/// others.
Eigen::Matrix2d gap_curvature(const SlaveGeometry& geometry, int n_dir, const GapBy<3>& gap);

/// From derivatives by the point and the four nodes of the master's face to those by the four nodes of its
/// own face, which carry it, and the master's.
Eigen::Matrix<double, 3, 24> on_nodes_of_faces(const SlaveGeometry& geometry, const Local3& by_point);

/// The point of a side of the slave that is over the end of the master, with which it moves along its side.
struct Crossing {
  Eigen::Vector2d outward;  ///< gradient by the master's (u, v) of the way across that end
};

/// Change of the way across the end by the 15 local coordinates of the point itself.
LocalRow way_across(const Crossing& crossing, const ProjectionKinematics& kinematics);

/// As spread_over_face, of a point that is over the master's end: the gap there falls along both sides, and
/// the force is normal to both. per_gap: N/m, of a contact with a penalty, else 0.
void spread_crossing(const SlaveGeometry& geometry, const Crossing& crossing, const OpenPoint& open,
                     double per_gap, ContactPoint& contact);

/// From a contact of the point itself, with 15 local coordinates, to one of the four nodes of its face, which
/// carry it. A point that moves with the least gap adds a column for each direction.
void spread_over_face(const SlaveGeometry& geometry, int n_dir, const Gap& gap, ContactPoint& contact);

}  // namespace elastogear::contact
