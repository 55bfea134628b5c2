#include <algorithm>
#include <utility>

#include "drive/result_parts.h"
#include "elastogear/drive/finite_elements.h"
#include "elastogear/recovery/recover.h"

namespace elastogear::drive {
namespace {

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

}  // namespace

std::map<std::string, io::StressSet> recover_roots(const DriveOfResults& of, const ReadSettings& settings,
                                                   const DriveResult& result, BodyFiles& bodies,
                                                   std::vector<std::string>& notes) {
  std::map<std::string, io::StressSet> roots;
  std::map<std::string, std::string> files;
  const auto is_gear = [&](const std::string& name) {
    return std::any_of(of.drive.members.begin(), of.drive.members.end(),
                       [&](const Member& member) { return member.name == name; });
  };
  for (const auto& body : result.header.bodies)
    if (is_gear(body.name)) files[body.name] = body_file(of, result, body.name);
  for (recovery::BodyOfRun& body : recovery::read_bodies_of_run(result.path, files)) {
    const std::string name = body.name;
    if (!is_gear(name)) continue;
    if (body.rigid) {
      notes.push_back(name + ": no stresses at its roots: it is rigid in the run");
      continue;
    }
    const model::ElasticBody& elastic = elastic_body(of, result, name, bodies);
    if (!elastic.stress.sets.contains("root")) {
      notes.push_back(name + ": no stresses at its roots: its body file has no stress nodes 'root'");
      continue;
    }
    recovery::RecoveredBody recovered = recovery::prepare_recovery(
        std::move(body), settings.mode_acceleration, settings.error_estimate, finite_elements());
    roots[name] = some_times(recovery::recover_stress(recovered, elastic, "root", settings.error_estimate),
                             result.steps);
  }
  return roots;
}

}  // namespace elastogear::drive
