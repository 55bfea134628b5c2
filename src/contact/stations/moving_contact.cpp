#include "contact/stations/moving_contact.h"

#include <algorithm>
#include <cmath>

#include "contact/stations/flank_gap.h"
#include "contact/stations/flank_mesh.h"
#include "contact/stations/flank_size.h"
#include "contact/stations/smooth_load.h"

namespace elastogear::contact {
namespace {

constexpr double kMateDistance = 1.5;  // of a flank's height, that a mate's flank in contact may be away
constexpr double kLoadMargin =
    1.01;                        // times the size of a load, that of those it may become in a small motion
constexpr double kSteepest = 1;  // slope of a line of contact that loads follow, lengths along both

double compliance_of(const ToothedPair& pair, std::size_t s) {
  return (s == 0 ? pair.owner : pair.mate)->compliance();
}

// Loads even over boxes around places along a straight line, over what each does to itself without images.
Eigen::MatrixXd shared_kernel(const std::vector<Strip>& boxes, double across, const FreeEnds& ends) {
  const AcrossLoad load{-across, across};
  const auto n = std::ssize(boxes);
  Eigen::MatrixXd K(n, n);
  Eigen::VectorXd own(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Strip& a = boxes[static_cast<std::size_t>(i)];
    own[i] = std::sqrt(smooth_inverse_distance(load, a, load, a));
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Strip& b = boxes[static_cast<std::size_t>(j)];
      double sum = smooth_inverse_distance(load, a, load, b);
      for (const Strip& image : images(b, ends))
        sum += ends.share * smooth_inverse_distance(load, a, load, image);
      K(i, j) = K(j, i) = sum / (own[i] * own[j]);
    }
  }
  return K;
}

// m, beyond the middle of each strip along the line, where its smooth load on this body reaches.
double half_length(const Strip& strip, double c) { return std::max(strip.length() / 2, c); }

// By the mean of both halves of the face: in its middle the chart of a hobbed flank has a crease.
LineScale middle_scale(const ToothedBody& body) {
  constexpr double kBeside = 0.05;  // of the face
  const FlankMesh& mesh = body.meshes().front();
  const double from = mesh.grid.z.front(), to = mesh.grid.z.back(), beside = kBeside * (to - from);
  const auto at = [&](double z) {
    return line_scale(body.flanks().point(mesh.name, middle(body.flanks()), (from + to) / 2 + z), 0);
  };
  const LineScale a = at(-beside), b = at(beside);
  return {(a.along + b.along) / 2, (a.across + b.across) / 2};
}

Eigen::MatrixXd shared_kernel(const ToothedBody& body, const std::vector<Strip>& strips,
                              const FreeEnds& ends) {
  const FlankMesh& mesh = body.meshes().front();
  const LineScale scale = middle_scale(body);
  const LoadWidth width = load_width(mesh.grid);
  std::vector<Strip> boxes;
  for (const Strip& strip : strips) {
    const double c = half_length(strip, width.c * scale.along);
    const double at = std::clamp(strip.centre(), std::min(ends.lower + c, ends.upper - c), ends.upper - c);
    boxes.push_back({at - c, at + c});
  }
  return shared_kernel(boxes, width.a * scale.across, ends);
}

// A station on the flank of one body.
struct MovingPlace {
  double v, z;   // m
  double slope;  // -, dv/dz of the line of contact, from its neighbours' places
};

std::array<MovingPlace, 2> moving_place(const std::vector<NearestPlace>& places, std::size_t i) {
  const NearestPlace &here = places[i], &a = places[i > 0 ? i - 1 : i],
                     &b = places[std::min(i + 1, places.size() - 1)];
  const auto slope = [](double dv, double dz) { return dz == 0 ? 0 : dv / dz; };
  return {{{here.v, here.face.centre(), slope(b.v - a.v, b.face.centre() - a.face.centre())},
           {here.mate_v, here.mate_z, slope(b.mate_v - a.mate_v, b.mate_z - a.mate_z)}}};
}

// Some lines on a worm run up its profile; loads follow them as far as they are not steep.
double bounded(double slope, const FlankPoint& at) {
  const double most = kSteepest * at.x_z.norm() / at.x_v.norm();
  return std::clamp(slope, -most, most);
}

// The smooth loads of stations on one flank. length: m, of each along the line of contact; 0 of a point.
// nodes: those of the surface to take; null: all that are near.
MovingLoads moving_loads(const FlankMesh& mesh, const ExactFlanks& flanks,
                         const std::vector<MovingPlace>& places, const std::vector<double>& length,
                         const std::vector<int>* nodes) {
  const LoadWidth width = load_width(mesh.grid);
  const auto n = std::ssize(places);
  Eigen::MatrixXd weight(n, mesh.grid.n_nodes);
  Eigen::RowVectorXd near = Eigen::RowVectorXd::Zero(mesh.grid.n_nodes);
  MovingLoads loads{{}, {}, Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& [v, z, slope] = places[static_cast<std::size_t>(i)];
    const FlankPoint at = flanks.point(mesh.name, v, z);
    const double along = bounded(slope, at);
    const LineScale scale = line_scale(at, along);
    const LoadWidth size{width.a, std::max(width.c, length[static_cast<std::size_t>(i)] / (2 * scale.along))};
    weight.row(i) = point_weights(mesh.grid, v, z, along, size);
    loads.smooth[i] = point_kernel(mesh.grid, v, z, size, scale);
    loads.along[i] = scale.along;
    if (nodes) continue;
    const LoadWidth larger{kLoadMargin * size.a, kLoadMargin * size.c};
    near += point_weights(mesh.grid, v, z, along, larger).cwiseAbs();
  }
  if (nodes) {
    loads.node = *nodes;
  } else {
    for (int a = 0; a < near.size(); ++a)
      if (near[a] != 0) loads.node.push_back(mesh.node[static_cast<std::size_t>(a)]);
    std::sort(loads.node.begin(), loads.node.end());
  }
  loads.weight = Eigen::MatrixXd::Zero(n, std::ssize(loads.node));
  for (int a = 0; a < weight.cols(); ++a) {
    const int node = mesh.node[static_cast<std::size_t>(a)];
    const auto at = std::lower_bound(loads.node.begin(), loads.node.end(), node);
    if (at != loads.node.end() && *at == node) loads.weight.col(at - loads.node.begin()) = weight.col(a);
  }
  return loads;
}

// The law of a station on a strip of the face; its length is that of the line of contact within the strip.
StationLaw law_of_strip(const ToothContact& contact, std::size_t i, double compliance) {
  const double h = kWidth * height(*contact.flanks.owner),
               flattest = kFlattest * height(*contact.flanks.owner);
  const auto k = static_cast<Eigen::Index>(i);
  const double opens = opening(contact.flanks, contact.placement, contact.places[i], h);
  const double across = h * contact.across[k];
  const double radius = opens > 0 ? std::min(flattest, across * across / (2 * opens)) : flattest;
  return {contact.places[i].face.length() * contact.side[0].moving.along[k], radius, compliance,
          contact.pair->q};
}

StationLaw law_of_point(const ToothContact& contact, double compliance) {
  const double h = kWidth * height(*contact.flanks.owner);
  const PrincipalCurvatures at =
      curvatures(contact.flanks, contact.ends, contact.placement, contact.places[0], h);
  return point_law(at.least, at.largest, compliance);
}

// Eqs. (6.39) and (6.54).
Eigen::MatrixXd local_compliance(const ToothContact& contact) {
  const AmongStations& among = contact.pair->among;
  const Eigen::VectorXd L = (contact.side[0].moving.along / among.along).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd local = Eigen::MatrixXd::Zero(contact.n(), contact.n());
  for (std::size_t s : {0, 1}) {
    const Eigen::VectorXd D = contact.side[s].moving.smooth.cwiseSqrt();
    const Eigen::MatrixXd line = among.line[s](contact.number, contact.number),
                          smooth = among.smooth[s](contact.number, contact.number);
    const double compliance = compliance_of(*contact.pair, s);
    local += compliance * (L.asDiagonal() * line * L.asDiagonal());
    local -= compliance * (D.asDiagonal() * smooth * D.asDiagonal());
  }
  return local;
}

// all: places on all strips of the pair.
void set_sides(const std::array<const FlankMesh*, 2>& mesh, const std::vector<NearestPlace>& all,
               const std::array<const std::vector<int>*, 2>& nodes, ToothContact& contact) {
  const auto n = std::ssize(contact.number);
  std::array<std::vector<MovingPlace>, 2> at;
  for (int i : contact.number)
    for (std::size_t s : {0, 1}) at[s].push_back(moving_place(all, static_cast<std::size_t>(i))[s]);
  std::vector<double> length(contact.places.size(), 0);
  for (std::size_t s : {0, 1}) {
    ToothContact::Side side{mesh[s]->name, mesh[s], nullptr, {}, {}, {}, {}};
    side.direction.resize(3, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      side.v.push_back(at[s][k].v);
      side.z.push_back(at[s][k].z);
      side.direction.col(i) = contact.places[k].n;
    }
    if (s == 1) side.direction = -(contact.placement.R.transpose() * side.direction);
    side.moving = moving_loads(*mesh[s], s == 0 ? *contact.flanks.owner : *contact.flanks.mate, at[s], length,
                               nodes[s]);
    for (std::size_t i = 0; s == 0 && i < length.size(); ++i)
      length[i] = contact.places[i].face.length() * side.moving.along[static_cast<Eigen::Index>(i)];
    contact.side[s] = std::move(side);
  }
  contact.across.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& [v, z, slope] = at[0][static_cast<std::size_t>(i)];
    const FlankPoint point = contact.flanks.owner->point(contact.flanks.on_owner, v, z);
    contact.across[i] = line_scale(point, bounded(slope, point)).across;
  }
}

