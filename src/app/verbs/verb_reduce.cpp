// elastogear reduce: mesh + material + basis -> body file.

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/console/blas_advice.h"
#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/console/plausibility.h"
#include "app/options/rows.h"
#include "app/tables/basis_options.h"
#include "app/tables/material_options.h"
#include "app/tables/motion.h"
#include "app/tables/named_sets.h"
#include "app/verbs/verbs.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/number.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/sort_unique.h"
#include "elastogear/mesh/file.h"
#include "elastogear/reduction/eigenmodes.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::app {
namespace {

using reduction::ReductionOptions, reduction::ImportedFiles;

const Rows<ReductionOptions> kMeshRows = {
    {"mesh", "-", "", "volume mesh to read, Gmsh 4.1 .msh or Abaqus .inp"},
    {"unit", "-", "m",
     "unit of length of the mesh file or node table: m, or mm (then matrices and the file's materials are in "
     "N, mm and t)"},
    {"output", "-", "", "body file to write (HDF5)"},
    {"element", &ReductionOptions::element, one_of("incompatible", "plain", "bbar"),
     "8-node hexahedra: incompatible (modes), plain or bbar (mean dilatation)"},
    {"restrain", "-", "",
     "node sets or face sets whose nodes are held and carry the body frame, in all directions or, with :x, "
     ":yz, ... behind the name, in these only: [bore, symmetry:z, left:xy]; none: a free body, free-free "
     "modes; not given: *BOUNDARY of an .inp file. Also single nodes by their numbers, [4711:z]"},
    {"restrain_nodes", "-", "",
     "nodes that are held besides in all directions, by their numbers in the mesh file or node table"},
};

const Rows<ImportedFiles> kImportedRows = {
    {"stiffness", &ImportedFiles::stiffness, "-",
     "stiffness matrix of another program, in place of assembly: Abaqus *MATRIX OUTPUT, CalculiX .sti, "
     "triplets",
     kRequired},
    {"mass", &ImportedFiles::mass, "-", "its mass matrix", kRequired},
    {"matrix_format", &ImportedFiles::format, one_of("auto", "abaqus", "calculix", "triplets"),
     "of both: auto, abaqus, calculix or triplets (Matrix Market among them)"},
    {"dofs", &ImportedFiles::dofs, "-",
     "file that names the rows of calculix or triplets, node.direction a line (CalculiX .dof)"},
    {"nodes", "-", "", "table of nodes, number x y z, in place of the mesh"},
};

const Rows<ReductionOptions> kRows = {
    {"frame", "m", "",
     "origin of the body frame: mesh, centre_of_mass, or x,y,z in the mesh's coordinates (default: "
     "centre_of_mass for a free body, else mesh)"},
    {"surface", &ReductionOptions::surface, "-", "face sets of the contact surface"},
    {"stress_nodes", &ReductionOptions::stress_nodes, "-",
     "node sets, or face sets for their nodes, at which stress modes are stored"},
    {"markers", &ReductionOptions::markers, "-",
     "node sets or face sets whose mean motion is stored, for loads, bushings and sensors of simulate (which "
     "always has the body frame); also single nodes by their numbers in the mesh file, [tip, 4711]"},
    {"marker_weights", &ReductionOptions::marker_weights, one_of("equal", "area"),
     "what the nodes of a marker weigh: equal, or area (their part of the outer faces within the set)"},
    {"window", "-", "auto",
     "eigenmodes found at a time, by block Lanczos in windows (SLEPc's -eps_type block_lanczos); auto: of "
     "the "
     "best size; 0: all at once by -eps_type krylovschur, of the whole body. SLEPc's options work with both, "
     "for the whole body and in every harmonic: -eps_type, -eps_tol, -eps_ncv, -eps_mpd, -eps_monitor, "
     "-eps_view, -st_*; -eps_nev is modes, -eps_interval a,b in (rad/s)^2 takes all modes in it"},
    {"store", &ReductionOptions::store, one_of("surface", "all"),
     "modes at all nodes, or at the surface and stress nodes only (no whole fields): all or surface"},
    {"precision", &ReductionOptions::precision, one_of("float64", "float32"),
     "of modes stored at all nodes: float64 or float32"},
    {"invariants", &ReductionOptions::invariants, one_of("linear", "full"),
     "of inertia: linear, or full for simulate's inertia level full (6 n_q^2 numbers more; modal: all modes "
     "wait on disk, beside the output)"},
    {"symmetry", &ReductionOptions::symmetry, one_of("auto", "none"),
     "auto: modes from one sector where mesh, materials and restraint repeat around an axis; none, and "
     "with window 0: from the whole body"},
    {"completeness", &ReductionOptions::completeness, "-",
     "check how much of the static response to loads on the surface the modes give: one more factorisation; "
     "with "
     "sectors up to 500,000 displacements"},
    {"damping_alpha", &ReductionOptions::alpha, "1/s", "Rayleigh damping, mass-proportional part"},
    {"damping_beta", &ReductionOptions::beta, "s", "Rayleigh damping, stiffness-proportional part"},
    {"damping_ratio", "-", "",
     "damping ratios of the modes besides: a number or [table, FILE.csv] (frequency in Hz, ratio)",
     [](auto& options, auto& name, auto& o) { o.ratio = damping_ratio(options, name); }},
    {"point_mass_<set>", &ReductionOptions::point_mass, "kg",
     "mass spread evenly over the nodes of a node set or face set", kPositive},
};

// The node set that restrain_nodes makes.
constexpr const char* kListedNodes = "restrain_nodes";

OptionTable table() {
  OptionTable table = table_of(kMeshRows, kImportedRows, kRows);
  for (const OptionTable& more : {basis_table(), material_table()})
    table.insert(table.end(), more.begin(), more.end());
  return table;
}

int window(const Options& options) {
  return options.text("window") == "auto" ? reduction::kAutomaticWindow : options.count("window");
}

// SLEPc's -eps_nev is the number of modes, and -eps_interval takes its place.
void set_extent(const Options& options, reduction::ReductionOptions& o) {
  if (options.given("eps_nev")) {
    const std::vector<std::string> words = options.list("eps_nev");
    const auto n_modes = words.size() == 1 ? parse<int>(words[0]) : std::nullopt;
    require(n_modes && *n_modes >= 1, "option -eps_nev must be a whole number of at least 1");
    require(!options.given("modes") || *n_modes == o.n_modes, "options -modes = ", o.n_modes,
            " and -eps_nev = ", *n_modes, ": both are the number of modes, give one");
    o.n_modes = *n_modes;
  }
  if (!options.given("eps_interval")) return;
  const std::vector<std::string> ends = options.list("eps_interval");
  require(ends.size() == 2, "option -eps_interval must be two numbers a,b in (rad/s)^2");
  const auto lower = parse<double>(ends[0]), upper = parse<double>(ends[1]);
  require(lower && upper && *lower < *upper, "option -eps_interval = '", ends[0], ",", ends[1],
          "': must be two numbers a < b in (rad/s)^2");
  require(!options.given("modes") && !options.given("eps_nev"),
          "option -eps_interval takes all modes in it: leave -modes and -eps_nev out");
  require(o.basis == model::Basis::modal && !o.ritz,
          "option -eps_interval is for -basis modal_residual or modal");
  o.interval = reduction::Interval{*lower, *upper};
}

double unit_in_m(const Options& options) { return options.choice("unit", {"m", "mm"}) == 0 ? 1 : 1e-3; }

std::optional<ImportedFiles> imported_files(const Options& options) {
  if (!options.given("stiffness")) {
    for (const char* name : {"mass", "matrix_format", "dofs", "nodes"})
      require(!options.given(name), "option -", name, " needs -stiffness, a matrix of another program");
    return {};
  }
  ImportedFiles files;
  read_rows(options, kImportedRows, files);
  require(files.format != io::MatrixFormat::calculix || !files.dofs.empty(),
          "option -matrix_format = 'calculix' needs -dofs, the .dof file beside the matrices");
  files.stiffness_unit = files.mass_unit = 1 / unit_in_m(options);  // N and s stay: N/mm, t = N s^2/mm
  return files;
}

void set_restraint(const Options& options, ReductionOptions& o) {
  o.restrain = options.list("restrain");
  o.floating = o.restrain == std::vector<std::string>{"none"};
  if (o.floating) o.restrain.clear();
  if (!options.list("restrain_nodes").empty()) o.restrain.push_back(kListedNodes);
  const bool word = options.given("frame") && options.list("frame").size() == 1;
  if (options.given("frame") && !word)
    o.frame_origin = options.vector("frame");
  else
    o.frame_at_center = word ? options.choice("frame", {"mesh", "centre_of_mass"}) == 1 : o.floating;
}

// Before the work starts; an Error where the machine has not the memory.
void print_cost(const reduction::StaticResponseCost& cost) {
  constexpr double kLong = 120, kMuch = 4e9;  // s, bytes
  const std::string remedy =
      "name the face sets that contact may touch by option loaded to save time and memory";
  const double memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  print_item("static responses", std::to_string(cost.n_columns) + " solutions for " +
                                     std::to_string(cost.n_nodes) + " nodes that contact may touch: about " +
                                     duration(cost.seconds) + " and " + with_unit(1e-9 * cost.bytes, "GB"));
  require(cost.bytes < memory, "the static responses need about ", 1e-9 * cost.bytes,
          " GB, this machine has ", 1e-9 * memory, " GB: ", remedy);
  if (cost.seconds > kLong || cost.bytes > kMuch) print_item("advice", remedy);
}

ReductionOptions reduction_options(const Options& options) {
  ReductionOptions o;
  o.name = std::filesystem::path(options.text("output")).stem().string();
  o.regions = material_options(options);
  o.imported = imported_files(options);
  read_rows(options, kMeshRows, o);
  read_rows(options, kRows, o);
  set_restraint(options, o);
  set_basis(options, o);
  set_extent(options, o);
  o.window = window(options);
  if (o.window == 0) o.symmetry = reduction::Symmetry::none;
  o.announce = print_cost;
  o.provenance = options.provenance();
  return o;
}

// Without a contact surface nothing can be loaded.
void drop_static_responses(ReductionOptions& o) {
  if (!o.flexibility || !o.surface.empty() || !o.loaded.empty()) return;
  o.flexibility = false;
  print_item("basis",
             "modal: without a contact surface (-surface) there are no static responses to forces on it");
}

struct Nodes {
  mesh::Mesh mesh;
  mesh::ReadReport report;
};

Nodes read_nodes(const Options& options) {
  Nodes nodes;
  if (!options.given("nodes")) {
    nodes.mesh = mesh::read_mesh(options.text("mesh"), unit_in_m(options), &nodes.report);
    return nodes;
  }
  const std::string path = options.text("nodes");
  require(!options.given("mesh"), "options -mesh and -nodes: only one of them can give the nodes");
  std::ifstream in(path);
  require(in.good(), path, ": cannot be opened");
  io::NodeTable table = io::read_node_table(in, path);
  nodes.mesh.X = unit_in_m(options) * table.X;
  nodes.report.node_number = std::move(table.number);
  return nodes;
}

std::vector<int> listed_nodes(const Options& options, const std::vector<std::int64_t>& numbers) {
  std::vector<int> nodes;
  for (const std::string& text : options.list("restrain_nodes")) {
    const auto number = parse<std::int64_t>(text);
    const auto found = std::lower_bound(numbers.begin(), numbers.end(), number.value_or(0));
    require(number && found != numbers.end() && *found == *number,
            "option -restrain_nodes: there is no node '", text, "'");
    nodes.push_back(static_cast<int>(found - numbers.begin()));
  }
  sort_unique(nodes);
  return nodes;
}

// Single nodes that are named by their numbers where a set may stand.
void add_numbers(const Options& options, Nodes& nodes) {
  for (const char* option : {"markers", "stress_nodes"})
    add_numbered_nodes(nodes.mesh, nodes.report.node_number, option, options.list(option));
  add_numbered_nodes(nodes.mesh, nodes.report.node_number, "restrain",
                     restrained_sets(nodes.mesh, options.list("restrain")));
}

Nodes read_on_rank_0(const Options& options) {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  Nodes nodes;
  collectively(PETSC_COMM_WORLD, [&] {
    if (rank != 0) return;
    nodes = read_nodes(options);
    const auto listed = listed_nodes(options, nodes.report.node_number);
    if (!listed.empty()) nodes.mesh.node_sets[kListedNodes] = listed;
    add_numbers(options, nodes);
  });
  for (const std::string& ignored : nodes.report.ignored) print_item("ignored in the mesh", ignored);
  for (const std::string& other : nodes.report.read_as) print_item("warning", other);
  return nodes;
}

// Materials and restraint that the options leave open are those of the mesh file.
void take_materials(const Options& options, const mesh::ReadReport& report, ReductionOptions& o) {
  if (!o.regions.empty()) return warn_of_materials(o.regions, false);
  o.regions = report.regions;
  broadcast(PETSC_COMM_WORLD, o.regions);
  if (o.regions.empty() && o.imported) return;
  require(!o.regions.empty(), "option -material_E is missing, and ", options.text("mesh"),
          " gives no material to its cells (*SOLID SECTION)");
  o.provenance["materials_from"] = "mesh";
  warn_of_materials(o.regions, true);
  print_item("materials", "from the mesh file");
}

void take_restraint(const Options& options, const mesh::ReadReport& report, ReductionOptions& o) {
  if (options.given("restrain") || options.given("restrain_nodes")) return;
  if (report.restrained.empty()) return;
  o.restrain = report.restrained;
  std::string& from = o.provenance["restraint_from"] = "mesh:";
  for (const std::string& hold : o.restrain) from += " " + hold;
  print_item("restraint", "from the mesh file");
}

std::string vector_text(const Eigen::Vector3d& v, const std::string& unit) {
  std::ostringstream text;
  text.precision(6);
  text << "(" << v[0] << ", " << v[1] << ", " << v[2] << ") " << unit;
  return text.str();
}

std::string percent(const Eigen::RowVectorXd& shares) {
  std::string text;
  for (double share : shares) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.1f", text.empty() ? "" : "  ", 100 * share);
    text += number;
  }
  return text + " %";
}

