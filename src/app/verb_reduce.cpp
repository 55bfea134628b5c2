// elastogear reduce: mesh + material + basis -> body file.

#include <filesystem>
#include <sstream>

#include "app/console.h"
#include "app/verbs.h"
#include "elastogear/base/agree.h"
#include "elastogear/base/petsc.h"
#include "elastogear/mesh/file.h"
#include "elastogear/reduction/eigenmodes.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::app {
namespace {

const OptionTable kTable = {
    {"mesh", "-", "", "volume mesh to read, Gmsh 4.1 .msh or Abaqus .inp"},
    {"unit", "-", "m", "unit of length of the mesh file: m or mm"},
    {"output", "-", "", "body file to write (HDF5)"},
    {"material_E", "Pa", "", "Young's modulus of all cells that no material_<set> names"},
    {"material_nu", "-", "", "Poisson's ratio"},
    {"material_rho", "kg/m^3", "", "density"},
    {"material_<set>_E", "Pa", "", "Young's modulus of one cell set"},
    {"material_<set>_nu", "-", "", "Poisson's ratio of one cell set"},
    {"material_<set>_rho", "kg/m^3", "", "density of one cell set"},
    {"element", "-", "incompatible",
     "8-node hexahedra: incompatible (modes), plain or bbar (mean dilatation)"},
    {"restrain", "-", "", "node sets that are held in all directions and carry the body frame"},
    {"surface", "-", "", "face sets of the contact surface"},
    {"stress_nodes", "-", "", "node sets at which stress modes are stored"},
    {"basis", "-", "modal",
     "modal: eigenmodes; full: every free degree of freedom (the finite-element reference)"},
    {"modes", "-", "100", "number of eigenmodes"},
    {"window", "-", "auto",
     "eigenmodes found at a time, by block Lanczos in windows; 0: all at once by SLEPc; auto: windows of the "
     "best size, or SLEPc when an -eps_* or -st_* option is given"},
    {"store", "-", "all",
     "modes at all nodes, or at the surface and stress nodes only (no whole fields): all or surface"},
    {"precision", "-", "float64", "of modes stored at all nodes: float64 or float32"},
    {"symmetry", "-", "auto",
     "auto: modes from one sector where mesh, materials and restraint repeat around an axis; none: from the "
     "whole body"},
    {"damping_alpha", "1/s", "0", "Rayleigh damping, mass-proportional part"},
    {"damping_beta", "s", "0", "Rayleigh damping, stiffness-proportional part"},
};

model::Material material(const Options& options, const std::string& prefix) {
  return {options.positive(prefix + "E"), options.number(prefix + "nu"), options.positive(prefix + "rho")};
}

std::vector<model::MaterialRegion> regions(const Options& options) {
  std::vector<model::MaterialRegion> regions;
  for (const std::string& set : options.placeholder_values("material_<set>_E"))
    regions.push_back({set, material(options, "material_" + set + "_")});
  if (regions.empty() || options.given("material_E")) regions.push_back({"", material(options, "material_")});
  return regions;
}

// SLEPc's own options ask for SLEPc.
bool asks_for_slepc(const Options& options) {
  return !options.placeholder_values("eps_<option>").empty() ||
         !options.placeholder_values("st_<option>").empty();
}

int window(const Options& options) {
  if (options.text("window") != "auto") return options.count("window");
  return asks_for_slepc(options) ? 0 : reduction::kAutomaticWindow;
}

reduction::ReductionOptions reduction_options(const Options& options) {
  reduction::ReductionOptions o;
  o.name = std::filesystem::path(options.text("output")).stem().string();
  o.regions = regions(options);
  o.element = static_cast<model::Element>(options.choice("element", {"incompatible", "plain", "bbar"}));
  o.restrain = options.list("restrain");
  o.surface = options.list("surface");
  o.stress_nodes = options.list("stress_nodes");
  o.basis = options.choice("basis", {"modal", "full"}) == 0 ? model::Basis::modal : model::Basis::full;
  o.n_modes = options.count("modes", 1);
  o.window = window(options);
  o.store =
      options.choice("store", {"surface", "all"}) == 0 ? reduction::Store::surface : reduction::Store::all;
  o.precision = options.choice("precision", {"float64", "float32"}) == 0 ? io::Precision::float64
                                                                         : io::Precision::float32;
  o.symmetry = options.choice("symmetry", {"auto", "none"}) == 0 ? reduction::Symmetry::automatic
                                                                 : reduction::Symmetry::none;
  o.alpha = options.number("damping_alpha");
  o.beta = options.number("damping_beta");
  o.provenance = options.provenance();
  return o;
}

mesh::Mesh read_on_rank_0(const Options& options) {
  const double unit = options.choice("unit", {"m", "mm"}) == 0 ? 1 : 1e-3;
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  mesh::Mesh mesh;
  mesh::ReadReport report;
  agree(PETSC_COMM_WORLD, [&] {
    if (rank == 0) mesh = mesh::read_mesh(options.text("mesh"), unit, &report);
  });
  for (const std::string& ignored : report.ignored) print_item("ignored in the mesh", ignored);
  return mesh;
}

std::string vector_text(const Eigen::Vector3d& v, const std::string& unit) {
  std::ostringstream text;
  text.precision(6);
  text << "(" << v[0] << ", " << v[1] << ", " << v[2] << ") " << unit;
  return text.str();
}

void print_summary(const reduction::ReductionReport& report, const std::string& output) {
  print_item("nodes / elements", std::to_string(report.n_nodes) + " / " + std::to_string(report.n_cells));
  print_item("degrees of freedom", std::to_string(report.n_dofs) + ", free " + std::to_string(report.n_free));
  print_item("ranks", std::to_string(report.n_ranks) + ", faces cut " + std::to_string(report.edge_cut) +
                          ", largest part / mean " + with_unit(report.balance, ""));
  if (!report.symmetry.empty()) print_item("symmetry", report.symmetry);
  print_item("mass", with_unit(report.m, "kg"));
  print_item("centre of mass", vector_text(report.c, "m"));
  print_item("inertia about it, diagonal", vector_text(report.J.diagonal(), "kg m^2"));
  print_item("off-diagonal yz, xz, xy",
             vector_text({report.J(1, 2), report.J(0, 2), report.J(0, 1)}, "kg m^2"));
  if (report.discarded > 0)
    print_item("discarded", std::to_string(report.discarded) + " stored pieces of another reduction");
  if (!report.continued_after.empty())
    print_item("continued after", report.continued_after + " of a run that was killed");
  if (report.frequency.size() > 0) {
    print_item("modes", std::to_string(report.frequency.size()));
    print_item("frequency range", with_unit(report.frequency.minCoeff(), "Hz") + " to " +
                                      with_unit(report.frequency.maxCoeff(), "Hz"));
    print_item("largest residual", with_unit(report.residual.maxCoeff(), ""));
    print_item("largest phi_i' M phi_j", with_unit(report.orthogonality, ""));
    print_item("count", "complete, by the inertia of K - sigma M");
  }
  for (const reduction::StageTime& stage : report.times)
    print_item("time: " + stage.stage, duration(stage.seconds));
  print_item("written", output);
}

void run(const Options& options, const std::vector<std::string>&) {
  options.reject_unknown();
  const std::string output = options.text("output");
  const reduction::ReductionOptions reduction = reduction_options(options);
  const mesh::Mesh mesh = read_on_rank_0(options);
  const reduction::ReductionReport report =
      reduction::reduce(PETSC_COMM_WORLD, mesh, reduction, output, console_progress());
  print_summary(report, output);
}

}  // namespace

Verb reduce_verb() {
  return {"reduce",
          "reduce body.yaml [-option value ...]",
          "finite-element mesh -> body file; run under mpirun for large meshes",
          kTable,
          run,
          true};
}

}  // namespace elastogear::app
