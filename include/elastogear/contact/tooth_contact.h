#pragma once
// Stations of all pairs of teeth that come near each other, at one placement of two bodies: their places,
// gaps, loads on both meshes and half-spaces below these (docs/theory, section 6.18).

#include <Eigen/Core>
#include <array>
#include <list>
#include <map>
#include <memory>
#include <vector>

#include "elastogear/contact/exact_flanks.h"
#include "elastogear/contact/load_table.h"
#include "elastogear/contact/station_law.h"
#include "elastogear/contact/station_places.h"
#include "elastogear/contact/types.h"

namespace elastogear::contact {

struct FlankMesh;
struct ToothedPair;

/// The flanks of one body, with what contact takes from its mesh and material.
class ToothedBody {
 public:
  /// compliance: 1/Pa, (1 - nu^2) / (pi E). deviation: m, of each node of the surface along the outward
  /// normal, or empty. The surface must outlive this.
  ToothedBody(const model::Surface& surface, std::shared_ptr<const ExactFlanks> flanks, double compliance,
              const Eigen::VectorXd& deviation);
  ~ToothedBody();
  ToothedBody(ToothedBody&&) noexcept;

  const ExactFlanks& flanks() const { return *flanks_; }
  const std::vector<FlankMesh>& meshes() const { return meshes_; }
  const model::Surface& surface() const { return *surface_; }
  double compliance() const { return compliance_; }
  std::vector<FlankName> flank_names() const;
  /// The nodes of a flank, in the order of its tables.
  const std::vector<int>& nodes(const FlankName& flank) const;
  /// Do flanks, so many teeth apart, have the same mesh, nodes in the same order?
  bool repeats(int period) const;
  /// Loads on the pair's strips of a flank and those like it; made when they are first asked for. s: which
  /// body of the pair this is.
  const LoadTable& loads(const FlankMesh& mesh, const ToothedPair& pair, std::size_t s);
  /// m, of the surface beside its exact flank; linear between nodes.
  double deviation(const FlankMesh& mesh, double v, double z) const;
  /// m, points spread over each flank, by which those that are near others are found; 3 x n each.
  const std::vector<Eigen::Matrix3Xd>& marks() const { return marks_; }
  const std::vector<Eigen::Vector3d>& mark_normals() const { return mark_normals_; }

 private:
  const FlankMesh& mesh(const FlankName& flank) const;

  const model::Surface* surface_;
  std::shared_ptr<const ExactFlanks> flanks_;
  double compliance_;
  Eigen::VectorXd deviation_;
  std::vector<FlankMesh> meshes_;
  std::vector<Eigen::Matrix3Xd> marks_;
  std::vector<Eigen::Vector3d> mark_normals_;
  std::map<int, std::list<LoadTable>> tables_;  // of flanks that are like this one
};

/// What n stations that move over the flanks do to each other in the half-spaces of both bodies, as if they
/// stood side by side along a straight line.
struct AmongStations {
  std::array<Eigen::MatrixXd, 2> line;    ///< n x n, 1/m: of pressures of the pair's half width
  std::array<Eigen::MatrixXd, 2> smooth;  ///< n x n, -, of smooth loads, over what each does to itself
  double along = 1;                       ///< -, length along that line for each m of the owner's z
};

/// Two bodies whose flanks may touch. On parallel axes strips fill the face that both have where they stand
/// at the start. On axes that cross stations move over the mate's flank: those of a hobbed owner stand on
/// strips of its whole face; of others each pair of teeth has one, at a point that moves over both flanks.
struct ToothedPair {
  ToothedBody *owner, *mate;
  std::array<std::vector<Strip>, 2> strips;  ///< m, of the owner's face, and of the mate's
  double q = 0;                              ///< m, half width of the strips' pressures
  int pieces = 1;                            ///< of a strip, each a station
  bool is_crossed = false;
  AmongStations among = {};  ///< of those that move
};
/// n: strips of a pair of teeth. placement: of the mate in the owner's frame.
ToothedPair toothed_pair(ToothedBody& owner, ToothedBody& mate, const RelativePlacement& placement, int n);

/// Smooth loads of 1 N at n places that move over a flank.
struct MovingLoads {
  std::vector<int> node;   ///< of the surface, ascending: those they act on, there and a little farther
  Eigen::MatrixXd weight;  ///< n x nodes, nodal forces
  Eigen::VectorXd smooth;  ///< n, 1/m, what each does to itself in the half-space below it
  Eigen::VectorXd along;   ///< n, -, length along the line of contact for each m of z
};

/// n stations of one pair of teeth, on strips of loads. Side 0 is the owner of the stations.
struct ToothContact {
  struct Side {
    FlankName flank;
    const FlankMesh* mesh;
    const LoadTable* loads;      ///< of strips; null where loads move
    std::vector<Stencil> at;     ///< places of the strips among those of the loads
    std::vector<double> v, z;    ///< m, places
    Eigen::Matrix3Xd direction;  ///< 3 x strips, unit vectors of the forces on this body, in its frame
    MovingLoads moving = {};

