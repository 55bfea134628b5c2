#include "contact/projection/node_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace elastogear::contact {
namespace {

using Eigen::Vector3d;

constexpr int kRings = 3;              // of faces around a node: a cubic needs four nodes on one side of it
constexpr int kPatchNodes = 16;        // nodes beside the node itself; a cubic has nine coefficients
constexpr double kFacing = 0.5;        // least cosine between normals of faces and of the node
constexpr double kIndependent = 0.03;  // share of a column that its predecessors do not explain

Vector3d corner_normal(const Face& face, int corner) {
  Face plain = face;
  plain.extension = {};
  const Eigen::Vector2d at = extended_corner(plain, corner);
  return normal(face, at[0], at[1]);
}

// Node numbers with the corners of the faces there, and marks of what a patch holds.
struct PatchFinder {
  const SurfaceView& surface;
  double least_cosine;                  // of the turn from face to face
  std::vector<CornerNormals> own = {};  // of each face alone
  std::vector<int> face_mark = {}, node_mark = {};
  int mark = 0;
};

PatchFinder patch_finder(const SurfaceView& surface, double feature_angle) {
  PatchFinder finder{surface, std::cos(feature_angle)};
  for (int f = 0; f < surface.face.cols(); ++f) {
    const Face face = face_of(surface, f);
    CornerNormals normals = CornerNormals::Zero();
    for (int c = 0; c < face.sides; ++c) normals.col(c) = corner_normal(face, c);
    finder.own.push_back(normals);
  }
  finder.face_mark.assign(finder.own.size(), 0);
  finder.node_mark.assign(static_cast<std::size_t>(surface.x.cols()), 0);
  return finder;
}

// The faces at a node that turn by less than the feature angle against the normal n, as 4 face + corner.
std::vector<int> faces_beside(const PatchFinder& finder, int node, const Vector3d& n) {
  std::vector<int> beside;
  for (int entry : finder.surface.topology.node_corners[node])
    if (finder.own[entry / 4].col(entry % 4).dot(n) >= finder.least_cosine) beside.push_back(entry);
  return beside;
}

Vector3d averaged_normal(const PatchFinder& finder, const std::vector<int>& beside) {
  Vector3d sum = Vector3d::Zero();
  for (int entry : beside)
    sum += corner_angle(face_of(finder.surface, entry / 4), entry % 4) * finder.own[entry / 4].col(entry % 4);
  return sum.stableNormalized();
}

// Adds the faces around node p that go on smoothly from those of the patch there.
void grow(PatchFinder& finder, int p, const Vector3d& n, std::vector<int>& faces) {
  const auto corners = finder.surface.topology.node_corners[p];
  for (int entry : corners) {
    if (finder.face_mark[entry / 4] == finder.mark) continue;
    const Vector3d there = finder.own[entry / 4].col(entry % 4);
    const bool smooth = std::any_of(corners.begin(), corners.end(), [&](int other) {
      return finder.face_mark[other / 4] == finder.mark &&
             finder.own[other / 4].col(other % 4).dot(there) >= finder.least_cosine;
    });
    if (smooth && there.dot(n) >= kFacing) faces.push_back(entry / 4);
  }
}

// Marks the faces and returns their nodes that were not marked.
std::vector<int> take(PatchFinder& finder, const std::vector<int>& faces) {
  std::vector<int> nodes;
  for (int f : faces) {
    finder.face_mark[f] = finder.mark;
    for (int c = 0; c < side_count(finder.surface.face, f); ++c) {
      const int node = finder.surface.face(c, f);
      if (finder.node_mark[node] == finder.mark) continue;
      finder.node_mark[node] = finder.mark;
      nodes.push_back(node);
    }
  }
  return nodes;
}

// The nodes near a node, without itself.
std::vector<int> nodes_near(PatchFinder& finder, int node, const std::vector<int>& beside,
                            const Vector3d& n) {
  ++finder.mark;
  finder.node_mark[node] = finder.mark;
  std::vector<int> faces;
  for (int entry : beside) faces.push_back(entry / 4);
  std::vector<int> ring = take(finder, faces), all = ring;
  for (int i = 1; i < kRings && static_cast<int>(all.size()) < kPatchNodes; ++i) {
    faces.clear();
    for (int p : ring) grow(finder, p, n, faces);
    ring = take(finder, faces);
    all.insert(all.end(), ring.begin(), ring.end());
  }
  return all;
}

// x, y, x^2, xy, ..., y^3
Eigen::Matrix<double, 9, 1> monomials(double x, double y) {
  return (Eigen::Matrix<double, 9, 1>() << x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y,
          y * y * y)
      .finished();
}

// A polynomial fitted to points, A c = z in the least squares: columns are made orthogonal one after the
// other, twice; those that their predecessors explain are left out.
struct Fit {
  std::vector<int> kept;                   // columns of A
  std::array<double, 9> coefficient = {};  // of these, in their order
};

Fit fit(Eigen::Matrix<double, Eigen::Dynamic, 9> A, Eigen::VectorXd z) {
  Fit result;
  Eigen::Matrix<double, 9, 9> R = Eigen::Matrix<double, 9, 9>::Zero();
  Eigen::Matrix<double, 9, 1> y;
  int n = 0;  // of columns kept, which lie first in A
  for (int i = 0; i < A.cols() && n < A.rows(); ++i) {
    const double size = A.col(i).norm();
    for (int pass : {0, 1})
      for (int j = 0; j < n; ++j) {
        const double part = A.col(j).dot(A.col(i));
        R(j, n) = pass == 0 ? part : R(j, n) + part;
        A.col(i) -= part * A.col(j);
      }
    R(n, n) = A.col(i).norm();
    if (!(R(n, n) > kIndependent * size)) continue;
    A.col(n) = A.col(i) / R(n, n);
    y[n] = A.col(n).dot(z);
    z -= y[n] * A.col(n);
    result.kept.push_back(i);
    ++n;
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) y[i] -= R(i, j) * result.coefficient[j];
    result.coefficient[i] = y[i] / R(i, i);
  }
  return result;
}

