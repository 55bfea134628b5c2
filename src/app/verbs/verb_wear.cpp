// elastogear wear: sweeps, and what they take off the flanks, in turn.

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/console/blas_kernels.h"
#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/gear/drive_options.h"
#include "app/options/verbs.h"
#include "app/setup/drive_on_meshes.h"
#include "app/sweep/sweep_run.h"
#include "app/wear/wear_report.h"
#include "elastogear/base/error.h"
#include "elastogear/io/body_file.h"

namespace elastogear::app {
namespace {

std::string output_of(const Options& options) {
  return options.given("output") ? options.text("output") : drive_stem(options) + "_wear.h5";
}

std::string sweep_file(const std::string& output) { return without_end(output) + "_sweep.h5"; }

std::vector<WearingGear> wearing_gears(const Options& options, const Drive& drive,
                                       const WearSettings& settings) {
  std::vector<WearingGear> gears;
  double largest = 0;
  for (const DriveMember& member : drive.members) {
    const WearMaterial material = wear_material(options, member);
    largest = std::max(largest, material.coefficient);
    gears.push_back(wearing_gear(member, material, settings,
                                 io::read_body(body_file(options, member), io::BodyUse::motion).surface));
  }
  require(largest > 0,
          "option -coefficient is missing: k of Archard's law in m^2/N, as in 'wear: {coefficient: "
          "1e-9 mm^3/(N m)}', or of one gear");
  return gears;
}

// Worn flanks of a run under way, and sweeps of coarser meshes, have the names of another output: earlier
// flanks, tables and summaries stand until there are new ones. The sweep's file holds the last one.
class WorkFiles {
 public:
  WorkFiles(const std::string& output, const Drive& drive) : output_(without_end(output) + ".partial.h5") {
    files_ = {sweep_file(output_), sweep_file(output_) + ".partial"};
    for (const DriveMember& member : drive.members) files_.push_back(worn_flanks_file(output_, member.name));
    clear();
  }
  WorkFiles(const WorkFiles&) = delete;
  WorkFiles& operator=(const WorkFiles&) = delete;
  ~WorkFiles() { clear(); }

  const std::string& output() const { return output_; }

 private:
  void clear() const {
    std::error_code none;
    for (const std::string& file : files_) std::filesystem::remove_all(file, none);
  }