    /// Does a strip stand beyond an end of the mesh's flank? Its loads are at the end then.
    bool is_clamped(Eigen::Index i) const {
      if (!loads) return false;
      const double from = loads->v_0, to = from + (loads->n_v - 1) * loads->step;
      return v[static_cast<std::size_t>(i)] <= from || v[static_cast<std::size_t>(i)] >= to;
    }
  };

  FlankPair flanks;
  RelativePlacement placement;
  std::vector<NearestPlace> places;
  std::array<Side, 2> side;
  FaceEnds ends = {};  ///< of faces that round flanks, where stations move over them
  const ToothedPair* pair = nullptr;
  std::vector<int> number = {};  ///< of stations that move, among those of the pair's strips
  Eigen::VectorXd gap;           ///< n, m, of the bodies as if they were rigid
  Eigen::MatrixXd local;         ///< n x n, m/N: half-spaces below the meshes' smooth loads. Eq. (6.39)
  std::vector<StationLaw> own;   ///< n
  Eigen::VectorXd across;        ///< n, -, distance across the line of contact for each m of the owner's v
  int pieces = 1;                ///< stations of a strip, an odd number; 1 where they move

  Eigen::Index n() const { return gap.size(); }
  bool is_moving() const { return !side[0].loads; }
  Eigen::Index n_strips() const { return n() / pieces; }
  Eigen::Index strip_of(Eigen::Index station) const { return station / pieces; }
  /// The station in the middle of a strip, whose place and direction the strip's loads have.
  Eigen::Index middle_of(Eigen::Index strip) const { return strip * pieces + pieces / 2; }
  const NearestPlace& strip_place(Eigen::Index strip) const {
    return places[static_cast<std::size_t>(middle_of(strip))];
  }
};

/// The contacts of all pairs of teeth with a station whose gap is small beside the height of a tooth.
std::vector<ToothContact> tooth_contacts(const ToothedPair& pair, const RelativePlacement& placement);

/// Nodes of the surface that the loads of a side act on, those of all its flank or near loads that move.
const std::vector<int>& loaded_nodes(const ToothContact::Side& side);
/// n x strips: how strips share the forces of stations, Eq. (6.45); 1 of loads that move.
Eigen::MatrixXd spread(const ToothContact::Side& side);
/// strips x loaded nodes: nodal forces of 1 N of each strip or load that moves.
Eigen::MatrixXd weights(const ToothContact::Side& side);
/// m, 3 x strips, by displacements of the loaded nodes, 3 x nodes, m.
Eigen::Matrix3Xd displacements(const ToothContact::Side& side, const Eigen::Matrix3Xd& of_nodes);

/// Derivatives of the potential with places and directions of the strips' loads on one side.
struct PotentialSlopes {
  Eigen::VectorXd v;           ///< of each strip, N
  Eigen::Matrix3Xd direction;  ///< 3 x strips, J
};
/// The same with a motion of the mate against the owner (see place_rates), as gaps, places, directions and
/// curvatures of the stations change under their forces f, N; of strips.
double change_of_potential(const ToothContact& contact, const Eigen::VectorXd& f,
                           const std::array<PotentialSlopes, 2>& slopes,
                           const Eigen::Matrix<double, 6, 1>& twist);
/// The same of stations that move, under the displacements of the loaded nodes of both sides, 3 x nodes, m.
double change_of_potential(const ToothContact& contact, const Eigen::VectorXd& f,
                           const std::array<Eigen::Matrix3Xd, 2>& of_nodes,
                           const Eigen::Matrix<double, 6, 1>& twist);

/// Station i under the force f, N, as a contact point that is read and not solved for: of the pair's surface
/// 0, the owner, on a face of surface 1. at: placement of the owner in the world.
ContactPoint station_point(const ToothContact& contact, const ToothedPair& pair, Eigen::Index i, double f,
                           const RelativePlacement& at);

}  // namespace elastogear::contact
