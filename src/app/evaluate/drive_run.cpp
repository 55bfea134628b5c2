#include "app/evaluate/drive_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/console/plausibility.h"
#include "app/gear/bearing_options.h"
#include "app/gear/drive_options.h"
#include "app/setup/drive_input.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/drive/finite_elements.h"
#include "elastogear/drive/pair_of_run.h"
#include "elastogear/drive/surface_compliance.h"
#include "elastogear/io/body_file.h"
#include "elastogear/model/fingerprint.h"
#include "elastogear/recovery/recover.h"

namespace elastogear::app {
namespace {

using evaluation::Gear, evaluation::PairOfRun;

using model::Analysis;

// A result file with the times that count.
struct Source {
  std::string path;
  model::ResultHeader header;
  Analysis analysis = Analysis::sweep;
  Eigen::VectorXd time;    // all
  std::vector<int> steps;  // that count
};

// Zeros in the run of a system of bodies.
model::DriveInput drive_of(const Source& source) {
  return source.header.input->drive.value_or(model::DriveInput{});
}

Analysis analysis_of(const std::string& path, const std::optional<model::RunInput>& input) {
  const bool serves = input && input->analysis != Analysis::relaxation;
  require(serves, path, ": is the result of analysis: ",
          input ? model::analysis_names()[static_cast<std::size_t>(input->analysis)] : "unknown",
          "; evaluate reads those of sweep, static and dynamic");
  return input->analysis;
}

std::vector<int> steps_of(const Source& source, const EvaluateSettings& settings) {
  const int n = static_cast<int>(source.time.size());
  std::vector<int> steps;
  const bool spans = source.analysis == Analysis::motion;
  require(spans || (!settings.from && !settings.to), source.path,
          ": options -from and -to are for runs in time (analysis: dynamic)");
  for (int i = source.analysis == Analysis::equilibrium ? n - 1 : 0; i < n; ++i)
    if (source.time[i] >= settings.from.value_or(-INFINITY) &&
        source.time[i] <= settings.to.value_or(INFINITY))
      steps.push_back(i);
  require(!steps.empty(), source.path, ": has no times between -from and -to; it reaches from ",
          source.time[0], " to ", source.time[n - 1], " s");
  return steps;
}

Source open_source(const DriveOfRun& of, const std::string& path) {
  Source source{path, io::read_result_header(path), Analysis::sweep, io::read_times(path), {}};
  require(source.time.size() > 0, path, ": holds no times");
  source.analysis = analysis_of(path, source.header.input);
  source.steps = steps_of(source, of.settings);
  require_input(of.options, path);
  return source;
}

const DriveMember& member_of(const Drive& drive, const std::string& name, const std::string& path) {
  for (const DriveMember& member : drive.members)
    if (member.name == name) return member;
  fail(path, ": body '", name, "' is no gear of the drive file: name the result of this drive by -result");
}

Eigen::Matrix3d rotation_at(const io::BodyHistory& history, int step) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(history.R_WB.col(step).data());
}

Gear gear_of(const DriveOfRun& of, const Source& source, const std::string& name) {
  Gear gear = drive::gear_of(member_of(of.drive, name, source.path));
  const io::BodyHistory history = io::read_joint_history(source.path, name);
  for (int step : source.steps) {
    gear.position.push_back(history.r_WB.col(step));
    gear.rotation.push_back(rotation_at(history, step));
  }
  return gear;
}

std::string file_of_body(const DriveOfRun& of, const Source& source, const std::string& name) {
  if (const auto moved = of.settings.body_file.find(name); moved != of.settings.body_file.end())
    return moved->second;
  for (const auto& body : source.header.bodies)
    if (body.name == name && !body.file.empty()) return body.file;
  return body_file(of.options, member_of(of.drive, name, source.path));
}

const model::ElasticBody& elastic_body(const DriveOfRun& of, Bodies& bodies, const Source& source,
                                       const std::string& name) {
  const auto identity = source.header.provenance.find(model::identity_key(name));
  return bodies.get(file_of_body(of, source, name), name, source.path,
                    identity == source.header.provenance.end() ? "" : identity->second);
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

Eigen::VectorXd rolls(const DriveOfRun& of, const Source& source) {
  const double roll = drive_of(source).roll;
  if (source.analysis == Analysis::motion)
    return evaluation::roll_of_run(gear_of(of, source, of.drive.members.front().name), roll);
  if (source.analysis == Analysis::equilibrium) return Eigen::VectorXd::Constant(1, roll);
  return source.time(source.steps);
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

void read_times(const Source& source, const model::ResultHeader::Pair& of_pair,
                const std::array<evaluation::Flanks, 2>& flanks, PairOfRun& pair) {
  const io::PairHistory history = io::read_pair_history(source.path, of_pair.name);
  const auto contacts = io::read_contacts(source.path, of_pair.name);
  std::array<io::BodyHistory, 2> body;
  for (std::size_t g : {0, 1}) body[g] = io::read_joint_history(source.path, pair.gear[g].name);
  for (int step : source.steps)
    drive::add_time({{body[0].r_WB.col(step), body[1].r_WB.col(step)},
                     {rotation_at(body[0], step), rotation_at(body[1], step)},
                     history.force.col(step),
                     history.torque.col(step),
                     contacts[static_cast<std::size_t>(step)]},
                    flanks, pair);
  pair.slave_side = evaluation::slave_side(contacts);
}

PairOfRun read_pair(const DriveOfRun& of, Bodies& bodies, const Source& source,
                    const model::ResultHeader::Pair& of_pair) {
  PairOfRun pair;
  std::array<evaluation::Flanks, 2> flanks;
  for (std::size_t g : {0, 1}) {
    const std::string& name = source.header.bodies[of_pair.body[g]].name;
    pair.gear[g] = drive::gear_of(member_of(of.drive, name, source.path));
    flanks[g] = evaluation::flanks(pair.gear[g].toothing, elastic_body(of, bodies, source, name).surface);
    require_teeth(flanks[g], pair.gear[g], file_of_body(of, source, name));
    pair.gear[g].layers = evaluation::node_layers(flanks[g]);
    pair.compliance[g] = bodies.compliance(file_of_body(of, source, name));
  }
  drive::make_room(source.steps.size(), pair);
  pair.roll = rolls(of, source);
  if (source.analysis == Analysis::motion) pair.time = source.time(source.steps);
  pair.first_teeth = of.drive.members.front().toothing.z;
  pair.sense = of.options.choice("side", {"drive", "coast"}) == 0 ? 1 : -1;
  pair.turning = source.analysis == Analysis::sweep ? 1 : pair.sense;
  pair.speed = std::abs(drive_of(source).speed);
  pair.strips = of_pair.strips;
  pair.friction = of_pair.friction;
  read_times(source, of_pair, flanks, pair);
  if (source.analysis != Analysis::motion) require_roll_angles(pair, source.path);
  evaluation::take_hertz(pair);
  return pair;
}

// Are the flanks of a run exact and in their place?
bool is_exact(const Source& source, const std::string& gear) {
  const std::vector<std::string>& inexact = source.header.input->inexact;
  return std::find(inexact.begin(), inexact.end(), gear) == inexact.end();
}

void set_unloaded(const Source& source, const std::map<std::string, Eigen::VectorXd>& unloaded,
                  NamedPair& pair, std::vector<std::string>& notes) {
  if (source.analysis == Analysis::motion) return;
  const auto known = unloaded.find(pair.name);
  if (known != unloaded.end()) {
    require(known->second.size() == pair.run.roll.size(), source.path, ": has ", pair.run.roll.size(),
            " positions, the unloaded result has ", known->second.size(), ": sweep both over the same ones");
    pair.run.unloaded = known->second;
  } else if (is_exact(source, pair.run.gear[0].name) && is_exact(source, pair.run.gear[1].name)) {
    pair.run.unloaded = Eigen::VectorXd::Zero(pair.run.roll.size());
  } else {
    notes.push_back(
        pair.name +
        ": no secant stiffness: modified or misaligned flanks have an unloaded transmission error; "
        "sweep a torque near 0 and name its result by -unloaded");
  }
}

io::StressSet some_times(const io::StressSet& all, const std::vector<int>& steps) {
  io::StressSet set = all;
  set.stress = all.stress(Eigen::all, steps);
  set.von_mises = all.von_mises(Eigen::all, steps);
  set.rankine = all.rankine(Eigen::all, steps);
  if (all.mesh_error.size() > 0) set.mesh_error = all.mesh_error(Eigen::all, steps);
  if (all.contact_error.size() > 0) set.contact_error = all.contact_error(Eigen::all, steps);
  if (all.time_error.size() > 0) set.time_error = all.time_error(Eigen::all, steps);
  if (all.error.size() > 0) {
    set.error = all.error(Eigen::all, steps);
    set.peak_error = all.peak_error(steps);
  }
  return set;
}

// Stresses at the roots of each elastic gear.
std::map<std::string, io::StressSet> recover_roots(const DriveOfRun& of, Bodies& bodies, const Source& source,
                                                   std::vector<std::string>& notes) {
  std::map<std::string, io::StressSet> roots;
  std::map<std::string, std::string> files;
  const auto is_gear = [&](const std::string& name) {
    return std::any_of(of.drive.members.begin(), of.drive.members.end(),
                       [&](const DriveMember& member) { return member.name == name; });
  };
  for (const auto& body : source.header.bodies)
    if (is_gear(body.name)) files[body.name] = file_of_body(of, source, body.name);
  for (recovery::BodyOfRun& body : recovery::read_bodies_of_run(source.path, files)) {
    const std::string name = body.name;
    if (!is_gear(name)) continue;
    if (body.rigid) {
      notes.push_back(name + ": no stresses at its roots: it is rigid in the run");
      continue;
    }
    const model::ElasticBody& elastic = elastic_body(of, bodies, source, name);
    if (!elastic.stress.sets.contains("root")) {
      notes.push_back(name + ": no stresses at its roots: its body file has no stress nodes 'root'");
      continue;
    }
    recovery::RecoveredBody recovered = recovery::prepare_recovery(
        std::move(body), of.settings.mode_acceleration, of.settings.error_estimate, drive::finite_elements());
    roots[name] = some_times(recovery::recover_stress(recovered, elastic, "root", of.settings.error_estimate),
                             source.steps);
    warn_of_strain(roots[name], recovered.run.file);
  }
  return roots;
}

// A gear's bearings stand in its file's order; their forces act on the gear, in the world.
std::vector<BearingOfRun> read_bearings(const DriveOfRun& of, const Source& source) {
  std::vector<BearingOfRun> all;
  for (const DriveMember& member : of.drive.members)
    for (const drive::Bearing& bearing : bearings(of.options, member)) {
      const std::string& name = bearing.name;
      const auto& known = source.header.bushings;
      if (std::find(known.begin(), known.end(), name) == known.end()) continue;
      const io::BushingHistory history = io::read_bushing_history(source.path, name);
      const Eigen::Vector3d axis = rotation_matrix(member.rotation).col(2);
      const auto across = [&](const Eigen::MatrixXd& of_all) -> Eigen::VectorXd {
        const Eigen::MatrixXd v = of_all(Eigen::all, source.steps);
        return (v - axis * (axis.transpose() * v)).colwise().norm().transpose();
      };
      const Eigen::MatrixXd u = history.displacement(Eigen::all, source.steps),
                            angle = history.angle(Eigen::all, source.steps);
      all.push_back({name, member.name, across(history.force),
                     -(axis.transpose() * history.force(Eigen::all, source.steps)).transpose(),
                     across(history.torque), u.topRows<2>().colwise().norm().transpose(),
                     u.row(2).transpose(), angle.topRows<2>().colwise().norm().transpose()});
    }
  return all;
}

}  // namespace

const model::ElasticBody& Bodies::get(const std::string& file, const std::string& body,
                                      const std::string& result, const std::string& identity) {
  std::unique_ptr<Known>& known = known_[file];
  if (!known) {
    known = std::make_unique<Known>(Known{io::read_body(file), {}, {}});
    known->identity = model::fingerprint(known->body);
  }
  require(identity.empty() || identity == known->identity, file, ": is not the body '", body, "' of ", result,
          ": name the body file of the run by option -", body, "_file, or run simulate with this one");
  return known->body;
}

double Bodies::compliance(const std::string& file) {
  Known& known = *known_.at(file);
  if (!known.compliance) known.compliance = drive::surface_compliance(file, known.body.surface);
  return *known.compliance;
}

CaseRun read_case_run(const DriveOfRun& of, Bodies& bodies, const std::string& result,
                      const std::map<std::string, Eigen::VectorXd>& unloaded) {
  const Source source = open_source(of, result);
  CaseRun run;
  std::map<std::string, io::StressSet> roots;
  if (of.settings.roots) roots = recover_roots(of, bodies, source, run.notes);
  if (const auto missing = source.header.provenance.find("missing_positions");
      missing != source.header.provenance.end())
    run.notes.push_back("no equilibrium was found at the roll angles " + missing->second +
                        ": means leave them out, orders take them to be linear between their neighbours");
  if (!io::is_complete(result)) run.notes.push_back(result + " is incomplete: its run did not reach the end");
  for (const auto& of_pair : source.header.pairs) {
    NamedPair pair{of_pair.name, read_pair(of, bodies, source, of_pair)};
    set_unloaded(source, unloaded, pair, run.notes);
    for (std::size_t g : {0, 1})
      if (const auto set = roots.find(pair.run.gear[g].name); set != roots.end())
        pair.run.root[g] = set->second;
    run.pairs.push_back(std::move(pair));
  }
  run.bearings = read_bearings(of, source);
  require(!run.pairs.empty(), result, ": holds no pair of bodies in contact");
  if (source.analysis == Analysis::motion)
    for (const std::string& name : source.header.sensors) {
      const Eigen::MatrixXd a = io::read_sensor_history(result, name).acceleration;
      run.sensors[name] = a(Eigen::all, source.steps).transpose();
    }
  return run;
}

std::map<std::string, Eigen::VectorXd> transmission_errors(const DriveOfRun& of, Bodies& bodies,
                                                           const std::string& result) {
  const Source source = open_source(of, result);
  std::map<std::string, Eigen::VectorXd> errors;
  for (const auto& pair : source.header.pairs)
    errors[pair.name] = evaluation::transmission_error(read_pair(of, bodies, source, pair));
  return errors;
}

}  // namespace elastogear::app
