#include "app/console/plausibility.h"

#include <algorithm>
#include <numeric>

#include "app/console/console.h"
#include "elastogear/io/body_materials.h"
#include "elastogear/mesh/quality.h"

namespace elastogear::app {
namespace {

// From soft rubber to diamond; from cork to osmium.
constexpr double kSoftest = 1e6, kStiffest = 2e12;         // Pa
constexpr double kLightest = 50, kHeaviest = 30e3;         // kg/m^3
constexpr double kWeakest = 1e6, kStrongest = 2e10;        // Pa, that a material endures
constexpr double kLargestBody = 10, kSmallestBody = 1e-4;  // m, a mesh's longest side

// Poisson's ratios from which frequencies of a block that is held at one end are 2 % and more too high
// (docs/theory, section 1.1).
constexpr double kLocksIncompatible = 0.49, kLocks = 0.45;

constexpr double kPoorShape = 0.1;  // scaled Jacobian

constexpr const char* kDirectional[] = {"E1", "E2", "E3"};

// In GPa where that is a material of gears, from plastics to hard metal; else in MPa, then in GPa, where that
// is any material.
std::string modulus_meant(double E) {
  constexpr double kPlastic = 1e9, kHardMetal = 7e11;  // Pa
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  const std::string in_giga = "; GPa meant? Then give " + with_unit(E, "GPa");
  if (within(1e9 * E, kPlastic, kHardMetal)) return in_giga;
  if (within(1e6 * E, kSoftest * 100, kStiffest)) return "; MPa meant? Then give " + with_unit(E, "MPa");
  return within(1e9 * E, kSoftest, kStiffest) ? in_giga : "";
}

std::string density_meant(double rho) {
  const auto fits = [](double value) { return value >= kLightest && value <= kHeaviest; };
  if (fits(1e12 * rho)) return "; t/mm^3 meant? Then give " + with_unit(1e12 * rho, "kg/m^3");
  if (fits(1e3 * rho)) return "; g/cm^3 meant? Then give " + with_unit(1e3 * rho, "kg/m^3");
  if (fits(1e9 * rho)) return "; kg/mm^3 meant? Then give " + with_unit(1e9 * rho, "kg/m^3");
  return "";
}

void warn(const model::MaterialRegion& region, bool from_mesh, const std::string& constant,
          const std::string& value, const std::string& meant) {
  const std::string set = region.cell_set.empty() ? "" : region.cell_set + "_";
  const std::string name = from_mesh ? constant + " of '" + region.cell_set + "' in the mesh file"
                                     : "option -material_" + set + constant;
  print_item("warning", name + " = " + value + " is no material of a gear" + meant +
                            (from_mesh ? "; a mesh file in mm, N and t needs -unit mm" : ""));
}

// At once, and after all relaxation: by what is left of the shear and the bulk modulus.
double largest_poisson(const model::Material& material) {
  if (material.orthotropic) return 0;
  if (!material.viscoelastic) return material.nu;
  const auto left = [](const std::vector<double>& shares) {
    return 1 - std::accumulate(shares.begin(), shares.end(), 0.0);
  };
  const double G = left(material.viscoelastic->g) / (2 * (1 + material.nu));
  const double K = left(material.viscoelastic->k) / (3 * (1 - 2 * material.nu));
  return G + K > 0 ? std::max(material.nu, (3 * K - 2 * G) / (2 * (3 * K + G))) : material.nu;
}

// Has the set, or without such a set the mesh, cells of one of these types?
bool has_cells(const mesh::Mesh& mesh, const std::string& cell_set,
               const std::vector<mesh::CellType>& types) {
  const auto is_one = [&](mesh::CellType type) {
    return std::find(types.begin(), types.end(), type) != types.end();
  };
  const auto set = mesh.cell_sets.find(cell_set);
  if (set == mesh.cell_sets.end()) return std::any_of(mesh.cells.type.begin(), mesh.cells.type.end(), is_one);
  return std::any_of(set->second.begin(), set->second.end(),
                     [&](int cell) { return is_one(mesh.cells.type[cell]); });
}

}  // namespace

void warn_of_locking(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions,
                     model::Element element) {
  using enum mesh::CellType;
  using model::Element;
  for (const auto& [cell_set, material] : regions) {
    const double nu = largest_poisson(material);
    const std::string nearly =
        "Poisson's ratio " + std::to_string(nu) + " is nearly that of no compressibility: ";
    const bool hexahedra = has_cells(mesh, cell_set, {hex8});
    if (hexahedra && element == Element::incompatible && nu >= kLocksIncompatible)
      print_item("warning",
                 nearly +
                     "8-node hexahedra with incompatible modes are too stiff (frequencies of a block "
                     "2 % high at 0.49, 13 % at 0.4999); give -element bbar");
    if (hexahedra && element == Element::plain && nu >= kLocks)
      print_item("warning",
                 nearly +
                     "plain 8-node hexahedra are too stiff (frequencies of a block 8 % high at 0.45, 87 % "
                     "at 0.4999); give -element bbar");
    if (has_cells(mesh, cell_set, {tet4, wedge6, pyramid5}) && nu >= kLocks)
      print_item("warning",
                 nearly +
                     "linear tetrahedra, prisms and pyramids are too stiff (frequencies of a block 7 to 18 % "
                     "high at 0.45, 19 to 38 % at 0.49); take second-order ones, or hexahedra with "
                     "-element bbar");
  }
}

void warn_of_materials(const std::vector<model::MaterialRegion>& regions, bool from_mesh) {
  for (const model::MaterialRegion& region : regions) {
    const model::Material& m = region.material;
    Eigen::Index largest = 0;
    const double E = m.orthotropic ? m.orthotropic->E.maxCoeff(&largest) : m.E;
    const char* const name = m.orthotropic ? kDirectional[largest] : "E";
    if (E < kSoftest || E > kStiffest) warn(region, from_mesh, name, with_unit(E, "Pa"), modulus_meant(E));
    if (m.rho < kLightest || m.rho > kHeaviest)
      warn(region, from_mesh, "rho", with_unit(m.rho, "kg/m^3"), density_meant(m.rho));
  }
}

void warn_of_density(const std::string& option, double density) {
  if (density >= kLightest && density <= kHeaviest) return;
  print_item("warning", option + " = " + with_unit(density, "kg/m^3") +
                            " is no density of a gear's material" + density_meant(density));
}

void warn_of_strength(const std::string& option, double stress) {
  if (stress >= kWeakest && stress <= kStrongest) return;
  const double if_mega = 1e6 * stress;
  const bool fits = if_mega >= kWeakest && if_mega <= kStrongest;
  print_item("warning", option + " = " + with_unit(stress, "Pa") + " is no strength of a gear's material" +
                            (fits ? "; MPa meant? Then give " + with_unit(stress, "MPa") : ""));
}

void warn_of_shapes(const mesh::Mesh& mesh, const std::vector<std::int64_t>& cell_number) {
  int n_poor = 0, worst = -1;
  double least = kPoorShape;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const double shape = mesh::scaled_jacobian(mesh, cell);
    if (shape >= kPoorShape) continue;
    ++n_poor;
    if (shape < least) worst = cell;
    least = std::min(least, shape);
  }
  if (worst < 0) return;
  const auto number = cell_number.empty() ? worst : cell_number[static_cast<std::size_t>(worst)];
  print_item("warning", std::to_string(n_poor) + (n_poor == 1 ? " cell is" : " cells are") +
                            " nearly flat or folded, worst cell " + std::to_string(number) +
                            " with the scaled Jacobian " + with_unit(least, "") +
                            "(1: a regular cell): stresses there are not to be trusted");
}

