#pragma once
// Contents of a body file: all that dynamics, contact and recovery need of one elastic body. Immutable once
// built. SI units; all vectors in the body reference frame (BRF), which is the mesh's frame.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "elastogear/model/flexibility.h"
#include "elastogear/model/lazy_rows.h"
#include "elastogear/model/viscoelastic.h"

namespace elastogear::model {

/// modal: eigenmodes of the restrained body. full: unit basis, every free finite-element degree of freedom.
enum class Basis { modal, full };

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
/// Dense or lazy: reduced bases, lazy only at surface nodes; sparse: full basis.
using BasisRows = std::variant<DenseRows, SparseRows, LazyRows>;

Eigen::Index row_count(const BasisRows& rows);
Eigen::Index column_count(const BasisRows& rows);
/// All rows of a reduced basis, which are read where they are not yet; null for those of the full basis.
const DenseRows* dense_rows(const BasisRows& rows);
/// Of rows that may not have been read; or null.
const RowBounds* known_bounds(const BasisRows& rows);
/// The three rows of a node one after the other, of a reduced basis.
const double* node_rows(const BasisRows& Phi, int node);
/// Calls `use` with all rows, dense or sparse, and returns what it returns.
template <class Use>
auto with_rows(const BasisRows& rows, const Use& use) {
  if (const auto* sparse = std::get_if<SparseRows>(&rows)) return use(*sparse);
  return use(*dense_rows(rows));
}
/// rows * q
Eigen::VectorXd multiply(const BasisRows& rows, const Eigen::VectorXd& q);
/// rows' * x
Eigen::VectorXd multiply_transposed(const BasisRows& rows, const Eigen::VectorXd& x);
/// (Phi q) at one node: rows 3 node .. 3 node + 2
Eigen::Vector3d displacement(const BasisRows& Phi, int node, const Eigen::VectorXd& q);
/// h += Phi(node)' f
void add_force(const BasisRows& Phi, int node, const Eigen::Vector3d& f, Eigen::Ref<Eigen::VectorXd> h);

/// Inertia of the free node cloud, from the consistent mass M_f (restrained nodes carry mass too).
/// S_t, S_r: rigid unit translations and rotations about the BRF origin.
/// docs/theory, Eqs. (3.4) and (3.8).
struct Inertia {
  double m = 0;                                  ///< kg, m I = S_t' M_f S_t
  Eigen::Vector3d c = Eigen::Vector3d::Zero();   ///< m, centre of mass
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();   ///< kg m^2, about the BRF origin, S_r' M_f S_r
  Eigen::Matrix<double, Eigen::Dynamic, 3> C_l;  ///< n_q x 3, Phi' M_f S_t
  Eigen::Matrix<double, Eigen::Dynamic, 3> C_r;  ///< n_q x 3, Phi' M_f S_r
  Eigen::Matrix<double, 9, Eigen::Dynamic> S_1;  ///< 9 x n_q, row 3a+b: integral of rho X_a phi_b dV
  /// n_q x n_q each, [k, l]: integral of rho phi_ka phi_lb dV for ab = 11 22 33 12 23 13; may be empty (only
  /// inertia level full needs it). Their counterparts ba are the transposes. docs/theory, Eq. (3.11a).
  std::vector<BasisRows> S_2;
};

/// First-order change of J with the elastic coordinate k: J(q) = J + sum_k q_k J_1(k), from S_1.
/// docs/theory, Eq. (3.11).
Eigen::Matrix3d J_1(const Inertia& inertia, int k);

struct Surface {
  std::vector<int> node;  ///< n_s, mesh numbers of the surface's nodes, ascending
  Eigen::Matrix3Xd X;     ///< 3 x n_s, m
  Eigen::Matrix4Xi face;  ///< 4 x n_f, local node numbers (0..n_s-1), counter-clockwise from outside;
                          ///< a triangle repeats its third node
  /// 8 x n_f, the nodes of the second-order side that a face is a part of: corners, then midside nodes, the
  /// first between corners 0 and 1; -1 in what is left, and for linear cells. Without columns: all linear.
  Eigen::Matrix<int, 8, Eigen::Dynamic> side = {};
  std::vector<int> group;               ///< n_f, index into group_name
  std::vector<std::string> group_name;  ///< face sets ("tooth_07_left"): the "areas of contact"
  Eigen::VectorXd c_f;                  ///< n_f, Pa/m, stiffness E A / V of the cell behind each face
  BasisRows Phi;                        ///< 3 n_s x n_q
};

struct Stress {
  std::vector<int> node;                         ///< n_e, mesh numbers of the evaluation nodes, ascending
  Eigen::Matrix3Xd X;                            ///< 3 x n_e, m
  std::map<std::string, std::vector<int>> sets;  ///< name -> local numbers (0..n_e-1)
  BasisRows Psi;                                 ///< 6 n_e x n_q, Pa per q, order xx yy zz xy yz xz
};

/// Name of the marker that every body has without storing it: its frame.
inline constexpr const char* kFrameMarker = "frame";

/// The area of faces along their normals, in the BRF.
struct AreaVector {
  Eigen::Vector3d sum;     ///< m^2
  Eigen::Vector3d moment;  ///< m^3, about the origin
};

/// A place on the body that moves with the mean of a node set: loads, bushings and sensors act there. Or what
/// a pressure on a face set acts on: the volume that the faces sweep is the first row of Phi, the others are
/// zero.
struct Marker {
  std::string name;    ///< of the set; of a pressure pressure_marker
  Eigen::Vector3d X;   ///< m, mean reference position
  bool turns = true;   ///< has a rotation; not when the set lies on one line
  BasisRows Phi = {};  ///< 6 x n_q: mean displacement, mean small rotation (rad); zero where it does not turn
  std::optional<AreaVector> area = {};  ///< of a pressure
};

/// Name of the marker of a pressure on a face set.
inline std::string pressure_marker(const std::string& set) { return set + ":pressure"; }

/// A part of a body's stiffness that relaxes, that of one material region by both moduli or by one of them.
/// The elastic force is K_r q - sum_p K sum_i g_i z_i with z_i' = (q - z_i)/tau_i: docs/theory, Eq.
/// (2.19).
struct RelaxingPart {
  std::string cell_set;  ///< of the region; empty: all cells that no other region names
  ModulusPart part = ModulusPart::both;
  Eigen::VectorXd g;    ///< n_i, -, relative moduli
  Eigen::VectorXd tau;  ///< n_i, s, relaxation times at the temperature of the region
  Eigen::SparseMatrix<double> K =
      {};                             ///< n_q x n_q, instantaneous stiffness of the part, in the units of K_r
  std::vector<int> stress_node = {};  ///< evaluation nodes (local numbers) whose stress is that of the region
};

/// Displacements u = Phi q and the reduced matrices M_r, K_r: docs/theory, Eqs. (2.1) and (2.2).
struct ElasticBody {
  std::string name;
  Basis basis = Basis::modal;
  bool floating = false;  ///< nothing was restrained: the basis moves about a frame that no node carries
  Inertia inertia;
  /// The last coordinates, of attachment modes: what the modes leave out of the static responses to loads at
  /// markers. They are no vibrations of the body. docs/theory, section 2.10.
  int n_attachments = 0;
  Eigen::VectorXd frequency;             ///< modal: n_q, Hz, ascending but for attachments; empty for full
  Eigen::SparseMatrix<double> M_r, K_r;  ///< n_q x n_q; modal: identity and diag(omega^2); K_r instantaneous
  /// Are K_r and M_r those of the finite elements of the body's mesh alone? False of matrices of other
  /// programs, of M_r with point masses, and where a file does not say it.
  bool assembled_K = true, assembled_M = true;
  double alpha = 0, beta = 0;  ///< 1/s, s: Rayleigh's part of D_r, alpha M_r + beta K_r
  Eigen::VectorXd zeta;        ///< modal: n_q, ratios: D_r also has diag(2 zeta omega); or empty
  Surface surface;
  Stress stress;
  std::vector<Marker> markers;
  Flexibility flexibility = {};  ///< of a modal basis, when it was asked for; or empty. G stays in the file
  std::vector<RelaxingPart> relaxing = {};        ///< of viscoelastic materials
  std::map<std::string, std::string> provenance;  ///< options in force, program and library versions

  Eigen::Index n_q() const { return K_r.rows(); }
  /// Coordinates that are no attachment modes.
  Eigen::Index n_modes() const { return n_q() - n_attachments; }
};

/// Throws Error naming `source` when shapes disagree, numbers are not finite, the inertia is not positive or
/// node numbers are out of range.
void validate(const ElasticBody& body, const std::string& source);

}  // namespace elastogear::model
