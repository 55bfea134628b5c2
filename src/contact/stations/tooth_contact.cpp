#include "elastogear/contact/tooth_contact.h"

#include <algorithm>
#include <cmath>

#include "contact/stations/flank_mesh.h"
#include "contact/stations/smooth_load.h"
#include "elastogear/base/error.h"
#include "elastogear/contact/face.h"

namespace elastogear::contact {
namespace {

constexpr int kMarks = 5;          // along the face, of each flank
constexpr double kNearMarks = 1.5;  // of a flank's height, that marks of flanks in contact may be apart
constexpr double kReach = 0.05;     // of a flank's height: a gap that forces may close
constexpr double kDeepest = 0.25;   // of a flank's height: a larger overlap is one with the tooth behind
constexpr double kFirstWidth = 0.02;  // of the height of a flank, in which curvatures are first taken
constexpr double kFlattest = 1e3;     // of the height of a flank: radii of flanks that hardly part, or overlap
                                      // in fillets, where they bear no force

double height(const ExactFlanks& flanks) {
  const ExactFlanks::Extent extent = flanks.extent();
  return extent.upper - extent.lower;
}

double middle(const ExactFlanks& flanks) {
  const ExactFlanks::Extent extent = flanks.extent();
  return (extent.upper + extent.lower) / 2;
}

// The distance between marks at the same parts of both faces, the least one.
double mark_distance(const Eigen::Matrix3Xd& owner, const Eigen::Matrix3Xd& mate,
                     const RelativePlacement& placement) {
  return std::sqrt(((placement.R * mate).colwise() + placement.r - owner).colwise().squaredNorm().minCoeff());
}

// The piece of the owner's face that the mate's lies on, m of the owner's z.
Strip common_face(const ToothedBody& owner, const FlankMesh& on_owner, const ToothedBody& mate,
                  const FlankMesh& on_mate, const RelativePlacement& placement) {
  const FlankPoint point = owner.flanks().point(on_owner.name, middle(owner.flanks()), 0);
  const double shift = mate.flanks().chart(placement.R.transpose() * (point.x - placement.r))[1];
  return {std::max(on_owner.grid.z.front(), on_mate.grid.z.front() - shift),
          std::min(on_owner.grid.z.back(), on_mate.grid.z.back() - shift)};
}

bool touches(const std::vector<NearestPlace>& places, double of_height) {
  bool any = false;
  for (const NearestPlace& place : places) {
    if (place.gap < -kDeepest * of_height) return false;
    any = any || place.gap < kReach * of_height;
  }
  return any;
}

// Stations on one body: pieces of its own face, side by side.
std::vector<StationPlace> station_places(const std::vector<NearestPlace>& places,
                                         const std::vector<double>& slope, bool on_owner,
                                         const FlankGrid& grid) {
  std::vector<StationPlace> stations;
  const std::size_t mid = places.size() / 2;
  const double shift = on_owner ? 0 : places[mid].mate_z - places[mid].face.centre();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Strip& face = places[i].face;
    const double v = on_owner ? places[i].v : places[i].mate_v;
    stations.push_back({{std::max(face.from + shift, grid.z.front()), std::min(face.to + shift, grid.z.back())},
                        std::clamp(v, grid.v.front(), grid.v.back()),
                        slope[i]});
  }
  return stations;
}

// Loads on one body, and the half-space below: adds to `local`.
void add_side(const ToothedBody& body, const FlankMesh& mesh, const std::vector<double>& slope, bool is_owner,
              ToothContact& contact) {
  const std::vector<StationPlace> stations =
      station_places(contact.places, slope, is_owner, mesh.grid);
  const LoadWidth width = load_width(mesh.grid);
  ToothContact::Side& side = contact.side[is_owner ? 0 : 1];
  side.mesh = &mesh;
  side.node = mesh.node;
  side.weight = consistent_weights(mesh.grid, stations, width);
  side.direction.resize(3, contact.n());
  for (const NearestPlace& place : contact.places) {
    const auto i = std::ssize(side.v);
    side.direction.col(i) =
        is_owner ? place.n : Eigen::Vector3d(-(contact.placement.R.transpose() * place.n));
    side.v.push_back(stations[static_cast<std::size_t>(i)].v);
    side.z.push_back(stations[static_cast<std::size_t>(i)].face.centre());
  }
  const std::size_t mid = stations.size() / 2;
  const LineScale scale =
      line_scale(body.flanks().point(mesh.name, stations[mid].v, stations[mid].face.centre()), slope[mid]);
  if (is_owner) contact.scale = scale;
  const FreeEnds ends{mesh.grid.z.front(), mesh.grid.z.back()};
  std::vector<Strip> along;
  for (const StationPlace& station : stations)
    along.push_back({station.face.from * scale.along, station.face.to * scale.along});
  contact.local += body.compliance() *
                   (line_kernel(along, 0, {ends.lower * scale.along, ends.upper * scale.along, ends.share}) -
                    smooth_kernel(mesh.grid, stations, width, ends, scale));
}

ToothContact make_contact(const ToothedBody& owner, const FlankMesh& on_owner, const ToothedBody& mate,
                          const FlankMesh& on_mate, const FlankPair& flanks,
                          const RelativePlacement& placement, std::vector<NearestPlace> places) {
  ToothContact contact{flanks, placement, std::move(places), {}, {}, {}, {}, {}};
  const auto n = std::ssize(contact.places);
  contact.gap.resize(n);
  contact.local = Eigen::MatrixXd::Zero(n, n);
  const std::array<std::vector<double>, 2> slope = slopes(contact.places);
  add_side(owner, on_owner, slope[0], true, contact);
  add_side(mate, on_mate, slope[1], false, contact);
  const double first_width = kFirstWidth * height(owner.flanks());
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto j = static_cast<std::size_t>(i);
    contact.gap[i] = contact.places[j].gap -
                     owner.deviation(on_owner, contact.side[0].v[j], contact.side[0].z[j]) -
                     mate.deviation(on_mate, contact.side[1].v[j], contact.side[1].z[j]);
    contact.own.push_back({contact.places[j].face.length() * contact.scale.along, first_width,
                           owner.compliance() + mate.compliance()});
  }
  set_radii(contact, Eigen::VectorXd::Zero(n));
  return contact;
}

}  // namespace

