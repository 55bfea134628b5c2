#pragma once
// Data of contact: settings of a pair, surfaces in motion, and the contacts that are found.

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "elastogear/contact/small_matrix.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::contact {

/// How trees follow the motion. bound: leaf-up from the undeformed surface in its new placement, wider by a
/// bound of the deformation. refit: leaf-up from the deformed surface. realign: k-DOPs rotated by their hull
/// points, wider by the bound.
enum class Update { bound, refit, realign };
enum class Penalty { per_node, per_area };
/// penalty: forces grow with the penetration. unilateral: there is none; gaps are closed by the residual
/// flexibility of the bodies, which one side of the pair must have (docs/theory, section 6.11). augmented:
/// there is none either, between bodies without residual flexibility; gaps close from equilibrium to
/// equilibrium (section 6.14), or no longer close at the end of a step of a motion (section 6.15). automatic:
/// see chosen_law.
enum class ContactLaw { automatic, penalty, unilateral, augmented };
/// What gaps and normals are taken from. facets: the faces as they are. smooth: a smooth surface through
/// their nodes. exact, the default: the heights of a TrueSurface, and the smooth surface where none are
/// known. docs/theory, section 6.8.
enum class ContactSurface { facets, smooth, exact };
/// Points of the slave surface that contact is prevented from passing. nodes: its nodes. minima: its nodes,
/// and the places on its faces and their sides where the gap is least (docs/theory, section 6.12). faces:
/// all points of its faces, in the mean over the faces around each node (section 6.13). automatic: see
/// chosen_points.
/// stations: none; flanks touch at the stations of section 6.18.
enum class SlavePoints { automatic, nodes, minima, faces, stations };
/// regularised: -mu p v_t / sqrt(v_t^2 + v_0^2), for rolling. stick: a spring up to the limit, for
/// standstill.
enum class FrictionLaw { regularised, stick };

/// Coulomb friction; none when mu = 0.
struct FrictionSettings {
  double mu = 0;         ///< -, of sliding nodes
  double mu_static = 0;  ///< -, stick only: of a node that sticks; 0: mu
  FrictionLaw law = FrictionLaw::regularised;
  double v_0 = 0;        ///< m/s, regularised only
  double stiffness = 1;  ///< -, stick only: tangential over normal penalty stiffness
};

struct Settings {
  int k = 24;  ///< k-DOP directions: 6, 14, 18, 24, 26
  Update update = Update::bound;
  ContactLaw law = ContactLaw::automatic;
  SlavePoints points = SlavePoints::automatic;
  Penalty penalty = Penalty::per_area;
  /// per_node: N/m, per_area: Pa/m; 0 = from material and cell size (c_f of both sides in series)
  double stiffness = 0;
  int slave = 0;              ///< which of the two surfaces gives the slave nodes
  bool two_pass = false;      ///< swap the roles in a second pass, half the stiffness each
  double depth = 0;           ///< m, deepest penetration still taken for contact; 0 = from the face size
  double skin = 0;            ///< m, relative motion after which a search is due; 0 = from the face size
  double normal_angle = 100;  ///< deg, slave and master normals must be at least this far apart
  bool full_tangent = true;   ///< with the geometric part; false: normal part only
  double damping = 0;         ///< d_p while approaching; per_node: N s/m, per_area: Pa s/m
  double hysteresis = 0;      ///< s/m, Hunt and Crossley's factor of the penalty force while approaching
  double restitution = 0;     ///< -, 0..1, of impacts of bodies in motion without a penalty
  double offset = 0;          ///< m, added to every gap: > 0 takes overlap out, < 0 backlash
  ContactSurface surface = ContactSurface::exact;
  double feature_angle = 30;  ///< deg, edges that turn by more stay sharp
  FrictionSettings friction;
  double extension = 0.2;  ///< of the master at its surface boundary, as part of a face's length;
                           ///< forces fade out over it
};

