#include "elastogear/drive/sweep_drive.h"

#include <map>

#include "drive/pair_of_run.h"
#include "elastogear/base/error.h"
#include "elastogear/drive/finite_elements.h"
#include "elastogear/io/result_file.h"
#include "elastogear/model/fingerprint.h"
#include "elastogear/recovery/recover.h"

namespace elastogear::drive {
namespace {

// Adds the identities of the bodies to `known`.
dynamics::SlowMotion motion_of(const Drive& drive, const Operation& operation,
                               const std::vector<std::string>& body_files,
                               std::map<std::string, std::string>& known) {
  require(body_files.size() == drive.members.size(), "there must be a body file of each of ",
          drive.members.size(), " members");
  DriveSystem system = drive_system(drive, operation);
  for (std::size_t i = 0; i < drive.members.size(); ++i) {
    const Member& member = drive.members[i];
    known[model::identity_key(member.name)] =
        take_body(member, body_files[i], bearings_of(operation, i), system.bodies[i]);
  }
  dynamics::SlowMotion motion = slow_motion(drive, operation, std::move(system));
  motion.prepared = dynamics::prepare(motion);
  return motion;
}

// Observes all positions and writes them.
std::vector<model::Snapshot> swept(const dynamics::SlowMotion& motion, const model::ResultHeader& header,
                                   const std::vector<double>& positions, const std::string& result) {
  io::ResultWriter writer(result, header);
  std::vector<model::Snapshot> all;
  const dynamics::SweepSummary found =
      dynamics::sweep(motion, {.positions = positions}, [&](const model::Snapshot& now) {
        all.push_back(now);
        writer.append(now);
      });
  if (!found.missing.empty())
    fail("no equilibrium at the roll angle ", found.missing[0].position, ": ", found.missing[0].why);
  writer.finish();
  return all;
}

std::vector<io::StressSet> root_stresses(const std::string& result) {
  std::vector<io::StressSet> roots;
  for (recovery::BodyOfRun& body : recovery::read_bodies_of_run(result)) {
    const model::ElasticBody elastic = recovery::read_elastic_body(body);
    recovery::RecoveredBody recovered = recovery::prepare_recovery(
        std::move(body), recovery::Acceleration::automatic, true, finite_elements());
    roots.push_back(recovery::recover_stress(recovered, elastic, "root", true));
  }
  return roots;
}

}  // namespace

std::vector<evaluation::PairOfRun> sweep_drive(const Drive& drive, const Operation& operation,
                                               const std::vector<std::string>& body_files,
                                               const std::vector<double>& positions,
                                               const std::string& result) {
  std::map<std::string, std::string> identities;
  const dynamics::SlowMotion motion = motion_of(drive, operation, body_files, identities);
  const dynamics::SystemModel& model = motion.prepared->model();
  model::ResultHeader header = dynamics::result_header(model);
  header.provenance.merge(identities);
  header.input = run_input(drive, operation, 0);
  header.input->analysis = Analysis::sweep;
  for (std::size_t i = 0; i < body_files.size(); ++i) header.bodies[i].file = body_files[i];
  const std::vector<model::Snapshot> found = swept(motion, header, positions, result);
  const std::vector<io::StressSet> roots = root_stresses(result);
  std::vector<evaluation::PairOfRun> pairs;
  for (std::size_t p = 0; p < drive.pairs.size(); ++p) {
    pairs.push_back(pair_of_sweep(drive, p, operation, model, found));
    for (std::size_t g : {0, 1})
      pairs.back().root[g] =
          roots[static_cast<std::size_t>(g == 0 ? drive.pairs[p].first : drive.pairs[p].second)];
  }
  return pairs;
}

}  // namespace elastogear::drive
