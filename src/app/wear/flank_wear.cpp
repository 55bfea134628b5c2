#include "app/wear/flank_wear.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "elastogear/base/error.h"
#include "elastogear/io/result_file.h"
#include "elastogear/life/revolution.h"
#include "elastogear/model/face_point.h"

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

std::optional<gear::Flank> flank_of_face(const model::Surface& surface, int face) {
  return gear::flank_of(surface.group_name[static_cast<std::size_t>(surface.group[face])]);
}

// Moves a point near the flank onto it: faces lie off the flank.
Eigen::Vector3d on_flank(const gear::Toothing& t, const gear::Flank& flank, const Eigen::Vector3d& x) {
  return x - gear::flank_distance(t, flank.tooth, flank.side, x) * gear::flank_normal(t, flank, x);
}

// Place of a contact on both flanks, slave and master: points (m, world) and lengths of roll (m).
struct Touch {
  Eigen::Vector3d x_W[2];
  double u[2] = {0, 0};
};

// Place by the closest point of the master's face.
Touch touch_of_point(const Placed* const at[2], const gear::Flank (&flank)[2],
                     const model::ContactRecord& contact) {
  Touch touch;
  Eigen::Vector3d x_W =
      at[1]->r + at[1]->R * model::point_on_face(at[1]->gear->surface, contact.face, contact.xi, contact.eta);
  for (int i : {1, 0}) {
    const gear::Toothing& t = at[i]->gear->member->toothing;
    const Eigen::Vector3d x = on_flank(t, flank[i], at[i]->R.transpose() * (x_W - at[i]->r));
    touch.u[i] = gear::length_of_roll(t, x.head<2>().norm());
    touch.x_W[i] = x_W = at[i]->r + at[i]->R * x;
  }
  return touch;
}

// The line of action of two external gears, away from the first one, on the side of `normal`; zero where base
// circles overlap.
Eigen::Vector3d line_of_action(const Placed& from, const Placed& to, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d axis = from.R.col(2), between = to.r - from.r;
  const Eigen::Vector3d across = between - axis * axis.dot(between);
  const double cosine = (from.gear->member->toothing.r_b + to.gear->member->toothing.r_b) / across.norm();
  if (cosine >= 1) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d c = across.normalized(), t = axis.cross(c);
  return std::sqrt(1 - cosine * cosine) * c + std::copysign(cosine, normal.dot(t)) * t;
}

// Moves the place of a contact onto the line of action, where involutes touch: points of contact sit
// somewhere in faces that may be as long as the line moves in several steps. Beyond the flank of one of both,
// where the edge of a tip bears, it stays where it is. force: on the slave.
void move_onto_line(const Placed* const at[2], const gear::Flank (&flank)[2], const Eigen::Vector3d& force,
                    Touch& touch) {
  Touch moved = touch;
  for (int i = 0; i < 2; ++i) {
    const gear::Toothing& t = at[i]->gear->member->toothing;
    if (t.internal) return;
    const Eigen::Vector3d e = line_of_action(*at[i], *at[1 - i], i == 0 ? -force : force);
    const Eigen::Vector3d foot = -flank[i].side * at[i]->R.col(2).cross(e),
                          foot_gear = at[i]->R.transpose() * foot;
    const double z = (at[i]->R.transpose() * (touch.x_W[i] - at[i]->r))[2];
    const double turn =
        std::atan2(foot_gear[1], foot_gear[0]) - gear::tooth_angle(t, flank[i].tooth) - z / t.p;
    moved.u[i] = t.r_b * (t.psi_b - flank[i].side * std::remainder(turn, 2 * pi));
    if (!(moved.u[i] >= at[i]->gear->cells.u[0] && moved.u[i] <= at[i]->gear->cells.u.tail<1>()[0])) return;
    moved.x_W[i] = at[i]->r + at[i]->R.col(2) * z + t.r_b * foot + moved.u[i] * e;
  }
  touch = moved;
}

// The track of a contact over one step: along the profile as far as it rolls on, across the face by the layer
// of the mesh that its force stands for.
life::ContactTrack track(const Placed& at, const Touch& touch, int i, double layer, double step) {
  const double b = at.gear->member->width / 2, du = at.gear->member->toothing.r_b * at.w.norm() * step / 2;
  const double z = std::clamp((at.R.transpose() * (touch.x_W[i] - at.r))[2], -b, b);
  return {{touch.u[i] - du, touch.u[i] + du}, {std::max(-b, z - layer / 2), std::min(b, z + layer / 2)}};
}

// step: pitches from one position to the next. weight: of what is worn there.
void add_contact(const model::ContactRecord& contact, const Placed (&of_pair)[2], double step, double weight,
                 std::vector<PassedVolume>& volumes) {
  const Placed* const at[2] = {&of_pair[contact.slave_side], &of_pair[1 - contact.slave_side]};
  const auto slave = at[0]->gear->flank[static_cast<std::size_t>(contact.slave_node)],
             master = flank_of_face(at[1]->gear->surface, contact.face);
  if (!slave || !master) return;
  const gear::Flank flanks[2] = {*slave, *master};
  Touch touch = touch_of_point(at, flanks, contact);
  move_onto_line(at, flanks, contact.f, touch);
  const Eigen::Vector3d n = contact.f.normalized(), x_W = touch.x_W[1];
  const Eigen::Vector3d v = at[0]->w.cross(x_W - at[0]->r) - at[1]->w.cross(x_W - at[1]->r);
  const double volume = contact.f.norm() * (v - n * n.dot(v)).norm() * step * weight;
  if (!(volume > 0)) return;
  for (int i = 0; i < 2; ++i)
    life::lay_volume(at[i]->gear->cells, track(*at[i], touch, i, at[0]->gear->layer, step), volume,
                     volumes[at[i]->member].of[flanks[i].side > 0 ? 0 : 1]);
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
  gear.flank.resize(s.node.size());
  std::set<long> planes;
  for (int f = 0; f < s.face.cols(); ++f)
    if (const auto flank = flank_of_face(s, f))
      for (int node : s.face.col(f)) {
        gear.flank[static_cast<std::size_t>(node)] = flank;
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