/// The law that `automatic` stands for: unilateral where a body of the pair has residual flexibility and no
/// stiffness, damping or hysteresis is given, all of which are those of a penalty; penalty elsewhere. The
/// unilateral law of a pair without residual flexibility is the augmented one.
ContactLaw chosen_law(const Settings& settings, bool has_residual_flexibility);

/// The points that `automatic` stands for: faces where those of the slave are parts of second-order sides,
/// whose nodes alone cannot bear an even pressure; nodes elsewhere and in two passes.
SlavePoints chosen_points(const Settings& settings, const model::Surface& slave);

/// A step of bodies in motion without a penalty: docs/theory, Eq. (6.32).
struct ImpactStep {
  double dt = 0;       ///< s
  double alpha_f = 1;  ///< -, weight of its end in the velocities with which forces are found
};

/// Deformed surface of one body: node positions in the BRF and the BRF's placement.
struct SurfaceState {
  Eigen::Matrix3Xd x_B;  ///< 3 x n_s, m, X + Phi q in the BRF
  Eigen::Vector3d r_WB;  ///< m
  Eigen::Matrix3d R_WB;
};

/// Deformed surface of one body by its elastic coordinates, x_B = X + Phi q, with velocities.
struct SurfaceMotion {
  Eigen::VectorXd q;
  Eigen::Vector3d r_WB;
  Eigen::Matrix3d R_WB;
  Eigen::VectorXd q_dot = {};                        ///< empty: zero
  Eigen::Vector3d v_WB_B = Eigen::Vector3d::Zero();  ///< m/s, of the BRF's origin
  Eigen::Vector3d w_WB_B = Eigen::Vector3d::Zero();  ///< rad/s
};
/// The deformed surface of a motion: docs/theory, Eq. (3.1).
SurfaceState surface_state(const model::Surface& surface, const SurfaceMotion& motion);

/// Residual displacement of the nodes of one surface beside X + Phi q: the part of the static response to
/// contact forces that a basis leaves out. In the BRF; its velocity does not count.
struct ResidualDisplacement {
  std::function<Eigen::Vector3d(int node)> at = {};  ///< m, of a node; empty: nothing
  double largest = 0;                                ///< m, bound for all nodes
  double change = 0;                                 ///< m, bound of any node's change since the last call
};

inline constexpr int kColumns = 17;  ///< most columns of a contact's tangent
inline constexpr int kFewNodes = 8;  ///< of a face of the slave and one of the master
using LocalVectors = SmallMatrix<double, 3, Eigen::Dynamic, 3 * kFewNodes>;
using NodeNumbers = SmallMatrix<int, Eigen::Dynamic, 1, kFewNodes / 2>;
using NodeWeights = SmallMatrix<double, Eigen::Dynamic, 1, kFewNodes / 2>;
using LocalColumns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Eigen::Dynamic, kColumns>;
using LocalStiffness = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kColumns, kColumns>;

/// History of a sticking node from one step to the next: its point on the master, and the stretch of its
/// tangential spring in the face's tangents.
struct StickPoint {
  int slave_side = 0, slave_node = 0;
  int face = 0;
  double u = 0, v = 0;      ///< local coordinates on the master face (contact/face.h)
  double e_u = 0, e_v = 0;  ///< -, stretch e_u dx/du + e_v dx/dv
  bool slides = false;
};

/// Tangential force of a node that sticks, unilateral only, along two directions T normal to n:
/// u + c t = 0 as long as |t| <= mu p, otherwise t = -mu p (u + c t) / |u + c t|. docs/theory, Eq.
/// (6.24a).
struct TangentialForce {
  Eigen::Matrix<double, 3, 2> T;  ///< world frame
  Eigen::Vector2d t;              ///< N, on the slave point
  Eigen::Vector2d u;              ///< m, on the master since the last step, and the stretch of then
  double c = 0;                   ///< m/N
  double mu_static = 0, mu = 0;   ///< -, of a node that sticks (or slides already), and once it slides
  bool slides = false;            ///< is |t| at its limit?
  Eigen::Matrix2d K;              ///< N/m, dt = -K du at unchanged p
  Eigen::Matrix<double, Eigen::Dynamic, 2> F_t, u_x;  ///< -, change of F with t, gradient of u
  Eigen::Matrix2d on_face;                            ///< 1/m, (e_u, e_v) of a stretch along T (StickPoint)
};

