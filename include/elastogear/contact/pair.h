#pragma once
// Contact of two deformed surfaces: coarse search (k-DOP trees), fine search (closest point, one winner per
// slave node), penalty forces and their consistent tangent.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <memory>
#include <vector>

#include "elastogear/base/tape.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::contact {

/// How trees follow the motion. bound: leaf-up from the undeformed surface in its new placement, wider by a
/// bound of the deformation. refit: leaf-up from the deformed surface. realign: k-DOPs rotated by their hull
/// points, wider by the bound.
enum class Update { bound, refit, realign };
enum class Penalty { per_node, per_area };

struct Settings {
  int k = 24;  ///< k-DOP directions: 6, 14, 18, 24, 26
  Update update = Update::bound;
  Penalty penalty = Penalty::per_area;
  /// per_node: N/m, per_area: Pa/m; 0 = from material and cell size (c_f of both sides in series)
  double stiffness = 0;
  int slave = 0;              ///< which of the two surfaces gives the slave nodes
  bool two_pass = false;      ///< swap the roles in a second pass, half the stiffness each
  double depth = 0;           ///< m, deepest penetration still taken for contact; 0 = from the face size
  double skin = 0;            ///< m, relative motion after which a search is due; 0 = from the face size
  double normal_angle = 100;  ///< deg, slave and master normals must be at least this far apart
  bool full_tangent = true;   ///< with the geometric part; false: normal part only
  double extension = 0.025;   ///< by which open ends of the master are prolonged, share of a face's length
};

/// Deformed surface of one body: node positions in the BRF and the BRF's placement.
struct SurfaceState {
  Eigen::Matrix3Xd x_B;  ///< 3 x n_s, m, X + Phi q in the BRF
  Eigen::Vector3d r_WB;  ///< m
  Eigen::Matrix3d R_WB;
};

/// The same by elastic coordinates: x_B = X + Phi q.
struct SurfaceMotion {
  Eigen::VectorXd q;
  Eigen::Vector3d r_WB;
  Eigen::Matrix3d R_WB;
};
SurfaceState surface_state(const model::Surface& surface, const SurfaceMotion& motion);

/// One active contact: x_slave - x_c = g_n n with the closest point x_c = sum_i N_i x_i of the master
/// surface. On an edge or vertex n has the direction of that line, within the normals of the faces there.
/// Local vectors have 15 rows: slave node, then the four master nodes (x y z each, world frame). Local force
/// F = -c_p g_n [n; -N_i n]; tangent dF = -W k W' dx.
struct ContactPoint {
  int slave_side = 0;
  int slave_node = 0;
  int face = 0;
  Eigen::Vector4i master_node;
  Eigen::Vector4d N;  ///< master shape functions at the closest point
  double xi = 0, eta = 0;
  Eigen::Vector3d n;  ///< outward master normal, world frame
  double g_n = 0;     ///< m, < 0
  Eigen::Vector3d f;  ///< N, force on the slave node, world frame
  double energy = 0;  ///< J, c_p g_n^2 / 2
  Eigen::Matrix<double, 15, Eigen::Dynamic, 0, 15, 5> W;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 5, 5> k;  ///< symmetric, N/m
};

/// Two surfaces in contact, with their trees and the faces found last. The surfaces must outlive the pair.
class Pair {
 public:
  /// K_r of both bodies serve the bounds of the deformation and may be left out. Throws Error for settings
  /// out of range and for surfaces that are empty, inconsistent or not finite.
  Pair(const model::Surface& a, const model::Surface& b, const Settings& settings,
       const std::array<const Eigen::SparseMatrix<double>*, 2>& K_r = {});
  ~Pair();
  Pair(Pair&&) noexcept;

  /// Active contacts in the given configuration, ordered by pass and slave node (deterministic).
  /// Throws Error when a surface has non-finite positions.
  std::vector<ContactPoint> detect(const SurfaceState& a, const SurfaceState& b);
  /// The same contacts, but only nodes that can touch are displaced, and a search is made only when the
  /// surfaces have moved by the skin since the last one.
  std::vector<ContactPoint> detect(const SurfaceMotion& a, const SurfaceMotion& b);

  /// The settings in force: as given, with stiffness, depth and skin filled in where they were 0.
  const Settings& settings() const;
  /// Searches made so far, and nodes displaced in the last call of detect.
  int n_searches() const;
  int n_displaced() const;

  /// All that later calls of detect (by motion) take from earlier ones.
  void visit_memory(Tape& tape);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace elastogear::contact
