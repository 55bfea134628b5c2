#include "contact/stations/point_contact.h"

#include <algorithm>
#include <cmath>

#include "contact/stations/flank_gap.h"
#include "contact/stations/flank_mesh.h"
#include "contact/stations/flank_size.h"
#include "contact/stations/smooth_load.h"

namespace elastogear::contact {
namespace {

constexpr double kNear = 1.5;        // of a flank's height, that a mate's flank in contact may be away
constexpr double kPlaceStep = 1e-4;  // of the size of a load, by which it is moved for rates

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

PointLoad point_load(const FlankMesh& mesh, const ExactFlanks& flanks, double v, double z) {
  const LoadWidth width = load_width(mesh.grid);
  const double h_v = kPlaceStep * width.a, h_z = kPlaceStep * width.c;
  const auto weight = [&](double at_v, double at_z) { return point_weights(mesh.grid, at_v, at_z, width); };
  const auto smooth = [&](double at_v, double at_z) {
    return point_kernel(mesh.grid, at_v, at_z, width, line_scale(flanks.point(mesh.name, at_v, at_z), 0));
  };
  const Eigen::RowVectorXd all = weight(v, z), all_v = (weight(v + h_v, z) - weight(v - h_v, z)) / (2 * h_v),
                           all_z = (weight(v, z + h_z) - weight(v, z - h_z)) / (2 * h_z);
  std::vector<int> loaded;
  for (int a = 0; a < all.size(); ++a)
    if (all[a] != 0 || all_v[a] != 0 || all_z[a] != 0) loaded.push_back(a);
  std::sort(loaded.begin(), loaded.end(), [&](int a, int b) {
    return mesh.node[static_cast<std::size_t>(a)] < mesh.node[static_cast<std::size_t>(b)];
  });
  PointLoad load{{}, all(loaded), all_v(loaded), all_z(loaded), smooth(v, z), 0, 0};
  for (int a : loaded) load.node.push_back(mesh.node[static_cast<std::size_t>(a)]);
  load.smooth_v = (smooth(v + h_v, z) - smooth(v - h_v, z)) / (4 * h_v);
  load.smooth_z = (smooth(v, z + h_z) - smooth(v, z - h_z)) / (4 * h_z);
  return load;
}

StationLaw law_at(const ToothContact& contact, const RelativePlacement& placement, const NearestPlace& place,
                  double compliance) {
  const double h = kWidth * height(*contact.flanks.owner);
  const PrincipalCurvatures at = curvatures(contact.flanks, contact.ends, placement, place, h);
  return point_law(at.least, at.largest, compliance);
}

ToothContact::Side make_side(const FlankMesh& mesh, const ExactFlanks& flanks, double v, double z,
                             const Eigen::Vector3d& direction) {
  return {mesh.name, &mesh, nullptr, {}, {v}, {z}, direction, point_load(mesh, flanks, v, z)};
}

ToothContact make_contact(const ToothedPair& pair, const FlankMesh& on_owner, const FlankMesh& on_mate,
                          const FlankPair& flanks, const FaceEnds& ends, const RelativePlacement& placement,
                          const NearestPlace& place) {
  ToothContact contact{flanks, placement, {place}, {}, ends, {}, {}, {}};
  contact.side = {
      make_side(on_owner, *flanks.owner, place.v, place.face.centre(), place.n),
      make_side(on_mate, *flanks.mate, place.mate_v, place.mate_z, -(placement.R.transpose() * place.n))};
  contact.gap.resize(1);
  contact.gap[0] = place.gap - pair.owner->deviation(on_owner, place.v, place.face.centre()) -
                   pair.mate->deviation(on_mate, place.mate_v, place.mate_z);
  contact.local.resize(1, 1);
  contact.local(0, 0) = -pair.owner->compliance() * contact.side[0].point.smooth -
                        pair.mate->compliance() * contact.side[1].point.smooth;
  contact.own = {law_at(contact, placement, place, pair.owner->compliance() + pair.mate->compliance())};
  return contact;
}

}  // namespace

// Near each other are those whose middle of the gear with more teeth is near the flank of the other, which
// may be a thread of several turns.
std::vector<ToothContact> point_contacts(const ToothedPair& pair, const RelativePlacement& placement) {
  std::vector<ToothContact> contacts;
  const ExactFlanks &owner = pair.owner->flanks(), &mate = pair.mate->flanks();
  const double near = kNear * std::max(height(owner), height(mate));
  const double of_height = std::min(height(owner), height(mate));
  const bool of_mate = mate.teeth() > owner.teeth();
  for (const FlankMesh& on_owner : pair.owner->meshes())
    for (const FlankMesh& on_mate : pair.mate->meshes()) {
      const FlankPoint at = of_mate ? middle_point(mate, on_mate) : middle_point(owner, on_owner);
      const FlankPoint seen = of_mate ? from_mate(at, placement) : from_owner(at, placement);
      if (!(of_mate ? is_near(seen, owner, on_owner.name, near) : is_near(seen, mate, on_mate.name, near)))
        continue;
      const FlankPair flanks{&owner, on_owner.name, &mate, on_mate.name};
      const FaceEnds ends{{on_owner.grid.z.front(), on_owner.grid.z.back()},
                          {on_mate.grid.z.front(), on_mate.grid.z.back()}};
      const Eigen::Vector2d start = owner.chart(on_owner.name, of_mate ? seen.x : at.x);
      const NearestPlace place = nearest_point(flanks, ends, placement, start);
      if (place.gap < kReach * of_height && place.flank_gap > -kDeepest * of_height)
        contacts.push_back(make_contact(pair, on_owner, on_mate, flanks, ends, placement, place));
    }
  return contacts;
}

double change_at_point(const ToothContact& contact, double f, const std::array<PotentialSlopes, 2>& slopes,
                       const Eigen::Matrix<double, 6, 1>& twist) {
  if (!(f > 0)) return 0;
  const NearestPlace& here = contact.places[0];
  const double z = here.face.centre();
  const Eigen::Vector3d x = contact.flanks.owner->point(contact.flanks.on_owner, here.v, z).x;
  double change = -f * here.n.dot(twist.head<3>() + twist.tail<3>().cross(x));  // the gap itself
  const double time = rate_time(contact.flanks, contact.placement, twist);
  if (time == 0) return change;
  const RelativePlacement then = moved(contact.placement, twist, time);
  const NearestPlace there = nearest_point(contact.flanks, contact.ends, then, {here.v, z});
  const Eigen::Vector3d n = there.n - here.n;
  const Eigen::Vector3d mate_n = then.R.transpose() * there.n - contact.placement.R.transpose() * here.n;
  const StationLaw law_there = law_at(contact, then, there, contact.own[0].compliance);
  const double places = slopes[0].v[0] * (there.v - here.v) + slopes[0].z[0] * (there.face.centre() - z) +
                        slopes[1].v[0] * (there.mate_v - here.mate_v) +
                        slopes[1].z[0] * (there.mate_z - here.mate_z);
  const double directions = slopes[0].direction.col(0).dot(n) - slopes[1].direction.col(0).dot(mate_n);
  return change + (places + directions + law_there.energy(f) - contact.own[0].energy(f)) / time;
}

}  // namespace elastogear::contact