// Two flanks near each other.
struct NearFlanks {
  FlankPair flanks;
  std::array<const FlankMesh*, 2> mesh;
  FaceEnds ends;
};

// number: of the stations among all places. nodes: see moving_loads.
ToothContact make_contact(const ToothedPair& pair, const NearFlanks& near, const RelativePlacement& placement,
                          const std::vector<NearestPlace>& all, const std::vector<int>& number,
                          const std::array<const std::vector<int>*, 2>& nodes) {
  ToothContact contact{near.flanks, placement, {}, {}, near.ends, &pair, number, {}, {}, {}, {}};
  for (int i : number) contact.places.push_back(all[static_cast<std::size_t>(i)]);
  set_sides(near.mesh, all, nodes, contact);
  contact.gap.resize(std::ssize(number));
  const double compliance = pair.owner->compliance() + pair.mate->compliance();
  for (std::size_t i = 0; i < number.size(); ++i) {
    const NearestPlace& place = contact.places[i];
    contact.gap[static_cast<Eigen::Index>(i)] =
        place.gap - pair.owner->deviation(*near.mesh[0], place.v, place.face.centre()) -
        pair.mate->deviation(*near.mesh[1], place.mate_v, place.mate_z);
    contact.own.push_back(pair.strips[0].empty() ? law_of_point(contact, compliance)
                                                 : law_of_strip(contact, i, compliance));
  }
  contact.local = local_compliance(contact);
  return contact;
}

