#include "app/tables/material_options.h"

#include <algorithm>
#include <set>

namespace elastogear::app {
namespace {

const OptionTable kMaterial = {
    {"E", "Pa", "", "Young's modulus"},
    {"nu", "-", "", "Poisson's ratio"},
    {"rho", "kg/m^3", "", "density"},
    {"E1", "Pa", "", "orthotropic: Young's modulus along the material's axis 1"},
    {"E2", "Pa", "", "along axis 2"},
    {"E3", "Pa", "", "along axis 3"},
    {"nu12", "-", "", "strain along -2 per strain along 1 when pulled along 1"},
    {"nu13", "-", "", "strain along -3 when pulled along 1"},
    {"nu23", "-", "", "strain along -3 when pulled along 2"},
    {"G12", "Pa", "", "shear modulus of the plane 1 2"},
    {"G13", "Pa", "", "shear modulus of the plane 1 3"},
    {"G23", "Pa", "", "shear modulus of the plane 2 3"},
    {"orientation", "-", "rectangular",
     "rectangular: axis 1 along axis_1, axis 2 in the plane of axis_1 and axis_2; cylindrical: radial, "
     "tangential, axial"},
    {"axis_1", "-", "1,0,0", "rectangular: direction of axis 1"},
    {"axis_2", "-", "0,1,0", "rectangular: axis 2 lies in the plane of axis_1 and this direction"},
    {"origin", "m", "0,0,0", "cylindrical: a point on the axis"},
    {"axis", "-", "0,0,1", "cylindrical: direction of the axis"},
    {"rotation", "rad", "0,0,0",
     "rotation vector in these axes that turns them into the material's (a winding angle)"}};

const char* const kConstants[] = {"E1", "E2", "E3", "nu12", "nu13", "nu23", "G12", "G13", "G23"};

bool given(const Options& options, const std::string& prefix, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(),
                     [&](const char* name) { return options.given(prefix + name); });
}

model::Orthotropic orthotropic(const Options& options, const std::string& prefix) {
  double c[std::size(kConstants)];
  std::transform(std::begin(kConstants), std::end(kConstants), c,
                 [&](const char* name) { return options.number(prefix + name); });
  model::Orthotropic m{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}, {}};
  const int system = options.choice(prefix + "orientation", {"rectangular", "cylindrical"});
  m.orientation = {static_cast<model::Orientation::System>(system),
                   options.vector(prefix + "axis_1"),
                   options.vector(prefix + "axis_2"),
                   options.vector(prefix + "origin"),
                   options.vector(prefix + "axis"),
                   options.vector(prefix + "rotation")};
  return m;
}

model::Material material(const Options& options, const std::string& prefix) {
  if (!given(options, prefix, {"E1", "E2", "E3"}))
    return {options.positive(prefix + "E"), options.number(prefix + "nu"), options.positive(prefix + "rho")};
  return {0, 0, options.positive(prefix + "rho"), orthotropic(options, prefix)};
}

// All numbers of a material; visit(x) sees them in the same order for writing and reading.
template <class Visit>
void visit_numbers(model::Material& material, const Visit& visit) {
  for (double* x : {&material.E, &material.nu, &material.rho}) visit(*x);
  if (!material.orthotropic) return;
  model::Orthotropic& m = *material.orthotropic;
  model::Orientation& o = m.orientation;
  for (Eigen::Vector3d* v : {&m.E, &m.nu, &m.G, &o.axis_1, &o.axis_2, &o.origin, &o.axis, &o.rotation})
    for (double& x : *v) visit(x);
}

// MPI's own errors end the program.
void broadcast(MPI_Comm comm, int& value) { MPI_Bcast(&value, 1, MPI_INT, 0, comm); }

void broadcast(MPI_Comm comm, model::MaterialRegion& region) {
  auto& [name, material] = region;
  int length = static_cast<int>(name.size()), orthotropic = material.orthotropic.has_value();
  broadcast(comm, length);
  name.resize(static_cast<std::size_t>(length));
  MPI_Bcast(name.data(), length, MPI_CHAR, 0, comm);
  broadcast(comm, orthotropic);
  if (orthotropic && !material.orthotropic) material.orthotropic.emplace();
  visit_numbers(material, [comm](double& x) { MPI_Bcast(&x, 1, MPI_DOUBLE, 0, comm); });
  if (!orthotropic) return;
  auto& system = material.orthotropic->orientation.system;
  int number = static_cast<int>(system);
  broadcast(comm, number);
  system = static_cast<model::Orientation::System>(number);
}

}  // namespace

OptionTable material_table() {
  OptionTable table;
  for (const auto& [prefix, of] : {std::pair{"material_", ""}, {"material_<set>_", " (one cell set)"}})
    for (OptionSpec spec : kMaterial) {
      spec.name = prefix + spec.name;
      spec.help += of;
      table.push_back(spec);
    }
  return table;
}

std::vector<model::MaterialRegion> material_options(const Options& options) {
  std::set<std::string> sets;
  for (const char* constant : {"E", "E1", "rho"})
    for (const std::string& set : options.placeholder_values("material_<set>_" + std::string(constant)))
      sets.insert(set);
  std::vector<model::MaterialRegion> regions;
  for (const std::string& set : sets) regions.push_back({set, material(options, "material_" + set + "_")});
  if (given(options, "material_", {"E", "E1", "rho"}))
    regions.push_back({"", material(options, "material_")});
  return regions;
}

void broadcast(MPI_Comm comm, std::vector<model::MaterialRegion>& regions) {
  int n = static_cast<int>(regions.size());
  broadcast(comm, n);
  regions.resize(static_cast<std::size_t>(n));
  for (model::MaterialRegion& region : regions) broadcast(comm, region);
}

}  // namespace elastogear::app
