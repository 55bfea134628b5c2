#pragma once
// From a mesh to a body file: partition, assembly, eigenmodes, inertia, stress modes, surface.

#include <mpi.h>

#include <Eigen/Core>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/base/progress.h"
#include "elastogear/io/precision.h"
#include "elastogear/mesh/mesh.h"
#include "elastogear/model/check.h"
#include "elastogear/model/damping.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/model/material.h"
#include "elastogear/reduction/flexibility.h"
#include "elastogear/reduction/imported.h"
#include "elastogear/reduction/interval.h"
#include "elastogear/reduction/marker.h"
#include "elastogear/reduction/ritz_options.h"

namespace elastogear::reduction {

/// surface: at the nodes of the contact surface and, as stress modes, at the stress nodes: all that
/// simulation and stress histories need. all: at every node, for whole fields.
enum class Store { surface, all };

/// linear: what inertia levels constant and linear need. full: S_2 too (docs/theory, Eq. (3.11a)).
enum class Invariants { linear, full };

/// Modes from one sector where the mesh, materials and restraint repeat around an axis, or from the whole
/// body.
enum class Symmetry { automatic, none };

/// Stresses at nodes: means of the cells, or from the strains of free surfaces (model::RecoveryMethod).
/// automatic: of free surfaces, but means where shear and bulk modulus relax apart.
enum class RecoveryChoice { automatic, average, surface };

struct ReductionOptions {
  std::string name = {};                            ///< of the body
  std::vector<model::MaterialRegion> regions = {};  ///< the empty cell set: all cells no other region names
  model::Element element = model::Element::incompatible;
  model::ElementMass element_mass = model::ElementMass::compatible;  ///< of incompatible hex8
  std::vector<std::string> restrain = {};      ///< node or face sets, "left:xy" in these directions only
  std::optional<ImportedFiles> imported = {};  ///< K and M from files; a mesh without cells will do
  bool floating = false;                       ///< a free body: `restrain` stays empty, free-free modes
  bool frame_at_center = false;                ///< body frame at the centre of mass
  Eigen::Vector3d frame_origin = {0, 0, 0};    ///< m, of the body frame in the mesh's coordinates otherwise
  std::vector<std::string> surface = {};       ///< face sets, see reduction/surface.h
  std::vector<std::string> stress_nodes = {};  ///< node sets, or face sets for their nodes
  RecoveryChoice stress_recovery = RecoveryChoice::automatic;
  std::vector<std::string> markers = {};  ///< node or face sets, see reduction/marker.h
  model::Basis basis = model::Basis::modal;
  int n_modes = 100;                      ///< modal only
  std::optional<Interval> interval = {};  ///< all eigenmodes in it, in place of the n_modes lowest
  std::optional<RitzOptions> ritz = {};   ///< modal only: in place of all eigenmodes, from the whole body
  bool flexibility = false;               ///< modal only: static responses to contact forces,
  std::vector<std::string> loaded = {};   ///< on the nodes of these face sets; none: of the whole surface.
                                          ///< Interface or loaded faces of `ritz` too
  bool attachments = false;  ///< modal only: static responses to loads at `markers` as further coordinates
  int relaxed_states = 0;    ///< of viscoelastic bodies with several laws of relaxation; 0: as many as needed
  /// Called on rank 0 before any eigenmode is looked for; may throw Error, which ends the reduction.
  std::function<void(const StaticResponseCost&)> announce = {};
  bool completeness = true;                          ///< check it: one more factorisation of K
  int window = 0;                                    ///< modes found at a time, see EigenOptions
  Store store = Store::all;                          ///< where the modes are stored
  io::Precision precision = io::Precision::float64;  ///< of modes stored at all nodes
  Symmetry symmetry = Symmetry::automatic;           ///< modal only, see reduction/cyclic.h
  Invariants invariants = Invariants::linear;        ///< of inertia, stored in the file
  double alpha = 0, beta = 0;                        ///< 1/s, s: Rayleigh damping D = alpha M + beta K
  model::DampingRatio ratio = {};                    ///< modal only, beside it
  std::map<std::string, double> point_mass = {};     ///< kg, spread evenly over each node or face set
  std::string prefix = {};                           ///< of PETSc's options: `-<prefix>eps_type`, ...
  /// By name, those of them that say how eigenmodes are found: modes that a killed run left were found so.
  std::map<std::string, std::string> solver = {};
  std::map<std::string, std::string> provenance = {};  ///< stored in the file as it is
};

struct StageTime {
  std::string stage;
  double seconds = 0;
};

/// Report of a reduction. Complete on rank 0.
struct ReductionReport {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m, of the body frame in the mesh's coordinates
  double m = 0;                                      ///< kg
  Eigen::Vector3d c = Eigen::Vector3d::Zero();       ///< m, centre of mass, body frame
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();       ///< kg m^2, about the centre of mass
  int n_nodes = 0, n_cells = 0;
  int n_dofs = 0, n_free = 0;  ///< displacements: all, not restrained
  int n_ranks = 1;
  int edge_cut = 0;                  ///< pairs of neighbouring cells on different ranks
  double balance = 1;                ///< most cells of a rank over the mean
  std::string symmetry;              ///< what was found, or why none; empty when it was not looked for
  Eigen::VectorXd frequency;         ///< Hz, ascending, of the modes; empty for the full basis
  Eigen::VectorXd attachment;        ///< Hz, Rayleigh's quotients of the attachment modes
  Eigen::VectorXd residual;          ///< |K phi - omega^2 M phi| / |K phi| of each mode; of `ritz`: empty
  double orthogonality = 0;          ///< largest |phi_i' M phi_j|, i != j, see Eigenmodes
  std::string continued_after;       ///< what was taken over from a run that was killed, if any
  int discarded = 0;                 ///< checkpoints of another run that did not fit this one
  std::vector<model::Check> checks;  ///< of a modal basis that does not come from one sector
  std::vector<StageTime> times;      ///< wall-clock time of each stage, in order
};

/// Reduces the body and writes the body file `output` (on rank 0; a failed run leaves no file). Modes are
/// kept window by window in the folder `output`.partial meanwhile: the same reduction, started again after it
/// was killed, goes on after the last whole window, and on one rank ends in the same file to the bit. More
/// modes than asked for are delivered when the last one's equals would be missing. Collective; the mesh is
/// read on rank 0 only and must be valid (mesh::validate). Memory and work for K, M and the modes are
/// distributed; rank 0 keeps the mesh and one mode at a time.
///
/// With options.imported K and M come from files. Materials and cells then serve the surface, the stress
/// modes, and the inertia when the files lack displacements (which are held); none of these needed, none is.
///
/// Throws the same Error on all ranks for wrong materials, unknown sets, inverted cells, a body that is not
/// held, more modes than free degrees of freedom, stress nodes outside the cells, and what find_eigenmodes,
/// find_space and io::BodyWriter throw.
///
/// A reduction with options.ritz keeps nothing on the way: when it is killed it begins anew.
ReductionReport reduce(MPI_Comm comm, const mesh::Mesh& mesh, const ReductionOptions& options,
                       const std::string& output, const Progress& progress = {});

}  // namespace elastogear::reduction