ToothedBody::ToothedBody(const model::Surface& surface, std::shared_ptr<const ExactFlanks> flanks,
                         double compliance, const Eigen::VectorXd& deviation)
    : surface_(&surface),
      flanks_(std::move(flanks)),
      compliance_(compliance),
      deviation_(deviation),
      meshes_(flank_meshes(surface, *flanks_)) {
  const double v = middle(*flanks_);
  for (const FlankMesh& mesh : meshes_) {
    Eigen::Matrix3Xd marks(3, kMarks);
    for (int i = 0; i < kMarks; ++i) {
      const double z =
          mesh.grid.z.front() + (mesh.grid.z.back() - mesh.grid.z.front()) * i / (kMarks - 1);
      marks.col(i) = flanks_->point(mesh.name, v, z).x;
    }
    marks_.push_back(marks);
    mark_normals_.push_back(
        flanks_->point(mesh.name, v, (mesh.grid.z.front() + mesh.grid.z.back()) / 2).n);
  }
}

ToothedBody::~ToothedBody() = default;
ToothedBody::ToothedBody(ToothedBody&&) noexcept = default;

double ToothedBody::deviation(const FlankMesh& mesh, double v, double z) const {
  if (deviation_.size() == 0) return 0;
  const FaceOfFlank at = face_at(mesh, v, z);
  const Eigen::Vector4d N = shape(4, at.xi, at.eta).N;
  double sum = 0;
  for (Eigen::Index i = 0; i < 4; ++i) sum += N[i] * deviation_[surface_->face(i, at.face)];
  return sum;
}

