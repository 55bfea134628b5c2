#include "app/wear/flank_wear.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "elastogear/evaluation/contact.h"
#include "elastogear/evaluation/face_stations.h"
#include "elastogear/io/result_file.h"
#include "elastogear/life/revolution.h"
#include "elastogear/model/face_point.h"

namespace elastogear::app {
namespace {

using std::numbers::pi;

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

// The track over one step of what a contact leaves in one part of the face: along the profile as far as it
// rolls on, from its place moved along the line of contact to the middle of that part.
life::ContactTrack track(const Placed& at, int side, double u, double z, const double* part, double step) {
  const gear::Toothing& t = at.gear->member->toothing;
  const double du = t.r_b * at.w.norm() * step / 2,
               moved = u + side * t.r_b / t.p * ((part[0] + part[1]) / 2 - z);
  return {{moved - du, moved + du}, {part[0], part[1]}};
}

// Shares the volume of a contact out to the stations of one gear's face, and lays it on the parts that these
// stand for.
void lay_over_face(const Placed& at, const gear::Flank& flank, double u, const Eigen::Vector3d& x_W,
                   const evaluation::FaceStations& stations, double step, double volume,
                   Eigen::MatrixXd& sum) {
  const double z = (at.R.transpose() * (x_W - at.r))[2];
  const auto [station, share] = evaluation::share_out(stations, z);
  for (std::size_t k : {0, 1})
    if (share[k] > 0)
      life::lay_volume(at.gear->cells, track(at, flank.side, u, z, &stations.ends[station[k]], step),
                       share[k] * volume, sum);
}

// stations: over the face of each gear of the pair. step: pitches from one position to the next. weight:
// of what is worn there.
void add_contact(const model::ContactRecord& contact, const Placed (&of_pair)[2],
                 const evaluation::FaceStations (&stations)[2], double step, double weight,
                 std::vector<PassedVolume>& volumes) {
  const int of[2] = {contact.slave_side, 1 - contact.slave_side};
  const Placed* const at[2] = {&of_pair[of[0]], &of_pair[of[1]]};
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
    lay_over_face(*at[i], flanks[i], touch.u[i], touch.x_W[i], stations[of[i]], step, volume,
                  volumes[at[i]->member].of[flanks[i].side > 0 ? 0 : 1]);
}

// The gear as evaluations know it, where its face is.
evaluation::Gear gear_of(const Placed& at) {
  evaluation::Gear gear;
  gear.toothing = at.gear->member->toothing;
  gear.width = at.gear->member->width;
  gear.ratio = at.gear->member->ratio;
  gear.R = at.R;
  gear.position = {at.r};
  gear.layers = at.gear->layers;
  return gear;
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
  for (int f = 0; f < s.face.cols(); ++f)
    if (const auto flank = flank_of_face(s, f))
      for (int node : s.face.col(f)) gear.flank[static_cast<std::size_t>(node)] = flank;
  require(
      std::any_of(gear.flank.begin(), gear.flank.end(), [](const auto& flank) { return flank.has_value(); }),
      "wear of ", member.name, ": its body has no faces of flanks");
  gear.layers = evaluation::node_layers(evaluation::flanks(t, s));
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
    const auto placed = [&](int i, std::size_t t) -> Placed {
      const auto column = static_cast<Eigen::Index>(t);
      const Eigen::Matrix3d R = rotation_at(history[of[i]], column);
      return {&gears[of[i]], of[i], history[of[i]].r_WB.col(column),
              pitch * drive.members[of[i]].ratio * R.col(2), R};
    };
    const evaluation::Gear first = gear_of(placed(0, 0)), second = gear_of(placed(1, 0));
    const int slave = evaluation::slave_side(contacts);
    const evaluation::FaceStations stations[2] = {
        evaluation::stations({&first, &second}, slave, pair.strips, 0),
        evaluation::stations({&first, &second}, slave, pair.strips, 1)};
    for (std::size_t t = 0; t < contacts.size(); ++t) {
      const Placed at[2] = {placed(0, t), placed(1, t)};
      for (const model::ContactRecord& contact : contacts[t])
        add_contact(contact, at, stations, step, 1.0 / sweep.pitches, volumes);
    }
  }
  return volumes;
}

double largest_depth(const WearingGear& gear) {
  return std::max(gear.depth[0].maxCoeff(), gear.depth[1].maxCoeff());
}

double worn_mass(const WearingGear& gear, const Eigen::MatrixXd (&depth)[2]) {
  const life::FlankCells& cells = gear.cells;
  double volume = 0;
  for (const Eigen::MatrixXd& of_side : depth)
    for (Eigen::Index i = 0; i < cells.n_u(); ++i)
      for (Eigen::Index j = 0; j < cells.n_v(); ++j)
        volume += of_side(i, j) * cells.length[i] * (cells.v[j + 1] - cells.v[j]);
  return gear.material.density * gear.member->toothing.z * volume;
}

}  // namespace elastogear::app
