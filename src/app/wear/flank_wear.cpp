#include "app/wear/flank_wear.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "elastogear/base/error.h"
#include "elastogear/contact/face.h"
#include "elastogear/gear/flank.h"
#include "elastogear/io/result_file.h"
#include "elastogear/life/revolution.h"

namespace elastogear::app {
namespace {

using std::numbers::pi;

constexpr double kSamePlane = 1e-6;  // m, of nodes across the face

// The two gears of a pair at one position.
struct Placed {
  const WearingGear* gear = nullptr;
  std::size_t member = 0;
  Eigen::Vector3d r = {}, w = {};  // m; rad per pitch of the first gear, in the world
  Eigen::Matrix3d R = {};
};

int side_of_face(const model::Surface& surface, int face) {
  const auto flank = gear::flank_of(surface.group_name[static_cast<std::size_t>(surface.group[face])]);
  return flank ? flank->side : 0;
}

// Point of a master face in its body frame, m.
Eigen::Vector3d point_on_face(const model::Surface& surface, const model::ContactRecord& contact) {
  const auto nodes = surface.face.col(contact.face);
  const int sides = nodes[2] == nodes[3] ? 3 : 4;
  const contact::Shape shape = contact::shape(sides, contact.xi, contact.eta);
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int i = 0; i < sides; ++i) x += shape.N[i] * surface.X.col(nodes[i]);
  return x;
}

// The track of a contact over one step: along the profile as far as it rolls on, across the face by the layer
// of the mesh that its force stands for.
life::ContactTrack track(const Placed& at, const Eigen::Vector3d& x_W, double layer, double step) {
  const gear::Toothing& t = at.gear->member->toothing;
  const Eigen::Vector3d x = at.R.transpose() * (x_W - at.r);
  const double u = gear::length_of_roll(t, x.head<2>().norm()), b = at.gear->member->width / 2;
  const double du = t.r_b * at.w.norm() * step / 2, z = std::clamp(x[2], -b, b);
  return {{u - du, u + du}, {std::max(-b, z - layer / 2), std::min(b, z + layer / 2)}};
}

// step: pitches from one position to the next. weight: of what is worn there.
void add_contact(const model::ContactRecord& contact, const Placed (&at)[2], double step, double weight,
                 std::vector<PassedVolume>& volumes) {
  const Placed &slave = at[contact.slave_side], &master = at[1 - contact.slave_side];
  const int sides[2] = {slave.gear->side[static_cast<std::size_t>(contact.slave_node)],
                        side_of_face(master.gear->surface, contact.face)};
  if (sides[0] == 0 || sides[1] == 0) return;
  const Eigen::Vector3d X = point_on_face(master.gear->surface, contact), x_W = master.r + master.R * X;
  const Eigen::Vector3d n = contact.f.normalized();
  const Eigen::Vector3d v = slave.w.cross(x_W - slave.r) - master.w.cross(x_W - master.r);
  const double volume = contact.f.norm() * (v - n * n.dot(v)).norm() * step * weight;
  if (!(volume > 0)) return;
  const Placed* both[2] = {&slave, &master};
  for (int i = 0; i < 2; ++i)
    life::lay_volume(both[i]->gear->cells, track(*both[i], x_W, slave.gear->layer, step), volume,
                     volumes[both[i]->member].of[sides[i] > 0 ? 0 : 1]);
}

std::size_t number_of(const Drive& drive, const std::string& name) {
  const auto& members = drive.members;
  return static_cast<std::size_t>(
      std::find_if(members.begin(), members.end(), [&](const auto& m) { return m.name == name; }) -
      members.begin());
}

Eigen::Matrix3d rotation_at(const io::BodyHistory& history, Eigen::Index t) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(history.R_WB.col(t).data());
}

}  // namespace

