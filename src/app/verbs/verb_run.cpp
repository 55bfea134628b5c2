// elastogear run: drive file -> bodies, a sweep over a pitch and what an engineer reads off, each as far as
// it is not there already, on meshes that are refined until the stresses at the roots are as accurate as
// asked.

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>

#include "app/console/console.h"
#include "app/console/embedding.h"
#include "app/evaluate/mesh_errors.h"
#include "app/options/rows.h"
#include "app/options/verbs.h"
#include "app/run/loaded_sides.h"
#include "app/run/next_mesh.h"
#include "app/run/report_page.h"
#include "app/run/run_on_mesh.h"
#include "app/setup/drive_on_meshes.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"

namespace elastogear::app {
namespace {

struct RunSettings {
  double accuracy = 5;          // %
  std::string report = "page";  // or none
};

const Rows<RunSettings> kRunRows = {
    {"accuracy", &RunSettings::accuracy, "%",
     "run: estimated error by the mesh, of the largest tension at the root of every gear, that meshes of a "
     "drive at rest are refined for; size, element_order and refinement choose a mesh in place of it",
     kPositive},
    {"report", &RunSettings::report, "-",
     "run: page, a file for the browser, DRIVE_report.html (docs/report.md); none"},
};

bool is_at_rest(const RunOnMesh& of) {
  const std::string analysis = of.simulate.text("analysis");
  return analysis == "sweep" || analysis == "static";
}

bool relaxes_by(const Options& options) {
  const auto given = options.given_to_verb();
  return std::any_of(given.begin(), given.end(), [](const auto& option) {
    return option.first.find("prony") != std::string::npos ||
           option.first.find("master") != std::string::npos;
  });
}

// Does the run look for the mesh?
bool chooses_mesh(const Options& given, const RunOnMesh& of, const Drive& drive) {
  for (const DriveMember& member : drive.members)
    if (const std::string own = own_mesh(given, member.name); !own.empty()) {
      require(!given.given("accuracy"), given.label("accuracy"), ": nothing refines the mesh of ",
              member.name, ", ", own, "; leave it out, or the mesh");
      return false;
    }
  for (const char* mesh : {"size", "element_order", "refinement"})
    if (given.given(mesh)) {
      require(!given.given("accuracy"), given.label("accuracy"), ": is not for a mesh that ",
              given.label(mesh), " has chosen");
      return false;
    }
  require(is_at_rest(of) || !given.given("accuracy"), given.label("accuracy"),
          ": is for analyses at rest, sweep and static");
  return is_at_rest(of);
}

double refinement(const Drive& drive, int mesh) { return drive.refinements[static_cast<std::size_t>(mesh)]; }

// Returns whether the run ends with this mesh, and says how accurate it is.
bool ends_here(const Drive& drive, int mesh, double error, double accuracy, const Cost& cost) {
  const bool reached = error < 0 || error <= accuracy;
  const std::string obstacle = reached ? "" : obstacle_to_finer(drive.refinements, mesh, cost);
  std::ostringstream said;
  said << percent(error) << " of the largest tension at a root by estimate, " << percent(accuracy)
       << " asked; counts " << refinement(drive, mesh) << " times those of size tiny";
  if (!obstacle.empty()) said << "; not reached: " << obstacle;
  if (error < 0)
    print_item("accuracy", "not estimated: no root of an elastic gear has a tension");
  else
    print_item("accuracy", said.str());
  return reached || !obstacle.empty();
}

double error_in(const std::string& evaluation) {
  return number_on_rank_0([&] { return root_error(evaluation); });
}

// The files of a mesh in its own folder, where those of all meshes but the last one are kept.
RunOnMesh on_mesh_apart(const RunOnMesh& of, const Drive& drive, int mesh) {
  std::ostringstream folder;
  folder << folder_of_meshes(of.reduce) << "/" << refinement(drive, mesh);
  return on_mesh(of, drive, refinement(drive, mesh), folder.str());
}

// Tells what a mesh took, beside the files of meshes.
std::string cost_file(const RunOnMesh& of, const Drive& drive, int mesh) {
  std::ostringstream name;
  name << folder_of_meshes(of.reduce) << "/cost_" << refinement(drive, mesh) << ".h5";
  return name.str();
}

// The next mesh after one whose evaluation is there: a finer one of which something is there, too, if there
// is any. Size tiny alone has no estimate of its error.
int mesh_after(int mesh, const RunOnMesh& of, const Drive& drive, double accuracy) {
  for (int finer = mesh + 1; finer < std::ssize(drive.refinements); ++finer)
    for (const RunOnMesh& there :
         {on_mesh_apart(of, drive, finer), on_mesh(of, drive, refinement(drive, finer), "")})
      if (has_bodies(there, drive) || has_evaluation(there)) return finer;
  if (mesh == 0) return 1;
  const double error = error_in(evaluation_file(on_mesh_apart(of, drive, mesh)));
  return finer_mesh(drive.refinements, mesh, error, accuracy, known_cost(cost_file(of, drive, mesh)));
}

// Refines from size tiny on, Eq. (10.15) to (10.18). All meshes but the last have their files in folders.
void run_accurately(RunOnMesh of, const Drive& drive, double accuracy) {
  std::vector<std::string> coarser;
  const int n_meshes = static_cast<int>(drive.refinements.size());
  for (int mesh = 0; mesh < n_meshes;) {
    const RunOnMesh apart = on_mesh_apart(of, drive, mesh);
    const bool last = mesh + 1 == n_meshes;
    print_item("mesh", "counts " + with_unit(refinement(drive, mesh), "times those of size tiny"));
    if (!last && has_evaluation(apart)) {
      coarser.push_back(evaluation_file(apart));
      print_item("evaluate", coarser.back() + " is there");
      if (mesh == 0) of = with_loaded_sides(std::move(of), drive, result_file(apart));
      mesh = mesh_after(mesh, of, drive, accuracy);
      continue;
    }
    const bool is_apart = !last && (mesh == 0 || has_bodies(apart, drive));
    const RunOnMesh here = is_apart ? apart : on_mesh(of, drive, refinement(drive, mesh), "");
    const bool is_new = !has_bodies(here, drive);
    const Cost cost = cost_of(cost_file(of, drive, mesh), is_new, [&] { make(here, drive, coarser); });
    if (!is_apart) {
      if (ends_here(drive, mesh, error_in(evaluation_file(here)), accuracy, cost)) return;
      number_on_rank_0([&] { return move_files(here, apart, drive), 0; });
    }
    coarser.push_back(evaluation_file(apart));
    if (mesh == 0) of = with_loaded_sides(std::move(of), drive, result_file(apart));
    mesh = mesh_after(mesh, of, drive, accuracy);
  }
}

bool makes_page(const Options& given) {
  return given.choice("report", {"page", "none"}) == 0 && !embedding() && given.files().size() == 1;
}

std::string page_of(const RunOnMesh& of) { return drive_stem(of.reduce) + "_report.html"; }

// The page of one result of one drive file. A run without it has all its figures.
void make_report(const Options& given, const RunOnMesh& of) {
  if (!makes_page(given)) return;
  number_on_rank_0([&] {
    const PageInputs inputs{given.files()[0], result_file(of), evaluation_file(of),
                            of.reduce.text("store") == "all" && of.reduce.text("modes") != "0"};
    if (!std::filesystem::is_regular_file(inputs.result)) return 0;  // a folder of several cases
    const std::string page = page_of(of), obstacle = make_page(inputs, page);
    print_item("report", obstacle.empty() ? page + ", open it in a browser" : "not made: " + obstacle);
    return 0;
  });
}

void run_all(const Options& given, const std::vector<std::string>&) {
  require_drive(given, "run");
  RunSettings settings;
  read_rows(given, kRunRows, settings);
  with_gears(given).reject_unknown();
  const Drive drive = read_drive(with_gears(given));
  RunOnMesh of = run_options(given);
  number_on_rank_0([&] {
    require_places(of, drive);
    if (makes_page(given)) place_of_output(page_of(of));
    return 0;
  });
  if (!chooses_mesh(given, of, drive)) return make(of, drive, {}), make_report(given, of);
  // Equilibria take static responses alone, and errors by the mesh come from coarser ones.
  if (of.reduce.text("basis") == "modal_residual" && !relaxes_by(of.reduce))
    for (Options* options : {&of.reduce, &of.simulate, &of.evaluate}) options->set_default("modes", "0");
  run_accurately(of, drive, settings.accuracy / 100);
  make_report(given, of);
}

OptionTable all_run_options() {
  OptionTable table = table_of(kRunRows);
  const OptionTable of_drives = whole_drive_table();
  table.insert(table.end(), of_drives.begin(), of_drives.end());
  return table;
}

}  // namespace

Verb run_verb() {
  return {"run",
          "run drive.yaml [-option value ...]",
          "drive file -> bodies, sweep and evaluation, as far as they are not there; also 'elastogear "
          "drive.yaml'",
          all_run_options(),
          run_all,
          "-eps_*, -st_* (modes), -snes_* (equilibria), ",
          true};
}

}  // namespace elastogear::app