  std::string output_;
  std::vector<std::string> files_;
};

// m by revolution of the first gear, on each side of the gear's teeth.
Eigen::MatrixXd rate(const WearingGear& gear, const Eigen::MatrixXd& passed) {
  return gear.material.coefficient * std::abs(gear.member->ratio) * life::depth(gear.cells, passed);
}

void write_flanks(const std::vector<WearingGear>& gears, const std::string& output) {
  for (const WearingGear& gear : gears) write_worn_flanks(worn_flanks_file(output, gear.member->name), gear);
}

// The sweep of the drive with flanks that are worn so far. flanks: output whose worn flanks they are.
void sweep_worn(const Options& options, const std::vector<WearingGear>& gears, const std::string& flanks,
                const std::string& sweep) {
  write_flanks(gears, flanks);
  Options of_sweep = options;
  of_sweep.set("analysis", "sweep");
  of_sweep.set("output", sweep);
  of_sweep.set("resume", "discard");  // an earlier one had other flanks
  for (const WearingGear& gear : gears)
    of_sweep.set(gear.member->name + "_wear", worn_flanks_file(flanks, gear.member->name));
  run_sweep(of_sweep);
}

// Largest depth and mass that one revolution of the first gear wears off each gear at its present state of
// wear.
WearRates rates(const std::vector<WearingGear>& gears, const std::vector<PassedVolume>& passed) {
  WearRates rates;
  for (std::size_t i = 0; i < gears.size(); ++i) {
    const Eigen::MatrixXd by_revolution[2] = {rate(gears[i], passed[i].of[0]),
                                              rate(gears[i], passed[i].of[1])};
    rates.depth.push_back(std::max(by_revolution[0].maxCoeff(), by_revolution[1].maxCoeff()));
    rates.mass.push_back(worn_mass(gears[i], by_revolution));
  }
  return rates;
}

// Rates of unworn flanks on coarser meshes, for estimated errors of the wear by the mesh.
std::vector<WearRates> rates_on(const std::vector<DriveOnMesh>& coarser, const Drive& drive,
                                const WearSettings& settings, const std::string& work) {
  std::vector<WearRates> found;
  for (const DriveOnMesh& mesh : coarser) {
    print_item("sweep", "counts " + short_number(mesh.refinement) +
                            " times those of the size, for the estimated error by the mesh");
    const Silence silence;
    const std::vector<WearingGear> gears = wearing_gears(mesh.options, drive, settings);
    sweep_worn(mesh.options, gears, work, sweep_file(work));
    found.push_back(rates(gears, passed_volume(sweep_file(work), drive, gears)));
  }
  return found;
}

// Revolutions to the next sweep: to the end, the limit, or the increment, whichever comes first.
double next_step(const WearSettings& settings, const std::vector<WearingGear>& gears,
                 const std::vector<PassedVolume>& passed, double done) {
  double step = settings.revolutions - done;
  for (std::size_t i = 0; i < gears.size(); ++i)
    for (int side = 0; side < 2; ++side) {
      const Eigen::MatrixXd fresh = rate(gears[i], passed[i].of[side]);
      if (fresh.maxCoeff() > 0) step = std::min(step, settings.increment / fresh.maxCoeff());
      if (settings.limit > 0)
        for (Eigen::Index k = 0; k < fresh.size(); ++k)
          if (fresh.reshaped()[k] > 0)
            step =
                std::min(step, (settings.limit - gears[i].depth[side].reshaped()[k]) / fresh.reshaped()[k]);
    }
  return std::max(step, 0.0);
}

// Why the run ends; empty when it goes on.
std::string end_of(const WearSettings& settings, const std::vector<WearingGear>& gears, WearCourse& course) {
  if (course.revolutions.back() >= settings.revolutions * (1 - 1e-12)) return "all revolutions are done";
  for (std::size_t i = 0; i < gears.size(); ++i)
    if (settings.limit > 0 && largest_depth(gears[i]) >= settings.limit * (1 - 1e-9)) {
      course.limited_by = static_cast<int>(i);
      return gears[i].member->name + " reaches the limit of depth";
    }
  return "";
}

void require_teeth_left(const Options& options, const std::vector<WearingGear>& gears, double revolutions) {
  for (const WearingGear& gear : gears)
    require(largest_depth(gear) <= tooth_height(*gear.member), options.label("increment"), ": after ",
            revolutions, " revolutions nothing would be left of the teeth of ", gear.member->name,
            ", worn by ", largest_depth(gear), " m; give fewer revolutions, or a limit of the depth");
}

WearCourse wear_down(const Options& options, const Drive& drive, const WearSettings& settings,
                     std::vector<WearingGear>& gears, const std::string& flanks, const std::string& file,
                     std::string& why) {
  WearCourse course;
  note(course, gears, 0);
  for (int sweep = 0; why.empty(); ++sweep) {
    require(sweep < settings.most_sweeps, options.label("most_sweeps"), ": ", sweep, " sweeps reach ",
            course.revolutions.back(), " of ", settings.revolutions,
            " revolutions; a larger increment takes fewer");
    sweep_worn(options, gears, flanks, file);
    const std::vector<PassedVolume> passed = passed_volume(file, drive, gears);
    if (sweep == 0) course.first = rates(gears, passed);
    const double done = course.revolutions.back(), step = next_step(settings, gears, passed, done);
    for (std::size_t i = 0; i < gears.size(); ++i)
      for (int side = 0; side < 2; ++side) gears[i].depth[side] += step * rate(gears[i], passed[i].of[side]);
    require_teeth_left(options, gears, done + step);
    note(course, gears, done + step);
    why = end_of(settings, gears, course);
  }
  return course;
}

// A file that serves all verbs may name the torques of other sweeps: wear takes its one torque and leaves
// those.
Options with_one_case(Options options) {
  const bool has_torque = options.given("torque") && !options.overrides_files("torques");
  for (const char* name : {"torques", "variants"})
    require(!options.given(name) || (name == std::string("torques") && has_torque), options.label(name),
            ": wear takes one case, of torque");
  if (has_torque) options.set("torque", options.text("torque"));
  require(!options.overrides_files("analysis") || options.text("analysis") == "sweep",
          options.label("analysis"), " = ", options.text("analysis"),
          ": wear is computed of sweeps (analysis: sweep); leave it out");
  return options;
}

void refuse_single_teeth(const Drive& drive, const Options& options) {
  for (const DriveMember& member : drive.members) {
    const std::string name = member.name + "_wear";
    require(!options.given(name), options.label(name), ": wear begins with flanks that are not worn");
    if (!member.deviations) continue;
    require(!member.deviations->index.any() && !member.deviations->eccentricity.any(), "wear of ",
            member.name, ": its teeth differ (pitch_deviation, run_out); wear takes all teeth alike");
  }
}

void protect(const Options& options, const Drive& drive, const DriveOnMeshes& meshes,
             const std::string& output) {
  Outputs outputs{"output", course_files(output)};
  outputs.files.insert(outputs.files.end(), {output, sweep_file(output)});
  std::vector<std::string> bodies = meshes.bodies(drive);
  for (const DriveMember& member : drive.members) {
    outputs.files.push_back(worn_flanks_file(output, member.name));
    bodies.push_back(body_file(options, member));
  }
  protect_inputs(options, {outputs}, bodies);
}

void run_wear(const Options& given, const std::vector<std::string>&) {
  const OneBlasThread one_thread;
  require_drive(given, "wear");
  const Options options = with_one_case(with_gears(given));
  const Drive drive = read_drive(options);
  std::vector<std::string> names;
  for (const DriveMember& member : drive.members) names.push_back(member.name);
  options.reject_unknown({{"body", names}, {"gear", names}});
  refuse_single_teeth(drive, options);
  const WearSettings settings = wear_settings(options);
  require_limit_within_teeth(options, settings, drive);
  const std::string output = output_of(options);
  std::vector<WearingGear> gears = wearing_gears(options, drive, settings);
  const DriveOnMeshes meshes = drive_on_meshes(options, drive);
  protect(options, drive, meshes, output);
  const OutputLock lock(output);
  for (const std::string& left_out : meshes.left_out)
    print_item("left out", left_out + ", for the estimated error by the mesh; elastogear run makes it anew");
  const WorkFiles work(output, drive);
  const std::vector<WearRates> on_coarser = rates_on(meshes.coarser, drive, settings, work.output());
  std::string why;
  WearCourse course = wear_down(options, drive, settings, gears, work.output(), sweep_file(output), why);
  estimate_errors(course, on_coarser, meshes.refinements());
  write_flanks(gears, output);
  for (const WearingGear& gear : gears) print_item("written", worn_flanks_file(output, gear.member->name));
  io::WearFile file = wear_file(course, gears);
  file.provenance = options.provenance();
  io::write_wear(output, file);
  write_course(output, course, gears, why);
  for (const std::string& path : course_files(output)) print_item("written", path);
  print_item("written", output);
  print_wear(course, gears, why);
}

OptionTable all_wear_options() {
  OptionTable table = wear_table();
  const OptionTable of_runs = simulate_verb().table;
  table.insert(table.end(), of_runs.begin(), of_runs.end());
  return table;
}

}  // namespace

Verb wear_verb() {
  return {"wear",
          "wear drive.yaml [-option value ...]",
          "worn depth and mass of the flanks of a drive over its revolutions",
          all_wear_options(),
          run_wear,
          "-snes_*, "};
}

}  // namespace elastogear::app