std::vector<ToothContact> tooth_contacts(const ToothedBody& owner, const ToothedBody& mate,
                                         const RelativePlacement& placement, int n) {
  std::vector<ToothContact> contacts;
  const double near = kNearMarks * std::max(height(owner.flanks()), height(mate.flanks()));
  const double of_height = std::min(height(owner.flanks()), height(mate.flanks()));
  for (std::size_t a = 0; a < owner.meshes().size(); ++a)
    for (std::size_t b = 0; b < mate.meshes().size(); ++b) {
      if (owner.mark_normals()[a].dot(placement.R * mate.mark_normals()[b]) > 0 ||
          mark_distance(owner.marks()[a], mate.marks()[b], placement) > near)
        continue;
      const FlankMesh &on_owner = owner.meshes()[a], &on_mate = mate.meshes()[b];
      const Strip face = common_face(owner, on_owner, mate, on_mate, placement);
      if (!(face.length() > 0)) continue;
      const FlankPair flanks{&owner.flanks(), on_owner.name, &mate.flanks(), on_mate.name};
      std::vector<NearestPlace> places = nearest_places(flanks, placement, face, n);
      if (touches(places, of_height))
        contacts.push_back(
            make_contact(owner, on_owner, mate, on_mate, flanks, placement, std::move(places)));
    }
  return contacts;
}

double set_radii(ToothContact& contact, const Eigen::VectorXd& f) {
  double change = 0;
  const double least = kFirstWidth * height(*contact.flanks.owner);
  const double most = kFlattest * height(*contact.flanks.owner);
  for (std::size_t i = 0; i < contact.own.size(); ++i) {
    StripLaw& law = contact.own[i];
    const double force = f[static_cast<Eigen::Index>(i)];
    const double b = force > 0 ? law.half_width(force) / contact.scale.across : least;
    const double opens = opening(contact.flanks, contact.placement, contact.places[i], b);
    const double across = b * contact.scale.across;
    const double radius = std::min(most, opens > 0 ? across * across / (2 * opens) : most);
    change = std::max(change, std::abs(radius / law.radius - 1));
    law.radius = radius;
  }
  return change;
}

ContactPoint station_point(const ToothContact& contact, const ToothedBody& owner, const ToothedBody& mate,
                           Eigen::Index i, double f, const Eigen::Matrix3d& R_WB) {
  const auto j = static_cast<std::size_t>(i);
  const FaceOfFlank here = face_at(*contact.side[0].mesh, contact.side[0].v[j], contact.side[0].z[j]);
  const FaceOfFlank there = face_at(*contact.side[1].mesh, contact.side[1].v[j], contact.side[1].z[j]);
  const Eigen::Vector4d N = shape(4, here.xi, here.eta).N, N_there = shape(4, there.xi, there.eta).N;
  const Eigen::Vector4i nodes = owner.surface().face.col(here.face),
                        nodes_there = mate.surface().face.col(there.face);
  ContactPoint point;
  Eigen::Index nearest = 0;
  N.maxCoeff(&nearest);
  point.slave_node = nodes[nearest];
  point.slave_nodes = nodes;
  point.slave_N = N;
  point.face = there.face;
  point.master_nodes = nodes_there;
  point.N = N_there;
  point.xi = there.xi;
  point.eta = there.eta;
  point.n = R_WB * contact.places[j].n;
  point.f = f * point.n;
  point.F = LocalVectors(3, 8);
  for (Eigen::Index k = 0; k < 4; ++k) {
    point.F.col(k) = N[k] * point.f;
    point.F.col(4 + k) = -N_there[k] * point.f;
  }
  point.p = f;
  point.area = 2 * contact.own[j].half_width(f) * contact.own[j].length;
  point.pressure = contact.own[j].pressure(f);
  point.W.resize(24, 0);
  point.k.resize(0, 0);
  return point;
}

}  // namespace elastogear::contact