// Tables of a row per mode are left to the file.
void print_check(const model::Check& check) {
  if (check.name == "captured_mass") {
    print_item("mass captured, x y z rx ry rz", percent(check.value.row(0)) + " of what all modes carry");
    print_item("", percent(check.value.row(1)) + " of the body's");
  } else if (check.name == "rigid_coupling") {
    print_item("coupling to rigid motions", "at most " + with_unit(check.value.maxCoeff(), ""));
  } else if (check.name == "static_completeness") {
    Eigen::Index worst = 0, best = 0;
    const double low = check.value.col(0).minCoeff(&worst), high = check.value.col(0).maxCoeff(&best);
    print_item("static completeness",
               percent(Eigen::RowVectorXd::Constant(1, low)) + " (" + check.row[worst] + ") to " +
                   percent(Eigen::RowVectorXd::Constant(1, high)) + " (" + check.row[best] + ")");
  }
}

// Ritz vectors have no residuals here: they are no eigenmodes.
void print_modes(const reduction::ReductionReport& report) {
  const bool eigenmodes = report.residual.size() > 0;
  print_item(eigenmodes ? "modes" : "Ritz vectors", std::to_string(report.frequency.size()));
  print_item("frequency range", with_unit(report.frequency.minCoeff(), "Hz") + " to " +
                                    with_unit(report.frequency.maxCoeff(), "Hz"));
  if (eigenmodes) print_item("largest residual", with_unit(report.residual.maxCoeff(), ""));
  print_item("largest phi_i' M phi_j", with_unit(report.orthogonality, ""));
  if (eigenmodes) print_item("count", "complete, by the inertia of K - sigma M");
}

