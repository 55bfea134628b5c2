#include "drive/pair_of_run.h"

#include <cmath>

#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/dynamics/station_choice.h"

namespace elastogear::drive {
namespace {

using evaluation::PairOfRun;

PairAtTime pair_at(const model::Snapshot& now, const dynamics::PairSetup& setup, std::size_t pair) {
  const model::BodyState &first = now.bodies[static_cast<std::size_t>(setup.body[0])],
                         &second = now.bodies[static_cast<std::size_t>(setup.body[1])];
  const model::PairState& of = now.pairs[pair];
  return {{first.r_WB, second.r_WB}, {first.R_WB, second.R_WB}, of.force, of.torque, of.contacts};
}

}  // namespace

evaluation::Gear gear_of(const Member& member) {
  evaluation::Gear gear;
  gear.name = member.name;
  gear.toothing = member.toothing;
  gear.width = member.width;
  gear.ratio = member.ratio;
  gear.angle = member.angle;
  gear.R = rotation_matrix(member.rotation);
  gear.origin = member.position;
  return gear;
}

void make_room(std::size_t n_t, PairOfRun& pair) {
  const auto n = static_cast<Eigen::Index>(n_t);
  pair.roll.resize(n);
  pair.force.resize(3, n);
  pair.torque.resize(3, n);
}

void add_time(const PairAtTime& now, const std::array<evaluation::Flanks, 2>& flanks, PairOfRun& pair) {
  for (std::size_t g : {0, 1}) {
    pair.gear[g].position.push_back(now.r_WB[g]);
    pair.gear[g].rotation.push_back(now.R_WB[g]);
  }
  const auto i = static_cast<Eigen::Index>(pair.contacts.size());
  pair.force.col(i) = now.force;
  pair.torque.col(i) = now.torque;
  pair.contacts.push_back(
      evaluation::flank_contacts(now.contacts, {&pair.gear[0], &pair.gear[1]}, flanks, pair.contacts.size()));
}

PairOfRun pair_of_sweep(const Drive& drive, std::size_t pair, const Operation& operation,
                        const dynamics::SystemModel& model, const std::vector<model::Snapshot>& positions) {
  require(!positions.empty(), "a pair of gears at no position cannot be evaluated");
  const dynamics::PairSetup& setup = model.pairs.at(pair);
  PairOfRun run;
  std::array<evaluation::Flanks, 2> flanks;
  for (std::size_t g : {0, 1}) {
    const dynamics::SystemModel::Body& body = model.bodies[static_cast<std::size_t>(setup.body[g])];
    run.gear[g] = gear_of(drive.members.at(static_cast<std::size_t>(setup.body[g])));
    flanks[g] = evaluation::flanks(run.gear[g].toothing, body.eq.body->surface);
    run.gear[g].layers = evaluation::node_layers(flanks[g]);
    run.compliance[g] = body.surface_compliance;
  }
  run.first_teeth = drive.members.front().toothing.z;
  run.sense = operation.torque < 0 ? -1 : 1;
  run.speed = std::abs(operation.speed);
  run.friction = setup.settings.friction.mu;
  run.strips = dynamics::strips_of(model, setup);
  make_room(positions.size(), run);
  std::vector<std::vector<model::ContactRecord>> contacts;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    run.roll[static_cast<Eigen::Index>(i)] = positions[i].time;
    contacts.push_back(positions[i].pairs[pair].contacts);
    add_time(pair_at(positions[i], setup, pair), flanks, run);
  }
  run.slave_side = evaluation::slave_side(contacts);
  evaluation::take_hertz(run);
  return run;
}

}  // namespace elastogear::drive