WearingGear wearing_gear(const DriveMember& member, const WearMaterial& material,
                         const WearSettings& settings, model::Surface surface) {
  const gear::Toothing& t = member.toothing;
  require(t.r_b > 0, "wear of ", member.name, ": is for involute flanks, which this gear has not");
  WearingGear gear{.member = &member, .material = material, .surface = std::move(surface)};
  const model::Surface& s = gear.surface;
  gear.side.resize(s.node.size(), 0);
  std::set<long> planes;
  for (int f = 0; f < s.face.cols(); ++f)
    if (const int side = side_of_face(s, f); side != 0)
      for (int node : s.face.col(f)) {
        gear.side[static_cast<std::size_t>(node)] = side;
        planes.insert(std::lround(s.X(2, node) / kSamePlane));
      }
  require(planes.size() > 1, "wear of ", member.name, ": its body has no faces of flanks");
  gear.layer = static_cast<double>(*planes.rbegin() - *planes.begin()) * kSamePlane /
               static_cast<double>(planes.size() - 1);
  const double along[] = {gear::length_of_roll(t, t.r_form), gear::length_of_roll(t, t.r_a)};
  const double slant = 1 / std::cos(t.beta_b);
  gear.cells = life::flank_cells({std::min(along[0], along[1]), std::max(along[0], along[1])},
                                 {-member.width / 2, member.width / 2}, settings.along, settings.across,
                                 [&](double u) { return slant * life::involute_arc(u, t.r_b); });
  for (Eigen::MatrixXd& depth : gear.depth) depth.setZero(settings.along, settings.across);
  return gear;
}

std::vector<PassedVolume> passed_volume(const std::string& result, const Drive& drive,
                                        const std::vector<WearingGear>& gears) {
  const life::Sweep sweep = life::find_sweep(result, io::read_times(result));
  std::vector<PassedVolume> volumes(gears.size());
  for (std::size_t i = 0; i < gears.size(); ++i)
    for (Eigen::MatrixXd& volume : volumes[i].of) volume.setZero(gears[i].cells.n_u(), gears[i].cells.n_v());
  std::vector<io::BodyHistory> history;
  for (const DriveMember& member : drive.members)
    history.push_back(io::read_joint_history(result, member.name));
  const double pitch = 2 * pi / drive.members.front().toothing.z, step = 1.0 / sweep.per_pitch;
  for (const model::ResultHeader::Pair& pair : io::read_result_header(result).pairs) {
    const auto contacts = io::read_contacts(result, pair.name);
    const auto colon = pair.name.find(':');
    const std::size_t of[2] = {number_of(drive, pair.name.substr(0, colon)),
                               number_of(drive, pair.name.substr(colon + 1))};
    for (std::size_t t = 0; t < contacts.size(); ++t) {
      Placed at[2];
      for (int i = 0; i < 2; ++i) {
        const auto column = static_cast<Eigen::Index>(t);
        const Eigen::Matrix3d R = rotation_at(history[of[i]], column);
        at[i] = {&gears[of[i]], of[i], history[of[i]].r_WB.col(column),
                 pitch * drive.members[of[i]].ratio * R.col(2), R};
      }
      for (const model::ContactRecord& contact : contacts[t])
        add_contact(contact, at, step, 1.0 / sweep.pitches, volumes);
    }
  }
  return volumes;
}

double largest_depth(const WearingGear& gear) {
  return std::max(gear.depth[0].maxCoeff(), gear.depth[1].maxCoeff());
}

double worn_mass(const WearingGear& gear) {
  const life::FlankCells& cells = gear.cells;
  double volume = 0;
  for (const Eigen::MatrixXd& depth : gear.depth)
    for (Eigen::Index i = 0; i < cells.n_u(); ++i)
      for (Eigen::Index j = 0; j < cells.n_v(); ++j)
        volume += depth(i, j) * cells.length[i] * (cells.v[j + 1] - cells.v[j]);
  return gear.material.density * gear.member->toothing.z * volume;
}

}  // namespace elastogear::app
