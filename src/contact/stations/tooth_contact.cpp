#include "elastogear/contact/tooth_contact.h"

#include <algorithm>
#include <cmath>

#include "contact/stations/flank_mesh.h"
#include "contact/stations/flank_size.h"
#include "contact/stations/moving_contact.h"
#include "contact/stations/smooth_load.h"
#include "elastogear/base/error.h"
#include "elastogear/contact/face.h"

namespace elastogear::contact {
namespace {

constexpr int kMarks = 5;           // along the face, of each flank
constexpr double kNearMarks = 1.5;  // of a flank's height, that marks of flanks in contact may be apart
constexpr int kPieces = 3;  // of strips over which lines of contact lean by more than their width, odd
constexpr double kSlopeStep = 1e-4;  // of a flank's height, for slopes

// The distance between marks at the same parts of both faces, the least one.
double mark_distance(const Eigen::Matrix3Xd& owner, const Eigen::Matrix3Xd& mate,
                     const RelativePlacement& placement) {
  return std::sqrt(((placement.R * mate).colwise() + placement.r - owner).colwise().squaredNorm().minCoeff());
}

// -: dv/dz of a line along which the normal of a flank does not turn, at the middle of its face. Such are the
// lines of contact of conjugate helicoids.
double generator_slope(const ExactFlanks& flanks, const FlankName& flank, double v, double z) {
  const double step = kSlopeStep * height(flanks);
  v = std::max(v, 2 * step);
  const auto normal = [&](double dv, double dz) { return flanks.point(flank, v + dv, z + dz).n; };
  const Eigen::Vector3d n_v = normal(step, 0) - normal(-step, 0), n_z = normal(0, step) - normal(0, -step);
  return -n_v.dot(n_z) / n_v.squaredNorm();
}

// Places of strips on one body.
ToothContact::Side make_side(const ToothContact& contact, const FlankMesh& mesh, const LoadTable& loads,
                             bool is_owner) {
  ToothContact::Side side{mesh.name, &mesh, &loads, {}, {}, {}, {}};
  side.direction.resize(3, loads.n());
  for (Eigen::Index i = 0; i < loads.n(); ++i) {
    const NearestPlace& place = contact.strip_place(i);
    side.direction.col(i) =
        is_owner ? place.n : Eigen::Vector3d(-(contact.placement.R.transpose() * place.n));
    side.v.push_back(std::clamp(is_owner ? place.v : place.mate_v, mesh.grid.v.front(), mesh.grid.v.back()));
    side.z.push_back(loads.strips[static_cast<std::size_t>(i)].centre());
    side.at.push_back(stencil(loads, side.v.back()));
  }
  return side;
}

// (v, z) of a station on one body, m, beside the place of its strip.
Eigen::Vector2d station_at(const ToothContact& contact, std::size_t s, Eigen::Index i) {
  const auto strip = static_cast<std::size_t>(contact.strip_of(i));
  const NearestPlace &here = contact.places[static_cast<std::size_t>(i)],
                     &middle = contact.strip_place(contact.strip_of(i));
  const double along = here.face.centre() - middle.face.centre();
  const double across = s == 0 ? here.v - middle.v : here.mate_v - middle.mate_v;
  return {contact.side[s].v[strip] + across, contact.side[s].z[strip] + along};
}

// m, along the profile: the half width of contact over which gaps are taken for parabolas.
double width_for_curvature(const ExactFlanks& flanks) { return kWidth * height(flanks); }

// m: of relative curvature across the line of contact at a station, over the half width b along the profile.
double radius(const ToothContact& contact, std::size_t i, double b) {
  const double most = kFlattest * height(*contact.flanks.owner);
  const double across = b * contact.across[static_cast<Eigen::Index>(i)];
  const double opens = opening(contact.flanks, contact.placement, contact.places[i], b);
  return opens > 0 ? std::min(most, across * across / (2 * opens)) : most;
}

ToothContact make_contact(const ToothedPair& pair, const FlankMesh& on_owner, const FlankMesh& on_mate,
                          const FlankPair& flanks, const RelativePlacement& placement,
                          std::vector<NearestPlace> places) {
  ToothContact contact{flanks, placement, std::move(places), {}, {}, &pair, {}, {}, {}, {}, {}, pair.pieces};
  const std::array<ToothedBody*, 2> body{pair.owner, pair.mate};
  const std::array<const FlankMesh*, 2> mesh{&on_owner, &on_mate};
  const auto n = std::ssize(contact.places);
  contact.gap = Eigen::VectorXd::Zero(n);
  contact.across.setConstant(n, pair.owner->loads(on_owner, pair, 0).scale.across);
  contact.local = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t s : {0, 1}) {
    const LoadTable& loads = body[s]->loads(*mesh[s], pair, s);
    contact.side[s] = make_side(contact, *mesh[s], loads, s == 0);
    contact.local += body[s]->compliance() * (loads.line - smooth_kernel(loads, contact.side[s].at));
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto j = static_cast<std::size_t>(i);
    contact.gap[i] = contact.places[j].gap;
    for (std::size_t s : {0, 1}) {
      const Eigen::Vector2d at = station_at(contact, s, i);
      contact.gap[i] -= body[s]->deviation(*mesh[s], at[0], at[1]);
    }
    contact.own.push_back({contact.places[j].face.length() * contact.side[0].loads->scale.along,
                           radius(contact, j, width_for_curvature(pair.owner->flanks())),
                           pair.owner->compliance() + pair.mate->compliance(), pair.q});
  }
  return contact;
}

// m: by how much z of the mate is larger than z of the owner where teeth of parallel axes touch, on the line
// of centres. On either side of it leaning axes have other z.
double axial_shift(const ToothedBody& owner, const ToothedBody& mate, const RelativePlacement& placement) {
  const auto radius = [](const ToothedBody& body) {
    return body.flanks().point(body.meshes().front().name, middle(body.flanks()), 0).x.head<2>().norm();
  };
  const Eigen::Vector3d towards = Eigen::Vector3d(placement.r[0], placement.r[1], 0).normalized();
  const auto on_mate = [&](double sign) {
    return Eigen::Vector3d(placement.R.transpose() * (sign * radius(owner) * towards - placement.r));
  };
  const auto beside = [&](const Eigen::Vector3d& x) { return std::abs(x.head<2>().norm() - radius(mate)); };
  const Eigen::Vector3d ahead = on_mate(1), behind = on_mate(-1);  // behind: of a pinion in a ring
  return (beside(ahead) < beside(behind) ? ahead : behind)[2];
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
      const double z = mesh.grid.z.front() + (mesh.grid.z.back() - mesh.grid.z.front()) * i / (kMarks - 1);
      marks.col(i) = flanks_->point(mesh.name, v, z).x;
    }
    marks_.push_back(marks);
    mark_normals_.push_back(flanks_->point(mesh.name, v, (mesh.grid.z.front() + mesh.grid.z.back()) / 2).n);
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

const FlankMesh& ToothedBody::mesh(const FlankName& flank) const {
  for (const FlankMesh& mesh : meshes_)
    if (mesh.name == flank) return mesh;
  fail("internal: no flank of tooth ", flank.tooth);
}

std::vector<FlankName> ToothedBody::flank_names() const {
  std::vector<FlankName> names;
  for (const FlankMesh& mesh : meshes_) names.push_back(mesh.name);
  return names;
}

const std::vector<int>& ToothedBody::nodes(const FlankName& flank) const { return mesh(flank).node; }

bool ToothedBody::repeats(int period) const {
  return std::all_of(meshes_.begin(), meshes_.end(), [&](const FlankMesh& of) {
    const FlankName first{of.name.tooth % period, of.name.side};
    return std::any_of(meshes_.begin(), meshes_.end(),
                       [&](const FlankMesh& at) { return at.name == first && at.like == of.like; });
  });
}

const LoadTable& ToothedBody::loads(const FlankMesh& of, const ToothedPair& pair, std::size_t s) {
  std::list<LoadTable>& tables = tables_[of.like];
  for (const LoadTable& table : tables)
    if (table.strips == pair.strips[s] && table.pieces == pair.pieces && table.q == pair.q) return table;
  const FlankMesh& like = meshes_[static_cast<std::size_t>(of.like)];
  const double z = (like.grid.z.front() + like.grid.z.back()) / 2;
  const auto slope = [&](double v) { return generator_slope(*flanks_, like.name, v, z); };
  const double v = middle(*flanks_);
  tables.push_back(load_table(like.grid, pair.strips[s], pair.pieces, slope,
                              line_scale(flanks_->point(like.name, v, z), slope(v)), pair.q));
  return tables.back();
}

ToothedPair toothed_pair(ToothedBody& owner, ToothedBody& mate, const RelativePlacement& placement, int n) {
  constexpr double kParallel = 0.99;  // cosine of the angle between axes, which are misaligned by less
  if (placement.R(2, 2) < kParallel) {
    ToothedPair pair{&owner, &mate, {}};
    set_moving_stations(pair, n);
    return pair;
  }
  const FlankMesh &on_owner = owner.meshes().front(), &on_mate = mate.meshes().front();
  const double shift = axial_shift(owner, mate, placement);
  const double from = std::max(on_owner.grid.z.front(), on_mate.grid.z.front() - shift);
  const double to = std::min(on_owner.grid.z.back(), on_mate.grid.z.back() - shift);
  ToothedPair pair{&owner, &mate, {}, kWidest * height(owner.flanks())};
  for (int i = 0; to > from && i < n; ++i) {
    const Strip strip{from + i * (to - from) / n, from + (i + 1) * (to - from) / n};
    pair.strips[0].push_back(strip);
    pair.strips[1].push_back({std::max(strip.from + shift, on_mate.grid.z.front()),
                              std::min(strip.to + shift, on_mate.grid.z.back())});
  }
  const double lean = generator_slope(owner.flanks(), on_owner.name, middle(owner.flanks()), 0);
  if (std::abs(lean) * (to - from) / n > kWidth * height(owner.flanks())) pair.pieces = kPieces;
  return pair;
}

std::vector<ToothContact> tooth_contacts(const ToothedPair& pair, const RelativePlacement& placement) {
  if (pair.is_crossed) return moving_contacts(pair, placement);
  std::vector<ToothContact> contacts;
  const ToothedBody &owner = *pair.owner, &mate = *pair.mate;
  if (pair.strips[0].empty()) return contacts;
  const std::vector<Strip> stations = pieces_of(pair.strips[0], pair.pieces);
  const double near = kNearMarks * std::max(height(owner.flanks()), height(mate.flanks()));
  const double of_height = std::min(height(owner.flanks()), height(mate.flanks()));
  for (std::size_t a = 0; a < owner.meshes().size(); ++a)
    for (std::size_t b = 0; b < mate.meshes().size(); ++b) {
      if (owner.mark_normals()[a].dot(placement.R * mate.mark_normals()[b]) > 0 ||
          mark_distance(owner.marks()[a], mate.marks()[b], placement) > near)
        continue;
      const FlankMesh &on_owner = owner.meshes()[a], &on_mate = mate.meshes()[b];
      const FlankPair flanks{&owner.flanks(), on_owner.name, &mate.flanks(), on_mate.name};
      std::vector<NearestPlace> places = nearest_places(flanks, placement, stations);
      if (touches(places, of_height))
        contacts.push_back(make_contact(pair, on_owner, on_mate, flanks, placement, std::move(places)));
    }
  return contacts;
}

double change_of_potential(const ToothContact& contact, const Eigen::VectorXd& f,
                           const std::array<PotentialSlopes, 2>& slopes,
                           const Eigen::Matrix<double, 6, 1>& twist) {
  double change = 0;
  for (Eigen::Index i = 0; i < contact.n(); ++i) {
    const StationLaw& law = contact.own[static_cast<std::size_t>(i)];
    const NearestPlace& place = contact.places[static_cast<std::size_t>(i)];
    const Eigen::Index strip = contact.strip_of(i);
    const auto loads = [&](std::size_t s) { return !slopes[s].direction.col(strip).isZero(0); };
    const bool moves_loads = i == contact.middle_of(strip) && (loads(0) || loads(1));
    if (!moves_loads && f[i] <= 0) continue;
    const double b = width_for_curvature(*contact.flanks.owner);
    const double across = b * contact.across[i];
    const PlaceRates rates = place_rates(contact.flanks, contact.placement, place, twist, b);
    const Eigen::Vector3d x =
        contact.flanks.owner->point(contact.flanks.on_owner, place.v, place.face.centre()).x;
    change -= f[i] * place.n.dot(twist.head<3>() + twist.tail<3>().cross(x));  // the gap itself
    if (moves_loads)
      change += slopes[0].v[strip] * rates.v + slopes[1].v[strip] * rates.mate_v +
                slopes[0].direction.col(strip).dot(rates.n) -
                slopes[1].direction.col(strip).dot(rates.mate_n);
    // R = across^2 / (2 opening)
    change -= law.energy_by_radius(f[i]) * 2 * law.radius * law.radius / (across * across) * rates.opening;
  }
  return change;
}

const std::vector<int>& loaded_nodes(const ToothContact::Side& side) {
  return side.loads ? side.mesh->node : side.moving.node;
}

Eigen::MatrixXd spread(const ToothContact::Side& side) {
  if (side.loads) return side.loads->Z;
  return Eigen::MatrixXd::Identity(side.moving.weight.rows(), side.moving.weight.rows());
}

Eigen::MatrixXd weights(const ToothContact::Side& side) {
  return side.loads ? weights(*side.loads, side.at) : side.moving.weight;
}

Eigen::Matrix3Xd displacements(const ToothContact::Side& side, const Eigen::Matrix3Xd& of_nodes) {
  if (side.loads) return displacements(*side.loads, side.at, of_nodes).u;
  return of_nodes * side.moving.weight.transpose();
}

namespace {

// With the radius of relative curvature over the width of contact itself, as of rounded edges.
StationLaw fitting_law(const ToothContact& contact, std::size_t i, double f) {
  constexpr int kRounds = 4;
  StationLaw law = contact.own[i];
  if (law.ellipse) return law;
  for (int round = 0; round < kRounds; ++round)
    law.radius = radius(contact, i, law.half_width(f) / contact.across[static_cast<Eigen::Index>(i)]);
  return law;
}

}  // namespace

ContactPoint station_point(const ToothContact& contact, const ToothedPair& pair, Eigen::Index i, double f,
                           const RelativePlacement& at) {
  const auto j = static_cast<std::size_t>(i);
  const Eigen::Vector2d on_owner = station_at(contact, 0, i), on_mate = station_at(contact, 1, i);
  const FaceOfFlank here = face_at(*contact.side[0].mesh, on_owner[0], on_owner[1]);
  const FaceOfFlank there = face_at(*contact.side[1].mesh, on_mate[0], on_mate[1]);
  const Eigen::Vector4d N = shape(4, here.xi, here.eta).N, N_there = shape(4, there.xi, there.eta).N;
  const Eigen::Vector4i nodes = pair.owner->surface().face.col(here.face),
                        nodes_there = pair.mate->surface().face.col(there.face);
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
  const NearestPlace& place = contact.places[j];
  point.n = at.R * place.n.normalized();
  point.place =
      at.r + at.R * contact.flanks.owner->point(contact.flanks.on_owner, place.v, place.face.centre()).x;
  point.f = f * point.n;
  point.F = LocalVectors(3, 8);
  for (Eigen::Index k = 0; k < 4; ++k) {
    point.F.col(k) = N[k] * point.f;
    point.F.col(4 + k) = -N_there[k] * point.f;
  }
  point.p = f;
  const StationLaw law = fitting_law(contact, j, f);
  point.area = law.area(f);
  point.pressure = law.pressure(f);
  point.W.resize(24, 0);
  point.k.resize(0, 0);
  return point;
}

}  // namespace elastogear::contact