// Stations whose gaps a force may close.
std::vector<int> close_ones(const std::vector<NearestPlace>& places, double of_height) {
  std::vector<int> close;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].gap < kReach * of_height) close.push_back(static_cast<int>(i));
  return close;
}

// The middle of a flank.
FlankPoint middle_point(const ExactFlanks& flanks, const FlankMesh& mesh) {
  return flanks.point(mesh.name, middle(flanks), (mesh.grid.z.front() + mesh.grid.z.back()) / 2);
}

// A point of the mate as the owner sees it, and the other way round.
FlankPoint from_mate(const FlankPoint& at, const RelativePlacement& placement) {
  return {placement.r + placement.R * at.x, placement.R * at.n, {}, {}};
}
FlankPoint from_owner(const FlankPoint& at, const RelativePlacement& placement) {
  return {placement.R.transpose() * (at.x - placement.r), placement.R.transpose() * at.n, {}, {}};
}

// Does the middle of the flank lie within reach of the other one, on its outer side, and look at it?
bool is_near(const FlankPoint& at, const ExactFlanks& flanks, const FlankName& flank, double near) {
  if (at.x.head<2>().norm() > flanks.tip_radius() + near) return false;
  const FlankDistance d = flanks.distance(flank, at.x);
  return std::abs(d.distance) < near && d.gradient.dot(at.n) < 0;
}

// start: (v, z) on the owner, of a point.
std::vector<NearestPlace> places_of(const ToothedPair& pair, const FlankPair& flanks, const FaceEnds& ends,
                                    const RelativePlacement& placement, const Eigen::Vector2d& start) {
  if (pair.strips[0].empty()) return {nearest_point(flanks, ends, placement, start)};
  return nearest_places(flanks, placement, pair.strips[0], ends);
}

}  // namespace

bool touches(const std::vector<NearestPlace>& places, double of_height) {
  const auto is_deep = [&](const NearestPlace& at) { return at.flank_gap <= -kDeepest * of_height; };
  const auto is_close = [&](const NearestPlace& at) { return at.gap < kReach * of_height; };
  return std::none_of(places.begin(), places.end(), is_deep) &&
         std::any_of(places.begin(), places.end(), is_close);
}

void set_moving_stations(ToothedPair& pair, int n) {
  pair.is_crossed = true;
  if (!pair.owner->flanks().is_hobbed()) {
    pair.among.line.fill(Eigen::MatrixXd::Zero(1, 1));
    pair.among.smooth.fill(Eigen::MatrixXd::Ones(1, 1));
    return;
  }
  const ExactFlanks& owner = pair.owner->flanks();
  const FlankMesh& mesh = pair.owner->meshes().front();
  const double from = mesh.grid.z.front(), length = (mesh.grid.z.back() - from) / n;
  pair.among.along = middle_scale(*pair.owner).along;
  std::vector<Strip> along;
  for (int i = 0; i < n; ++i) {
    pair.strips[0].push_back({from + i * length, from + (i + 1) * length});
    along.push_back(
        {pair.strips[0].back().from * pair.among.along, pair.strips[0].back().to * pair.among.along});
  }
  const FreeEnds ends{along.front().from, along.back().to};  // those of the mate are far
  pair.q = kWidest * height(owner);
  pair.among.line = {line_kernel(along, pair.q, ends), line_kernel(along, pair.q, {})};
  pair.among.smooth = {shared_kernel(*pair.owner, along, ends), shared_kernel(*pair.mate, along, {})};
}

