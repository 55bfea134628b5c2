#include "app/tables/reduce_options.h"

#include <filesystem>

#include "app/input/length_unit.h"
#include "app/options/rows.h"
#include "app/tables/basis_options.h"
#include "app/tables/material_options.h"
#include "app/tables/motion.h"
#include "elastogear/base/error.h"
#include "elastogear/base/number.h"
#include "elastogear/reduction/eigenmodes.h"

namespace elastogear::app {
namespace {

using reduction::ReductionOptions, reduction::ImportedFiles;

const Rows<ReductionOptions> kMeshRows = {
    {"mesh", "-", "", "volume mesh to read, Gmsh 4.1 .msh or Abaqus .inp"},
    {"unit", "-", "m",
     "unit of length of the mesh file or node table: m, mm (then matrices and the file's materials are in N, "
     "mm and t), um or in (then materials are those of options)"},
    {"instance", "-", "", "of an .inp file with several instances of parts, the one that is the body"},
    {"output", "-", "", "body file to write (HDF5)"},
    {"element", &ReductionOptions::element, one_of("incompatible", "plain", "bbar"),
     "8-node hexahedra: incompatible (modes), plain or bbar (mean dilatation)"},
    {"element_mass", &ReductionOptions::element_mass, one_of("compatible", "condensed"),
     "mass of incompatible 8-node hexahedra: compatible (of the shape functions of their nodes) or condensed "
     "(of their incompatible modes too, which the stiffness condenses: upper frequencies err less)"},
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

const Rows<ReductionOptions> kReduceRows = {
    {"frame", "m", "",
     "origin of the body frame: mesh, centre_of_mass, or x,y,z in the mesh's coordinates (default: "
     "centre_of_mass for a free body, else mesh)"},
    {"surface", &ReductionOptions::surface, "-", "face sets of the contact surface"},
    {"stress_nodes", &ReductionOptions::stress_nodes, "-",
     "node sets, or face sets for their nodes, at which stress modes are stored"},
    {"stress_recovery", &ReductionOptions::stress_recovery, one_of("auto", "average", "surface"),
     "stresses at nodes: surface (on surfaces where no force can act, all but surface, loaded, markers, "
     "point_mass_<set> and what is held, from the strains of the surface and its zero traction: errs less "
     "in fillets), average (mean of what the cells there extrapolate), or auto (surface; average where "
     "prony_g and prony_k differ)"},
    {"markers", &ReductionOptions::markers, "-",
     "node sets or face sets whose mean motion is stored, for loads, pressures on face sets, bushings and "
     "sensors of simulate (which always has the body frame); also single nodes by their numbers in the mesh "
     "file, [tip, 4711]. Nodes that outer faces hold together weigh by these, others the same"},
    {"window", "-", "auto",
     "eigenmodes found at a time, by block Lanczos and spectrum slicing (SLEPc's -eps_type block_lanczos); "
     "auto: of the best size; 0: all at once by -eps_type krylovschur, of the whole body. SLEPc's options "
     "work with both, "
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

int window(const Options& options) {
  return options.text("window") == "auto" ? reduction::kAutomaticWindow : options.count("window");
}

// SLEPc's -eps_nev is the number of modes, and -eps_interval takes its place.
void set_extent(const Options& options, ReductionOptions& o) {
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
  require(!o.interval && !options.given("modes") && !options.given("eps_nev"),
          "option -eps_interval takes all modes in it: leave -modes and -eps_nev out");
  require(o.basis == model::Basis::modal && !o.ritz,
          "option -eps_interval is for -basis modal_residual or modal");
  o.interval = reduction::Interval{*lower, *upper};
}

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
  require_consistent_unit(options, "matrices");
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

// Options of SLEPc that say how eigenmodes are found.
std::map<std::string, std::string> solver_options(const Options& options) {
  std::map<std::string, std::string> solver;
  for (const auto& [key, value] : options.provenance()) {
    const std::string name = key.starts_with("option_") ? key.substr(7) : "";
    const bool finds = name.starts_with("eps_") || name.starts_with("st_");
    if (finds && !name.starts_with("eps_monitor") && !name.starts_with("eps_view")) solver[name] = value;
  }
  return solver;
}

}  // namespace

OptionTable reduce_table() {
  OptionTable table = table_of(kMeshRows, kImportedRows, kReduceRows);
  for (const OptionTable& more : {basis_table(), material_table()})
    table.insert(table.end(), more.begin(), more.end());
  return table;
}

ReductionOptions reduction_options(const Options& options) {
  ReductionOptions o;
  o.name = std::filesystem::path(options.text("output")).stem().string();
  o.regions = material_options(options);
  o.imported = imported_files(options);
  read_rows(options, kMeshRows, o);
  read_rows(options, kReduceRows, o);
  set_restraint(options, o);
  set_basis(options, o);
  set_extent(options, o);
  o.window = window(options);
  if (o.window == 0) o.symmetry = reduction::Symmetry::none;
  o.provenance = options.provenance();
  o.solver = solver_options(options);
  return o;
}

}  // namespace elastogear::app
