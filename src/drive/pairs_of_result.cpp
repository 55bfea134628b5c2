#include <algorithm>
#include <array>
#include <cmath>

#include "drive/pair_of_run.h"
#include "drive/result_parts.h"
#include "elastogear/base/error.h"

namespace elastogear::drive {
namespace {

using evaluation::Gear, evaluation::PairOfRun;

// Zeros in the run of a system of bodies.
model::DriveInput input_of(const DriveResult& result) {
  return result.header.input->drive.value_or(model::DriveInput{});
}

// A gear at the times of a result.
Gear moving_gear(const DriveOfResults& of, const DriveResult& result, const std::string& name) {
  Gear gear = gear_of(member_of(of.drive, name, result.path));
  const io::BodyHistory history = io::read_joint_history(result.path, name);
  for (int step : result.steps) {
    gear.position.push_back(history.r_WB.col(step));
    gear.rotation.push_back(rotation_at(history, step));
  }
  return gear;
}

// Flanks may be meshed with their deviations: what is farther off belongs to another gear.
void require_teeth(const evaluation::Flanks& flanks, const Gear& gear, const std::string& file) {
  constexpr double kOff = 0.02;  // of the tooth's height
  const double most = kOff * std::abs(gear.toothing.r_a - gear.toothing.r_f);
  const model::Surface& surface = *flanks.surface;
  for (std::size_t node = 0; node < flanks.of_node.size(); ++node)
    if (const auto& flank = flanks.of_group[flanks.of_node[node]])
      require(std::abs(gear::flank_distance(gear.toothing, flank->tooth, flank->side,
                                            surface.X.col(static_cast<Eigen::Index>(node)))) < most,
              file, ": node ", surface.node[node], " of body '", gear.name,
              "' is not on its flank: the drive file is not that of the run");
}

Eigen::VectorXd rolls(const DriveOfResults& of, const DriveResult& result) {
  const double roll = input_of(result).roll;
  if (result.analysis == Analysis::motion)
    return evaluation::roll_of_run(moving_gear(of, result, of.drive.members.front().name), roll);
  if (result.analysis == Analysis::equilibrium) return Eigen::VectorXd::Constant(1, roll);
  return result.time(result.steps);
}

// The held gear of a sweep stands at its nominal angles.
void require_roll_angles(const PairOfRun& pair, const std::string& path) {
  constexpr double kMost = 0.25;  // pitches, by which elastic gears turn against each other
  for (const Gear& gear : pair.gear) {
    const Eigen::VectorXd nominal = evaluation::nominal_angles(gear, pair.first_teeth, pair.roll);
    const double off = (evaluation::angles(gear, nominal) - nominal).cwiseAbs().maxCoeff();
    require(off < kMost * evaluation::pitch(gear), path, ": ", gear.name, " stands ",
            off / evaluation::pitch(gear),
            " pitches off its place at the roll angles of this drive: the drive file is not that of the run");
  }
}

void read_times(const DriveResult& result, const model::ResultHeader::Pair& of_pair,
                const std::array<evaluation::Flanks, 2>& flanks, PairOfRun& pair) {
  const io::PairHistory history = io::read_pair_history(result.path, of_pair.name);
  const auto contacts = io::read_contacts(result.path, of_pair.name);
  std::array<io::BodyHistory, 2> body;
  for (std::size_t g : {0, 1}) body[g] = io::read_joint_history(result.path, pair.gear[g].name);
  for (int step : result.steps)
    add_time({{body[0].r_WB.col(step), body[1].r_WB.col(step)},
              {rotation_at(body[0], step), rotation_at(body[1], step)},
              history.force.col(step),
              history.torque.col(step),
              contacts[static_cast<std::size_t>(step)]},
             flanks, pair);
  pair.slave_side = evaluation::slave_side(contacts);
}

}  // namespace

PairOfRun read_pair(const DriveOfResults& of, const DriveResult& result,
                    const model::ResultHeader::Pair& of_pair, BodyFiles& bodies) {
  PairOfRun pair;
  std::array<evaluation::Flanks, 2> flanks;
  for (std::size_t g : {0, 1}) {
    const std::string& name = result.header.bodies[of_pair.body[g]].name;
    pair.gear[g] = gear_of(member_of(of.drive, name, result.path));
    flanks[g] = evaluation::flanks(pair.gear[g].toothing, elastic_body(of, result, name, bodies).surface);
    require_teeth(flanks[g], pair.gear[g], body_file(of, result, name));
    pair.gear[g].layers = evaluation::node_layers(flanks[g]);
    pair.compliance[g] = bodies.compliance(body_file(of, result, name));
  }
  make_room(result.steps.size(), pair);
  pair.roll = rolls(of, result);
  if (result.analysis == Analysis::motion) pair.time = result.time(result.steps);
  pair.first_teeth = of.drive.members.front().toothing.z;
  pair.sense = of.coasts ? -1 : 1;
  pair.turning = result.analysis == Analysis::sweep ? 1 : pair.sense;
  const bool takes_speed =
      result.analysis != Analysis::motion && of_pair.friction == 0 && of.speed.has_value();
  pair.speed = std::abs(takes_speed ? *of.speed : input_of(result).speed);
  pair.strips = of_pair.strips;
  pair.friction = of_pair.friction;
  read_times(result, of_pair, flanks, pair);
  if (result.analysis != Analysis::motion) require_roll_angles(pair, result.path);
  evaluation::take_hertz(pair);
  return pair;
}

}  // namespace elastogear::drive