// Near each other are those whose middle of the gear with more teeth is near the flank of the other, which
// may be a thread of several turns.
std::vector<ToothContact> moving_contacts(const ToothedPair& pair, const RelativePlacement& placement) {
  std::vector<ToothContact> contacts;
  const ExactFlanks &owner = pair.owner->flanks(), &mate = pair.mate->flanks();
  const double near = kMateDistance * std::max(height(owner), height(mate));
  const double of_height = std::min(height(owner), height(mate));
  const bool of_mate = mate.teeth() > owner.teeth();
  for (const FlankMesh& on_owner : pair.owner->meshes())
    for (const FlankMesh& on_mate : pair.mate->meshes()) {
      const FlankPoint at = of_mate ? middle_point(mate, on_mate) : middle_point(owner, on_owner);
      const FlankPoint seen = of_mate ? from_mate(at, placement) : from_owner(at, placement);
      if (!(of_mate ? is_near(seen, owner, on_owner.name, near) : is_near(seen, mate, on_mate.name, near)))
        continue;
      NearFlanks near_ones{{&owner, on_owner.name, &mate, on_mate.name},
                           {&on_owner, &on_mate},
                           {{on_owner.grid.z.front(), on_owner.grid.z.back()},
                            {on_mate.grid.z.front(), on_mate.grid.z.back()}}};
      if (!pair.strips[0].empty()) near_ones.ends.owner = FaceEnds::kNone;
      const Eigen::Vector2d start = owner.chart(on_owner.name, of_mate ? seen.x : at.x);
      const std::vector<NearestPlace> places =
          places_of(pair, near_ones.flanks, near_ones.ends, placement, start);
      if (touches(places, of_height))
        contacts.push_back(make_contact(pair, near_ones, placement, places, close_ones(places, of_height),
                                        {nullptr, nullptr}));
    }
  return contacts;
}

namespace {

// J, what forces f, N, and displacements of the loaded nodes have of the potential but for gaps of flanks.
double potential_beside_flanks(const ToothContact& contact, const Eigen::VectorXd& f,
                               const std::array<Eigen::Matrix3Xd, 2>& of_nodes) {
  double sum = f.dot(contact.local * f) / 2;
  for (std::size_t s : {0, 1}) {
    const ToothContact::Side& side = contact.side[s];
    sum += (of_nodes[s] * side.moving.weight.transpose()).cwiseProduct(side.direction).colwise().sum() * f;
  }
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    sum += contact.own[k].energy(f[i]) + f[i] * (contact.gap[i] - contact.places[k].gap);
  }
  return sum;
}

}  // namespace

// Gaps of flanks are least at their places, so that these do not count to first order.
double change_of_potential(const ToothContact& contact, const Eigen::VectorXd& f,
                           const std::array<Eigen::Matrix3Xd, 2>& of_nodes,
                           const Eigen::Matrix<double, 6, 1>& twist) {
  double change = 0;
  for (std::size_t i = 0; i < contact.places.size(); ++i) {
    const NearestPlace& place = contact.places[i];
    const Eigen::Vector3d x =
        contact.flanks.owner->point(contact.flanks.on_owner, place.v, place.face.centre()).x;
    change -= f[static_cast<Eigen::Index>(i)] * place.n.dot(twist.head<3>() + twist.tail<3>().cross(x));
  }
  const double time = rate_time(contact.flanks, contact.placement, twist);
  if (time == 0) return change;
  const NearestPlace& first = contact.places.front();
  const auto potential_after = [&](double t) {
    const RelativePlacement then = moved(contact.placement, twist, t);
    const ToothContact there = make_contact(
        *contact.pair, {contact.flanks, {contact.side[0].mesh, contact.side[1].mesh}, contact.ends}, then,
        places_of(*contact.pair, contact.flanks, contact.ends, then, {first.v, first.face.centre()}),
        contact.number, {&contact.side[0].moving.node, &contact.side[1].moving.node});
    return potential_beside_flanks(there, f, of_nodes);
  };
  return change + (potential_after(time) - potential_after(-time)) / (2 * time);
}

}  // namespace elastogear::contact