void print_summary(const reduction::ReductionReport& report, const std::string& output) {
  print_item("nodes / elements", std::to_string(report.n_nodes) + " / " + std::to_string(report.n_cells));
  print_item("degrees of freedom", std::to_string(report.n_dofs) + ", free " + std::to_string(report.n_free));
  print_item("ranks", std::to_string(report.n_ranks) + ", faces cut " + std::to_string(report.edge_cut) +
                          ", largest part / mean " + with_unit(report.balance, ""));
  if (!report.symmetry.empty()) print_item("symmetry", report.symmetry);
  print_item("body frame's origin", vector_text(report.origin, "m of the mesh"));
  print_item("mass", with_unit(report.m, "kg"));
  print_item("centre of mass", vector_text(report.c, "m"));
  print_item("inertia about it, diagonal", vector_text(report.J.diagonal(), "kg m^2"));
  print_item("off-diagonal yz, xz, xy",
             vector_text({report.J(1, 2), report.J(0, 2), report.J(0, 1)}, "kg m^2"));
  if (report.discarded > 0)
    print_item("discarded", std::to_string(report.discarded) + " stored pieces of another reduction");
  if (!report.continued_after.empty())
    print_item("continued after", report.continued_after + " of a run that was killed");
  if (report.frequency.size() > 0) print_modes(report);
  for (const model::Check& check : report.checks) print_check(check);
  for (const reduction::StageTime& stage : report.times)
    print_item("time: " + stage.stage, duration(stage.seconds));
  print_item("written", output);
}