// Normal of the polynomial z(x, y) through x_0 that comes nearest to the points, weighted with their inverse
// distances: X. Jiao and H. Zha, Proc. ACM Symp. Solid and Physical Modeling 2008, 159-170. z stands along n.
// Zero where the points do not determine it.
Vector3d fitted_normal(const Vector3d& x_0, const Eigen::Matrix3Xd& points, const Vector3d& n) {
  const Vector3d t_1 = n.unitOrthogonal(), t_2 = n.cross(t_1);
  const Eigen::Matrix3Xd d = points.colwise() - x_0;
  const double size = std::sqrt(d.colwise().squaredNorm().mean());
  Eigen::Matrix<double, Eigen::Dynamic, 9> A(d.cols(), 9);
  Eigen::VectorXd z(d.cols());
  for (Eigen::Index i = 0; i < d.cols(); ++i) {
    const double weight = size * size / d.col(i).squaredNorm();
    A.row(i) = weight * monomials(t_1.dot(d.col(i)) / size, t_2.dot(d.col(i)) / size).transpose();
    z[i] = weight * n.dot(d.col(i)) / size;
  }
  const auto [kept, slope] = fit(std::move(A), std::move(z));
  if (kept.size() < 2 || kept[1] != 1) return Vector3d::Zero();
  return (n - slope[0] * t_1 - slope[1] * t_2).normalized();
}

Vector3d smooth_normal(PatchFinder& finder, int node, const std::vector<int>& beside) {
  const Vector3d mean = averaged_normal(finder, beside);
  if (mean.isZero(0)) return mean;
  const std::vector<int> near = nodes_near(finder, node, beside, mean);
  const Vector3d fitted = fitted_normal(finder.surface.x.col(node), finder.surface.x(Eigen::all, near), mean);
  return fitted.dot(mean) >= finder.least_cosine ? fitted : mean;
}

}  // namespace

std::vector<CornerNormals> corner_normals(const SurfaceView& surface, double feature_angle) {
  PatchFinder finder = patch_finder(surface, feature_angle);
  std::vector<CornerNormals> normals(finder.own.size(), CornerNormals::Zero());
  for (int node = 0; node < surface.x.cols(); ++node) {
    std::vector<int> last;  // most nodes have one normal on all their faces
    Vector3d n = Vector3d::Zero();
    for (int entry : surface.topology.node_corners[node]) {
      const Vector3d own = finder.own[entry / 4].col(entry % 4);
      if (own.isZero(0)) continue;
      std::vector<int> beside = faces_beside(finder, node, own);
      if (beside != last) n = smooth_normal(finder, node, beside);
      last = std::move(beside);
      normals[entry / 4].col(entry % 4) = n;
    }
  }
  return normals;
}

}  // namespace elastogear::contact