/// One active contact: x_slave - x_c = g_n n with the closest point x_c = sum_i N_i x_i of the master
/// surface. On an edge or vertex n has the direction of that line, within the normals of the faces there.
/// The slave point x_slave is a node, or lies on a face between its nodes; of contacts that are integrated
/// over faces all this is a mean over the faces around a slave node. Local vectors are those of the slave's
/// nodes, then of the master's (x y z each, world frame). The local force F changes by
/// dF = -W k (V' dx + V_dot' dv), v the velocities of the local nodes.
struct ContactPoint {
  int slave_side = 0;
  int slave_point = 0;  ///< its number among all points of the slave that may be in contact (SlavePoint)
  int slave_node = 0;   ///< the slave point, or that nearest to it on its face
  NodeNumbers slave_nodes = Eigen::VectorXi::Zero(1);  ///< that F acts on; a triangle's third one twice
  NodeWeights slave_N = Eigen::VectorXd::Ones(1);      ///< their weights in the slave point
  int face = 0;                                        ///< of the master
  NodeNumbers master_nodes;
  NodeWeights N;  ///< their weights in the closest point
  double xi = 0, eta = 0;
  Eigen::Vector3d n;  ///< outward master normal, world frame
  double g_n = 0;     ///< m, < 0 (of an open candidate of the unilateral law: > 0)
  double area = 0;  ///< m^2, share of the undeformed surface, where it is integrated over faces; otherwise 0
  Eigen::Vector3d f;          ///< N, force on the slave point, world frame
  LocalVectors F;             ///< N, forces on the local nodes; they and their moments balance
  double energy = 0;          ///< J, c_p g_n^2 / 2 and that of the tangential spring
  double power = 0;           ///< W, taken by damping
  double friction_power = 0;  ///< W, taken by friction
  double fade = 1;            ///< -, share of the force that is left over a free boundary
  double excess_rate = 0;     ///< m/s, of an impact: of the gap at the end of the step, beyond the least
  double work = 0;  ///< J, taken since the last accepted step by friction that sticks, and by impacts
  Eigen::Vector3d slip =
      Eigen::Vector3d::Zero();  ///< m/s, tangential velocity on the master, where rates count
  Eigen::Vector3d elastic_slip = Eigen::Vector3d::Zero();  ///< m, of the tangential spring
  StickPoint stick;                                        ///< becomes history when the step is accepted
  LocalVectors v;                                          ///< m/s, of the local nodes, where rates count
  double p = 0;                                            ///< N, force along n
  double pressure = 0;  ///< Pa, largest, of a station by H. Hertz; 0: that of the nodes' areas
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< m, of a station, world frame
  double c = 0;      ///< m/N, unilateral only: 0 <= p, 0 <= g_n + c p, one of them 0
  LocalVectors F_p;  ///< -, unilateral or over faces: change of F with p
  LocalVectors g_x;  ///< -, unilateral or over faces: gradient of g_n + c p at this p
  std::optional<TangentialForce> tangential;
  LocalColumns W;
  LocalColumns V = {};  ///< empty where it is W, that is where F has a potential
  LocalColumns V_dot;   ///< no column for forces that do not depend on v
  LocalStiffness k;     ///< N/m

  const LocalColumns& displacement_columns() const { return V.size() > 0 ? V : W; }
  int n_slave() const { return static_cast<int>(slave_nodes.size()); }
  int n_local() const { return n_slave() + static_cast<int>(master_nodes.size()); }
};

/// N, F on the slave's side.
inline Eigen::Vector3d slave_force(const ContactPoint& contact) {
  return contact.F.leftCols(contact.n_slave()).rowwise().sum();
}

}  // namespace elastogear::contact
