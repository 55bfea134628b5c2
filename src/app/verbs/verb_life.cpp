// elastogear life: damage of the gears of a drive over a duty cycle.

#include <algorithm>

#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/gear/drive_options.h"
#include "app/life/life_of_set.h"
#include "app/options/verbs.h"
#include "app/setup/drive_input.h"
#include "elastogear/base/error.h"
#include "elastogear/base/text.h"
#include "elastogear/io/body_file.h"

namespace elastogear::app {
namespace {

void refuse_different_teeth(const Drive& drive, const std::string& file, const life::Revolutions& r) {
  if (!r.laid) return;
  for (const DriveMember& member : drive.members)
    require(!member.deviations || !gear::teeth_differ(*member.deviations), file, ": teeth of ", member.name,
            " differ (pitch_deviation, run_out or topography), and this sweep does not go over whole "
            "revolutions: the load of one tooth is not that of the next one; sweep with sweep_pitches: "
            "hunting");
}

const DriveMember& member_of(const Options& options, const Drive& drive, const std::string& name) {
  for (const DriveMember& member : drive.members)
    if (member.name == name) return member;
  fail(options.label("stress_" + name), ": the drive has no gear '", name,
       "'; it has: ", join(drive.members, ", ", &DriveMember::name));
}

// The same nodes and as many positions at every torque.
void add(SetHistory& history, const Drive& drive, const std::string& file, SweptStress read) {
  const life::Sweep sweep = life::find_sweep(file, read.roll);
  require(
      history.at.empty() || (sweep.pitches == history.sweep.pitches &&
                             sweep.per_pitch == history.sweep.per_pitch && read.node == history.place.node),
      file, ": has other positions or nodes of ", read.body, " ", read.set,
      " than the files before: sweep all torques alike");
  const DriveMember& member = *history.member;
  history.sweep = sweep;
  history.at.push_back(life::over_revolutions(member.name + " " + read.set, read.stress, read.X, sweep,
                                              member.toothing.z, member.ratio > 0 ? 1 : -1));
  refuse_different_teeth(drive, file, history.at.back());
  if (read.error.size() > 0)
    history.with_error.push_back(life::over_revolutions(member.name + " " + read.set,
                                                        life::enlarged(read.stress, read.error), read.X,
                                                        sweep, member.toothing.z, member.ratio > 0 ? 1 : -1));
  history.place = std::move(read);
}

// Fields of the damage lie on the body's mesh, which must have the nodes that a stress file names.
void require_nodes_of_body(const Options& options, const SetHistory& history, const std::string& file) {
  const std::vector<int>& nodes = history.place.node;
  if (history.body_file.empty() || nodes.empty()) return;
  const int n = io::read_body_source(history.body_file).mesh.n_nodes();
  const int largest = *std::max_element(nodes.begin(), nodes.end());
  const std::string& body = history.place.body;
  require(largest < n, file, ": names node ", largest, " of ", body, " ", history.place.set, ", beyond the ",
          n, " nodes of ", history.body_file, ": the stresses are of another body; give its file, ",
          options.label(body + "_file"), ", or -damage_field false");
}

std::vector<SetHistory> read_histories(const Options& options, const Drive& drive,
                                       const LifeSettings& settings, const std::vector<SweptTorque>& swept) {
  const Progress progress = console_progress();
  std::vector<SetHistory> all;
  for (const SweptTorque& at : swept) {
    report(progress, "stresses", static_cast<double>(&at - swept.data()) / static_cast<double>(swept.size()));
    std::vector<SweptStress> read = read_stresses(options, settings, at);
    if (&at == swept.data()) all.resize(read.size());
    require(read.size() == all.size(), at.file, ": other gears are rigid there than in ", swept.front().file);
    for (std::size_t i = 0; i < read.size(); ++i) {
      all[i].member = &member_of(options, drive, read[i].body);
      require(all[i].at.empty() || all[i].place.body == read[i].body, at.file, ": ", read[i].body,
              " is not rigid there as in ", swept.front().file);
      all[i].body_file = body_file_of(options, *all[i].member, at);
      add(all[i], drive, at.file, std::move(read[i]));
    }
  }
  report(progress, "stresses", 1);
  for (const SetHistory& history : all)
    if (settings.field) require_nodes_of_body(options, history, swept.back().file);
  for (const auto& [body, sets] : settings.sets)
    if (std::ranges::none_of(all, [&, &body = body](const SetHistory& h) { return h.member->name == body; }))
      print_item("note", body + ": no life, it is rigid in the run");
  require(!all.empty(), "all gears whose stresses are wanted are rigid in the run: they have no life");
  return all;
}

io::LifeFile life_file(const Options& options, const LifeReport& report) {
  io::LifeFile file;
  const auto n = static_cast<Eigen::Index>(report.blocks.size());
  file.torque.resize(n);
  file.revolutions.resize(n);
  file.time.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const life::Block& block = report.blocks[static_cast<std::size_t>(i)];
    file.torque[i] = block.torque;
    file.revolutions[i] = block.revolutions;
    file.time[i] = block.time;
  }
  for (const LifeOfSet& one : report.sets) file.sets.push_back(one.set);
  file.provenance = options.provenance();
  return file;
}

// Before the work: what the life of every set that is wanted would write.
void protect_inputs(const Options& options, const Drive& drive, const LifeSettings& settings,
                    const std::vector<SweptTorque>& swept) {
  LifeReport expected;
  std::vector<std::string> data;
  for (const SweptTorque& at : swept) data.push_back(at.file);
  for (const auto& [body, sets] : settings.sets) {
    const std::string body_file = body_file_of(options, member_of(options, drive, body), swept.front());
    if (!body_file.empty()) data.push_back(body_file);
    for (const std::string& set : sets) {
      LifeOfSet& one = expected.sets.emplace_back();
      one.set.body = body;
      one.set.set = set;
      one.body_file = body_file;
    }
  }
  std::vector<std::string> outputs = side_files(settings.output, expected, settings.field);
  outputs.push_back(settings.output);
  protect_inputs(options, {{"output", outputs}}, data);
}

void run_life(const Options& given, const std::vector<std::string>&) {
  require_drive(given, "life");
  const Options options = with_gears(given);
  const Drive drive = read_drive(options);
  std::vector<std::string> names;
  for (const DriveMember& member : drive.members) names.push_back(member.name);
  options.reject_unknown({{"body", names}, {"gear", names}});
  const LifeSettings settings = life_settings(options, drive);
  warn_of_strengths(options, drive);
  LifeReport report{duty_cycle(options), swept_torques(options, settings), {}};
  protect_inputs(options, drive, settings, report.swept);
  std::vector<std::string> files;
  for (const SweptTorque& at : report.swept) files.push_back(at.file);
  print_departures(options, files);
  const OutputLock lock(settings.output);
  std::vector<double> torques;
  for (const SweptTorque& at : report.swept) torques.push_back(at.torque);
  for (const life::Block& block : report.blocks) life::between(torques, block.torque, settings.proportional);
  for (const SetHistory& history : read_histories(options, drive, settings, report.swept))
    report.sets.push_back(life_of_set(history, strength_of(options, history.member->name), torques,
                                      report.blocks, settings.proportional));
  io::write_life(settings.output, life_file(options, report));
  print_life(report);
  print_item("written", settings.output);
  write_side_files(settings.output, report, settings.field);
}

OptionTable all_life_options() {
  OptionTable table = life_table();
  const OptionTable of_drives = whole_drive_table();
  table.insert(table.end(), of_drives.begin(), of_drives.end());
  return table;
}

}  // namespace

Verb life_verb() {
  return {"life", "life drive.yaml [-option value ...]",
          "damage and life of the gears of a drive over a duty cycle", all_life_options(), run_life};
}

}  // namespace elastogear::app