void warn_of_size(const mesh::Mesh& mesh, double unit_in_m) {
  if (mesh.X.cols() == 0) return;
  const double size = (mesh.X.rowwise().maxCoeff() - mesh.X.rowwise().minCoeff()).maxCoeff();
  const std::string is = "the mesh is " + with_unit(size, "m") + " long";
  if (size > kLargestBody)
    print_item("warning", is + (unit_in_m == 1 ? ": is it in mm? Then give -unit mm" : ""));
  if (size < kSmallestBody)
    print_item("warning", is + (unit_in_m < 1 ? ": is it in m? Then give -unit m" : ""));
}

void warn_of_strain(const io::StressSet& set, const std::string& body_file) {
  constexpr double kLargestStrain = 0.05;
  double E = 0;
  for (const model::MaterialRegion& region : io::read_body_materials(body_file).regions)
    E = std::max(E,
                 region.material.orthotropic ? region.material.orthotropic->E.maxCoeff() : region.material.E);
  const double stress = set.von_mises.size() > 0 ? set.von_mises.maxCoeff() : 0;
  if (E <= 0 || stress <= kLargestStrain * E) return;
  print_item("warning",
             set.body + " " + set.set + ": " + with_unit(1e-6 * stress, "MPa") + " stretches it by " +
                 with_unit(100 * stress / E, "%") +
                 " or more: the equations are linear in strains, which must be small; are loads and "
                 "moduli those that were meant?");
}

void warn_of_idle_pairs(const dynamics::RunSummary& run) {
  for (const dynamics::PairSummary& pair : run.pair)
    if (pair.peak_force == 0 && pair.penetration == 0)
      print_item("warning",
                 "the bodies of " + pair.name +
                     " never touch in the whole run: look at their positions and rotations, at the "
                     "direction of their motion and at the time simulated");
}

}  // namespace elastogear::app
