#include "elastogear/drive/drive_result.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drive/result_parts.h"
#include "elastogear/base/error.h"
#include "elastogear/drive/surface_compliance.h"
#include "elastogear/io/body_file.h"
#include "elastogear/model/fingerprint.h"

namespace elastogear::drive {
namespace {

Analysis analysis_of(const std::string& path, const std::optional<model::RunInput>& input) {
  const bool serves = input && input->analysis != Analysis::relaxation;
  require(
      serves, path, ": is the result of analysis: ",
      input ? model::analysis_names()[static_cast<std::size_t>(input->analysis)] : "unknown",
      "; evaluate reads those of sweep, static and dynamic",
      input ? ""
            : "; a former version of the program does not say it: make the result anew by 'elastogear run'");
  return input->analysis;
}

std::vector<int> steps_of(const DriveResult& result, const ReadSettings& settings) {
  const int n = static_cast<int>(result.time.size());
  std::vector<int> steps;
  const bool spans = result.analysis == Analysis::motion;
  require(spans || (!settings.from && !settings.to), result.path,
          ": options -from and -to are for runs in time (analysis: dynamic)");
  for (int i = result.analysis == Analysis::equilibrium ? n - 1 : 0; i < n; ++i)
    if (result.time[i] >= settings.from.value_or(-INFINITY) &&
        result.time[i] <= settings.to.value_or(INFINITY))
      steps.push_back(i);
  require(!steps.empty(), result.path, ": has no times between -from and -to; it reaches from ",
          result.time[0], " to ", result.time[n - 1], " s");
  return steps;
}

// Are the flanks of a run exact and in their place?
bool is_exact(const DriveResult& result, const std::string& gear) {
  const std::vector<std::string>& inexact = result.header.input->inexact;
  return std::find(inexact.begin(), inexact.end(), gear) == inexact.end();
}

void set_unloaded(const DriveResult& result, const TransmissionErrors& unloaded, NamedPair& pair,
                  std::vector<std::string>& notes) {
  if (result.analysis == Analysis::motion) return;
  const auto known = unloaded.find(pair.name);
  if (known != unloaded.end()) {
    require(known->second.size() == pair.run.roll.size(), result.path, ": has ", pair.run.roll.size(),
            " positions, the unloaded result has ", known->second.size(), ": sweep both over the same ones");
    pair.run.unloaded = known->second;
  } else if (is_exact(result, pair.run.gear[0].name) && is_exact(result, pair.run.gear[1].name)) {
    pair.run.unloaded = Eigen::VectorXd::Zero(pair.run.roll.size());
  } else {
    notes.push_back(
        pair.name +
        ": no secant stiffness: modified or misaligned flanks have an unloaded transmission error; "
        "sweep a torque near 0 and name its result by -unloaded");
  }
}

// Notes the gears whose teeth differ and are not all in mesh over a sweep.
void note_other_teeth(const DriveOfResults& of, const evaluation::PairOfRun& pair,
                      std::vector<std::string>& notes) {
  const double rolled = pair.roll.size() > 1 ? pair.roll.maxCoeff() - pair.roll.minCoeff() : 0,
               step = pair.roll.size() > 1 ? rolled / static_cast<double>(pair.roll.size() - 1) : 0;
  for (const Member& member : of.drive.members)
    if (member.deviations && gear::teeth_differ(*member.deviations) &&
        rolled + step < (1 - 1e-6) * member.toothing.z)
      notes.push_back(member.name +
                      ": its teeth differ, and not all of them are in mesh here: figures are those of some "
                      "teeth, and no orders of the mesh; sweep_pitches: hunting rolls over all");
}

}  // namespace

const model::ElasticBody& BodyFiles::get(const std::string& file, const std::string& body,
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

double BodyFiles::compliance(const std::string& file) {
  Known& known = *known_.at(file);
  if (!known.compliance) known.compliance = surface_compliance(file, known.body.surface);
  return *known.compliance;
}

const Member& member_of(const Drive& drive, const std::string& name, const std::string& path) {
  for (const Member& member : drive.members)
    if (member.name == name) return member;
  fail(path, ": body '", name, "' is no gear of the drive file: name the result of this drive by -result");
}

Eigen::Matrix3d rotation_at(const io::BodyHistory& history, int step) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(history.R_WB.col(step).data());
}

std::string body_file(const DriveOfResults& of, const DriveResult& result, const std::string& gear) {
  if (const auto moved = of.body_file.find(gear); moved != of.body_file.end()) return moved->second;
  for (const auto& body : result.header.bodies)
    if (body.name == gear && !body.file.empty()) return body.file;
  fail(result.path, ": does not say the body file of '", gear, "'; name it by option -", gear, "_file");
}

const model::ElasticBody& elastic_body(const DriveOfResults& of, const DriveResult& result,
                                       const std::string& gear, BodyFiles& bodies) {
  const auto identity = result.header.provenance.find(model::identity_key(gear));
  return bodies.get(body_file(of, result, gear), gear, result.path,
                    identity == result.header.provenance.end() ? "" : identity->second);
}

DriveResult open_result(const std::string& path, const ReadSettings& settings) {
  DriveResult result{path, io::read_result_header(path), Analysis::sweep, io::read_times(path), {}};
  require(result.time.size() > 0, path, ": holds no times");
  result.analysis = analysis_of(path, result.header.input);
  result.steps = steps_of(result, settings);
  return result;
}

DriveRun read_result(const DriveOfResults& of, const ReadSettings& settings, const DriveResult& result,
                     BodyFiles& bodies, const TransmissionErrors& unloaded) {
  DriveRun run;
  std::map<std::string, io::StressSet> roots;
  if (settings.roots) roots = recover_roots(of, settings, result, bodies, run.notes);
  if (const auto missing = result.header.provenance.find("missing_positions");
      missing != result.header.provenance.end())
    run.notes.push_back("no equilibrium was found at the roll angles " + missing->second +
                        ": means leave them out, orders take them to be linear between their neighbours");
  if (!io::is_complete(result.path))
    run.notes.push_back(result.path + " is incomplete: its run did not reach the end");
  for (const auto& of_pair : result.header.pairs) {
    NamedPair pair{of_pair.name, read_pair(of, result, of_pair, bodies)};
    set_unloaded(result, unloaded, pair, run.notes);
    for (std::size_t g : {0, 1})
      if (const auto set = roots.find(pair.run.gear[g].name); set != roots.end())
        pair.run.root[g] = set->second;
    run.pairs.push_back(std::move(pair));
  }
  if (result.analysis != Analysis::motion && !run.pairs.empty())
    note_other_teeth(of, run.pairs.front().run, run.notes);
  run.bearings = read_bearings(of, result);
  require(!run.pairs.empty(), result.path, ": holds no pair of bodies in contact");
  if (result.analysis == Analysis::motion)
    for (const std::string& name : result.header.sensors) {
      const Eigen::MatrixXd a = io::read_sensor_history(result.path, name).acceleration;
      run.sensors[name] = a(Eigen::all, result.steps).transpose();
    }
  return run;
}

bool touches_always(const evaluation::PairOfRun& pair) {
  return (pair.force.colwise().squaredNorm().array() > 0).all();
}

TransmissionErrors transmission_errors(const DriveOfResults& of, const DriveResult& result,
                                       BodyFiles& bodies) {
  TransmissionErrors errors;
  for (const auto& named : result.header.pairs)
    if (const evaluation::PairOfRun pair = read_pair(of, result, named, bodies); touches_always(pair))
      errors[named.name] = evaluation::transmission_error(pair);
  return errors;
}

}  // namespace elastogear::drive