void run(const Options& options, const std::vector<std::string>&) {
  options.reject_unknown();
  const std::string output = options.text("output");
  protect_inputs(options, {{"output", {output}}});
  ReductionOptions reduction = reduction_options(options);
  const OutputLock lock(output);
  const Nodes nodes = read_on_rank_0(options);
  if (reduction.imported) reduction.imported->node_number = nodes.report.node_number;
  drop_static_responses(reduction);
  take_materials(options, nodes.report, reduction);
  take_restraint(options, nodes.report, reduction);
  print_restraint(nodes.mesh, reduction.restrain);
  print_named_sets(nodes.mesh, "marker", reduction.markers);
  warn_of_size(nodes.mesh, unit_in_m(options));
  if (reduction.stress_nodes.empty())
    print_item("warning", "no -stress_nodes are named: recover will have no stresses of this body");
  if (const std::string advice = blas_advice(); !advice.empty()) print_item("advice", advice);
  const reduction::ReductionReport report =
      reduction::reduce(PETSC_COMM_WORLD, nodes.mesh, reduction, output, console_progress());
  print_summary(report, output);
}

}  // namespace

Verb reduce_verb() {
  return {"reduce",
          "reduce body.yaml [-option value ...]",
          "finite-element mesh -> body file; run under mpirun for large meshes",
          table(),
          run,
          true};
}

}  // namespace elastogear::app
