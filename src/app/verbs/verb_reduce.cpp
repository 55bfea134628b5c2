// elastogear reduce: mesh + material + basis -> body file.

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numeric>
#include <sstream>

#include "app/console/blas_kernels.h"
#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/console/plausibility.h"
#include "app/gear/design_options.h"
#include "app/gear/drive_options.h"
#include "app/input/length_unit.h"
#include "app/options/rows.h"
#include "app/options/verbs.h"
#include "app/setup/resumable_run.h"
#include "app/tables/material_options.h"
#include "app/tables/reduce_options.h"
#include "app/verbs/named_sets.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/log_stage.h"
#include "elastogear/base/number.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/sort_unique.h"
#include "elastogear/mesh/file.h"
#include "elastogear/mesh/joints.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::app {
namespace {

using reduction::ReductionOptions;

// Before the work starts; an Error where the machine has not the memory.
void print_cost(const reduction::StaticResponseCost& cost, bool in_short) {
  constexpr double kLong = 120, kMuch = 4e9;  // s, bytes
  const std::string remedy =
      "name the face sets that contact may touch by option loaded to save time and memory";
  const double memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  if (!in_short)
    print_item("static responses", std::to_string(cost.n_columns) + " loads on " +
                                       std::to_string(cost.n_nodes) +
                                       " nodes that contact may touch: about " + duration(cost.seconds) +
                                       " and " + with_unit(1e-9 * cost.bytes, "GB"));
  if (cost.n_states > 0 && !in_short)
    print_item("relaxed states", std::to_string(cost.n_states) + ", of as many static responses each");
  require(cost.bytes < memory, "the static responses need about ", 1e-9 * cost.bytes,
          " GB, this machine has ", 1e-9 * memory, " GB: ", remedy);
  if (cost.seconds > kLong || cost.bytes > kMuch) print_item("advice", remedy);
}

// Without a contact surface only markers can be loaded.
void drop_static_responses(ReductionOptions& o) {
  if (!o.flexibility || !o.surface.empty() || !o.loaded.empty()) return;
  o.flexibility = false;
  print_item("basis", o.markers.empty() ? "modal: there are neither a contact surface (-surface) nor markers "
                                          "whose static responses it could have"
                                        : "eigenmodes and static responses to loads at markers: there is no "
                                          "contact surface (-surface)");
}

struct Nodes {
  mesh::Mesh mesh;
  mesh::ReadReport report;
  std::vector<std::string> open;  // what cells leave open between them
};

void look_at_joints(const std::string& file, Nodes& nodes) {
  mesh::JointFaults faults = mesh::joint_faults(nodes.mesh, nodes.report);
  require(faults.overlap.empty(), file, ": ", faults.overlap);
  nodes.open = std::move(faults.open);
}

Nodes read_nodes(const Options& options) {
  Nodes nodes;
  if (!options.given("nodes")) {
    nodes.mesh = mesh::read_mesh(options.text("mesh"), unit_in_m(options), &nodes.report,
                                 options.given("instance") ? options.text("instance") : "");
    // Matrices of another program may join what the mesh does not.
    if (!options.given("stiffness")) look_at_joints(options.text("mesh"), nodes);
    return nodes;
  }
  const std::string path = options.text("nodes");
  require(!options.given("mesh"), "options -mesh and -nodes: only one of them can give the nodes");
  std::ifstream in = open_input(path);
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

using NodeSource = std::function<Nodes()>;

Nodes read_on_rank_0(const Options& options, const NodeSource& read) {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  Nodes nodes;
  collectively(PETSC_COMM_WORLD, [&] {
    if (rank != 0) return;
    nodes = read();
    const auto listed = listed_nodes(options, nodes.report.node_number);
    if (!listed.empty()) nodes.mesh.node_sets[kListedNodes] = listed;
    add_numbers(options, nodes);
  });
  for (const std::string& ignored : nodes.report.ignored) print_item("ignored in the mesh", ignored);
  for (const std::string& lost : nodes.report.lost) print_item("warning", "lost of the mesh file: " + lost);
  for (const std::string& other : nodes.report.read_as) print_item("warning", other);
  for (const std::string& open : nodes.open) print_item("warning", open);
  return nodes;
}

// Materials and restraint that the options leave open are those of the mesh file.
void take_materials(const Options& options, const mesh::ReadReport& report, ReductionOptions& o) {
  if (!o.regions.empty()) return warn_of_materials(o.regions, false);
  if (!report.regions.empty())
    require_consistent_unit(options,
                            "materials of the mesh file (leave them out by -material_E and the like)");
  o.regions = report.regions;
  broadcast(PETSC_COMM_WORLD, o.regions);
  if (o.regions.empty() && o.imported) return;
  if (o.regions.empty() && is_drive(options)) {  // with a mesh of its user's
    o.regions = material_options(with_steel(options));
    return print_detail("material",
                        "steel: 210 GPa, nu 0.3, 7850 kg/m^3 (neither options nor the mesh give any)");
  }
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

// Point masses of the file are those of the body unless options name some.
void take_point_masses(const mesh::ReadReport& report, ReductionOptions& o) {
  if (!o.point_mass.empty() || o.imported) return;
  int n = static_cast<int>(report.point_mass.size());  // rank 0 alone knows
  MPI_Bcast(&n, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  o.point_mass = report.point_mass;
  if (n > 0 && o.point_mass.empty()) o.point_mass[""] = 1;  // other ranks ask only whether there are some
  for (const auto& [set, mass] : report.point_mass) {
    o.provenance["option_point_mass_" + set] = with_unit(mass, "kg") + " from the mesh";
    print_item("point mass", with_unit(mass, "kg") + " on node set " + set + ", from the mesh file");
  }
}

std::string vector_text(const Eigen::Vector3d& v, const std::string& unit) {
  std::ostringstream text;
  text.precision(6);
  text << "(" << v[0] << ", " << v[1] << ", " << v[2] << ") " << unit;
  return text.str();
}

// Nothing can be captured along a direction in which all nodes are held.
std::string percent_of_each(const Eigen::RowVectorXd& shares) {
  std::string text;
  for (double share : shares) {
    char number[32] = "none";
    if (std::isfinite(share)) std::snprintf(number, sizeof number, "%.1f", 100 * share);
    text += (text.empty() ? "" : "  ") + std::string(number);
  }
  return text + " %";
}

// Tables of a row per mode are left to the file.
void print_check(const model::Check& check) {
  if (check.name == "captured_mass") {
    print_item("mass captured, x y z rx ry rz",
               percent_of_each(check.value.row(0)) + " of what all modes carry");
    print_item("", percent_of_each(check.value.row(1)) + " of the body's");
  } else if (check.name == "rigid_coupling") {
    print_item("coupling to rigid motions", "at most " + with_unit(check.value.maxCoeff(), ""));
  } else if (check.name == "static_completeness") {
    Eigen::Index worst = 0, best = 0;
    const double low = check.value.col(0).minCoeff(&worst), high = check.value.col(0).maxCoeff(&best);
    print_item("static completeness",
               percent_of_each(Eigen::RowVectorXd::Constant(1, low)) + " (" + check.row[worst] + ") to " +
                   percent_of_each(Eigen::RowVectorXd::Constant(1, high)) + " (" + check.row[best] + ")");
  }
}

// The lowest ones and the highest.
std::string frequencies_text(const Eigen::VectorXd& f) {
  constexpr Eigen::Index kLowest = 4;
  std::string text;
  for (Eigen::Index i = 0; i < std::min(kLowest, f.size()); ++i)
    text += (i > 0 ? ", " : "") + with_unit(f[i], "Hz");
  return f.size() > kLowest ? text + " to " + with_unit(f[f.size() - 1], "Hz") : text;
}

// Ritz vectors have no residuals here: they are no eigenmodes.
void print_modes(const reduction::ReductionReport& report) {
  const bool eigenmodes = report.residual.size() > 0;
  print_item(eigenmodes ? "modes" : "Ritz vectors", std::to_string(report.frequency.size()));
  print_item("frequencies", frequencies_text(report.frequency));
  if (const Eigen::VectorXd& f = report.attachment; f.size() > 0)
    print_item("attachment modes", std::to_string(f.size()) + " besides, by loads at markers, " +
                                       with_unit(f.minCoeff(), "Hz") + " to " +
                                       with_unit(f.maxCoeff(), "Hz"));
  if (eigenmodes) print_item("largest residual", with_unit(report.residual.maxCoeff(), ""));
  print_item("largest phi_i' M phi_j", with_unit(report.orthogonality, ""));
  if (eigenmodes) print_item("count", "complete, by the inertia of K - sigma M");
}

void print_summary(const reduction::ReductionReport& report, const std::string& output) {
  print_item("nodes / elements", std::to_string(report.n_nodes) + " / " + std::to_string(report.n_cells));
  print_item("degrees of freedom", std::to_string(report.n_dofs) + ", free " + std::to_string(report.n_free));
  const bool divided = report.n_ranks == 1 || report.edge_cut > 0;
  print_item("ranks", std::to_string(report.n_ranks) +
                          (divided ? ", faces cut " + std::to_string(report.edge_cut) +
                                         ", largest part / mean " + with_unit(report.balance, "")
                                   : ", the mesh is not divided among them"));
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

// A line for a body of a drive.
void print_in_short(const reduction::ReductionReport& report, const std::string& output) {
  constexpr double kKilo = 1e-3;
  double seconds = 0;
  for (const reduction::StageTime& stage : report.times) seconds += stage.seconds;
  std::string text = std::to_string(report.n_cells) + " elements";
  if (const Eigen::VectorXd& f = report.frequency; f.size() > 0)
    text += ", " + std::to_string(f.size()) + " modes up to " + short_number(kKilo * f.maxCoeff()) + " kHz";
  if (!report.continued_after.empty())
    text += ", continued after " + report.continued_after + " of a run that was killed";
  print_item("written", output + ": " + text + ", in " + duration(seconds));
}

void reduce_body(const Options& options, const NodeSource& read) {
  const std::string output = options.text("output");
  std::vector<Outputs> outputs{{"output", {output}}};
  // Body files that the input names are those that runs read afterwards.
  for (const std::string& body : options.placeholder_values("<gear>_file"))
    outputs.push_back({with_word("<gear>_file", body), {}});
  protect_inputs(options, outputs);
  ReductionOptions reduction = reduction_options(options);
  add_inputs(options, {}, reduction.provenance);
  const bool in_short = is_drive(options) && !is_verbose();
  reduction.announce = [=](const reduction::StaticResponseCost& cost) { print_cost(cost, in_short); };
  const OutputLock lock(output);
  const Nodes nodes = [&] {
    const LogStage stage("mesh");
    return read_on_rank_0(options, read);
  }();
  if (reduction.imported) reduction.imported->node_number = nodes.report.node_number;
  drop_static_responses(reduction);
  take_materials(options, nodes.report, reduction);
  take_restraint(options, nodes.report, reduction);
  take_point_masses(nodes.report, reduction);
  {
    const Silence chosen_by_the_drive(in_short);
    print_restraint(nodes.mesh, reduction.restrain);
    print_named_sets(nodes.mesh, "marker", reduction.markers);
    print_named_sets(nodes.mesh, "stress nodes", reduction.stress_nodes);
  }
  warn_of_size(nodes.mesh, unit_in_m(options));
  if (!reduction.imported) {
    warn_of_shapes(nodes.mesh, nodes.report.cell_number);
    warn_of_locking(nodes.mesh, reduction.regions, reduction.element);
  }
  if (reduction.stress_nodes.empty())
    print_item("warning", "no -stress_nodes are named: recover will have no stresses of this body");
  if (const std::string advice = blas_advice(); !advice.empty()) print_item("advice", advice);
  const reduction::ReductionReport report =
      reduction::reduce(PETSC_COMM_WORLD, nodes.mesh, reduction, output, console_progress());
  in_short ? print_in_short(report, output) : print_summary(report, output);
}

// All members of a drive file, each meshed or checked here, so that bodies and drive belong together.
void reduce_drive(const Options& options) {
  const Drive drive = read_drive(options);
  const MeshDensity density = mesh_density(options);
  std::vector<Outputs> bodies;
  for (const DriveMember& member : drive.members)
    bodies.push_back({member.name + "_file", {body_file(options, member)}});
  protect_inputs(options, bodies);
  print_facts(drive);
  for (const DriveMember& member : drive.members) {
    print_detail("body " + member.name, "");
    reduce_body(member_options(options, member), [&] {
      Nodes nodes;
      nodes.mesh = member.mesh(density, nodes.report);
      if (const std::string own = own_mesh(options, member.name); !own.empty()) {
        look_at_joints(own, nodes);
        return nodes;
      }
      nodes.report.node_number.resize(static_cast<std::size_t>(nodes.mesh.n_nodes()));
      std::iota(nodes.report.node_number.begin(), nodes.report.node_number.end(), 1);
      return nodes;
    });
  }
}

void run_reduce(const Options& given, const std::vector<std::string>&) {
  const Options options = with_gears(given);
  options.reject_unknown();
  if (is_drive(options)) return reduce_drive(options);
  reduce_body(options, [&] { return read_nodes(options); });
}

OptionTable all_reduce_options() {
  OptionTable table = reduce_table();
  const OptionTable of_drives = whole_drive_table();
  table.insert(table.end(), of_drives.begin(), of_drives.end());
  return table;
}

}  // namespace

Verb reduce_verb() {
  return {"reduce",
          "reduce body.yaml [-option value ...]",
          "finite-element mesh -> body file, or drive file -> all its bodies; under mpirun for large meshes",
          all_reduce_options(),
          run_reduce,
          "-eps_*, -st_*, ",
          true};
}

}  // namespace elastogear::app
