// elastogear run: drive file -> bodies, a sweep over a pitch and what an engineer reads off, each as far as
// it is not there already, on meshes that are refined until the stresses at the roots are as accurate as
// asked.

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <sstream>
#include <utility>

#include "app/console/console.h"
#include "app/console/embedding.h"
#include "app/evaluate/mesh_errors.h"
#include "app/options/rows.h"
#include "app/options/verbs.h"
#include "app/run/loaded_sides.h"
#include "app/run/report_page.h"
#include "app/run/run_on_mesh.h"
#include "app/setup/drive_on_meshes.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/petsc.h"
#include "elastogear/evaluation/grid_convergence.h"
#include "elastogear/io/record_file.h"

namespace elastogear::app {
namespace {

// Times the counts of size tiny. Ratios of at least 1.3 tell changes from scatter (ASME V&V 20).
constexpr double kRefinements[] = {1, 1.5, 2, 3, 4, 6};
constexpr int kMeshes = static_cast<int>(std::size(kRefinements));
constexpr double kLongest = 1200;  // s, that one more mesh may take
constexpr double kCost = 4;        // power of the refinement that time and memory grow with

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

double number_on_rank_0(const std::function<double()>& number) {
  double value = 0;
  collectively(PETSC_COMM_WORLD, [&] {
    int rank = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank == 0) value = number();
  });
  MPI_Bcast(&value, 1, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  return value;
}

// Time (s) and memory (bytes) that a mesh takes on rank 0.
struct Cost {
  double seconds = INFINITY, memory = INFINITY;
};

double memory_held() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

// Of the machine, or less where ulimit says so.
double memory_there() {
  double most = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  for (const auto resource : {RLIMIT_RSS, RLIMIT_AS}) {
    rlimit limit{};
    if (getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
      most = std::min(most, static_cast<double>(limit.rlim_cur));
  }
  return most;
}

// Collective.
bool is_affordable(const Cost& cost) {
  return cost.seconds <= kLongest && cost.memory <= number_on_rank_0(memory_there);
}

// cost: of the mesh.
Cost cost_of_finer(int mesh, int finer, const Cost& cost) {
  const double times = std::pow(kRefinements[finer] / kRefinements[mesh], kCost);
  return {times * cost.seconds, times * cost.memory};
}

std::string cost_file(const RunOnMesh& of, int mesh) {
  std::ostringstream name;
  name << folder_of_meshes(of.reduce) << "/cost_" << kRefinements[mesh] << ".h5";
  return name.str();
}

// What the runs on a mesh took at most since its bodies were made: a later one that finds all there takes
// next to nothing, which says nothing of the next mesh. Infinite where it is not known. Collective.
Cost known_cost(const RunOnMesh& of, int mesh) {
  const auto number = [&](std::size_t i) -> double {
    try {
      const io::StoredRecord record = io::read_record(cost_file(of, mesh));
      return record.numbers.size() == 2 ? record.numbers[i] : INFINITY;
    } catch (const Error&) {
      return INFINITY;
    }
  };
  return {number_on_rank_0([&] { return number(0); }), number_on_rank_0([&] { return number(1); })};
}

// now: what this run took. of_bodies: have its bodies been made, too? Collective.
Cost cost_of(const RunOnMesh& of, int mesh, const Cost& now, bool of_bodies) {
  const Cost known = of_bodies ? Cost{0, 0} : known_cost(of, mesh);
  if (!std::isfinite(known.seconds)) return now;
  const Cost most{std::max(now.seconds, known.seconds), std::max(now.memory, known.memory)};
  number_on_rank_0([&] {
    std::filesystem::create_directories(folder_of_meshes(of.reduce));
    io::write_record(cost_file(of, mesh), {{}, {most.seconds, most.memory}});
    return 0;
  });
  return most;
}

// Collective.
Cost timed(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  return {number_on_rank_0([&] { return taken.count(); }), number_on_rank_0(memory_held)};
}

// The next finer mesh. Those that would miss the accuracy asked are passed over as far as one beyond them is
// affordable. cost: of this mesh.
int finer_mesh(int mesh, double error, double accuracy, const Cost& cost) {
  const double least = evaluation::least_refinement(error, accuracy, kRefinements[mesh]);
  int finer = mesh + 1;
  while (finer + 1 < kMeshes && kRefinements[finer] < least &&
         is_affordable(cost_of_finer(mesh, finer + 1, cost)))
    ++finer;
  return finer;
}

// Says what the next finer mesh would take if time or memory do not suffice for it; empty if they do.
std::string obstacle_to_finer(int mesh, const Cost& of_mesh) {
  if (mesh + 1 == kMeshes) return "there is no finer mesh on offer";
  const Cost cost = cost_of_finer(mesh, mesh + 1, of_mesh);
  if (is_affordable(cost)) return "";
  std::ostringstream finer;
  finer << "the next mesh would take about " << duration(cost.seconds) << " and "
        << short_number(1e-9 * cost.memory) << " GB of memory; -refinement " << kRefinements[mesh + 1]
        << " makes it";
  return finer.str();
}

// Returns whether the run ends with this mesh, and says how accurate it is.
bool ends_here(int mesh, double error, double accuracy, const Cost& cost) {
  const bool reached = error < 0 || error <= accuracy;
  const std::string obstacle = reached ? "" : obstacle_to_finer(mesh, cost);
  std::ostringstream said;
  said << percent(error) << " of the largest tension at a root by estimate, " << percent(accuracy)
       << " asked; counts " << kRefinements[mesh] << " times those of size tiny";
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
  folder << folder_of_meshes(of.reduce) << "/" << kRefinements[mesh];
  return on_mesh(of, drive, kRefinements[mesh], folder.str());
}

// The next mesh after one whose evaluation is there: a finer one of which something is there, too, if there
// is any. Size tiny alone has no estimate of its error.
int mesh_after(int mesh, const RunOnMesh& of, const Drive& drive, double accuracy) {
  for (int finer = mesh + 1; finer < kMeshes; ++finer)
    for (const RunOnMesh& there :
         {on_mesh_apart(of, drive, finer), on_mesh(of, drive, kRefinements[finer], "")})
      if (has_bodies(there, drive) || has_evaluation(there)) return finer;
  if (mesh == 0) return 1;
  const double error = error_in(evaluation_file(on_mesh_apart(of, drive, mesh)));
  return finer_mesh(mesh, error, accuracy, known_cost(of, mesh));
}

// Refines from size tiny on, Eq. (10.15) to (10.18). All meshes but the last have their files in folders.
void run_accurately(RunOnMesh of, const Drive& drive, double accuracy) {
  std::vector<std::string> coarser;
  for (int mesh = 0; mesh < kMeshes;) {
    const RunOnMesh apart = on_mesh_apart(of, drive, mesh);
    const bool last = mesh + 1 == kMeshes;
    print_item("mesh", "counts " + with_unit(kRefinements[mesh], "times those of size tiny"));
    if (!last && has_evaluation(apart)) {
      coarser.push_back(evaluation_file(apart));
      print_item("evaluate", coarser.back() + " is there");
      if (mesh == 0) of = with_loaded_sides(std::move(of), drive, result_file(apart));
      mesh = mesh_after(mesh, of, drive, accuracy);
      continue;
    }
    const bool is_apart = !last && (mesh == 0 || has_bodies(apart, drive));
    const RunOnMesh here = is_apart ? apart : on_mesh(of, drive, kRefinements[mesh], "");
    const bool is_new = !has_bodies(here, drive);
    const Cost cost = cost_of(of, mesh, timed([&] { make(here, drive, coarser); }), is_new);
    if (!is_apart) {
      if (ends_here(mesh, error_in(evaluation_file(here)), accuracy, cost)) return;
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
  require(is_drive(given), "needs a drive file: elastogear run drive.yaml (docs/drives.md)");
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
