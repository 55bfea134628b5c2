#include "app/tables/material_options.h"

#include <algorithm>
#include <set>

#include "app/options/rows.h"

namespace elastogear::app {
namespace {

using model::Material, model::Orientation, model::Orthotropic;

// One number of a vector.
auto component(Eigen::Vector3d Orthotropic::*vector, int i) {
  return [=](Orthotropic& m) -> double& { return (m.*vector)[i]; };
}

auto axes(Eigen::Vector3d Orientation::*vector) { return in(&Orthotropic::orientation, vector); }

const Rows<Material> kIsotropic = {
    {"<material>_E", &Material::E, "Pa", "Young's modulus", kPositive | kRequired},
    {"<material>_nu", &Material::nu, "-", "Poisson's ratio", kRequired},
    {"<material>_rho", &Material::rho, "kg/m^3", "density", kPositive | kRequired},
};

const Rows<Orthotropic> kOrthotropic = {
    {"<material>_E1", component(&Orthotropic::E, 0), "Pa",
     "orthotropic: Young's modulus along the material's axis 1", kRequired},
    {"<material>_E2", component(&Orthotropic::E, 1), "Pa", "along axis 2", kRequired},
    {"<material>_E3", component(&Orthotropic::E, 2), "Pa", "along axis 3", kRequired},
    {"<material>_nu12", component(&Orthotropic::nu, 0), "-",
     "strain along -2 per strain along 1 when pulled along 1", kRequired},
    {"<material>_nu13", component(&Orthotropic::nu, 1), "-", "strain along -3 when pulled along 1",
     kRequired},
    {"<material>_nu23", component(&Orthotropic::nu, 2), "-", "strain along -3 when pulled along 2",
     kRequired},
    {"<material>_G12", component(&Orthotropic::G, 0), "Pa", "shear modulus of the plane 1 2", kRequired},
    {"<material>_G13", component(&Orthotropic::G, 1), "Pa", "shear modulus of the plane 1 3", kRequired},
    {"<material>_G23", component(&Orthotropic::G, 2), "Pa", "shear modulus of the plane 2 3", kRequired},
    {"<material>_orientation", in(&Orthotropic::orientation, &Orientation::system),
     one_of("rectangular", "cylindrical"),
     "rectangular: axis 1 along axis_1, axis 2 in the plane of axis_1 and axis_2; cylindrical: radial, "
     "tangential, axial"},
    {"<material>_axis_1", axes(&Orientation::axis_1), "-", "rectangular: direction of axis 1"},
    {"<material>_axis_2", axes(&Orientation::axis_2), "-",
     "rectangular: axis 2 lies in the plane of axis_1 and this direction"},
    {"<material>_origin", axes(&Orientation::origin), "m", "cylindrical: a point on the axis"},
    {"<material>_axis", axes(&Orientation::axis), "-", "cylindrical: direction of the axis"},
    {"<material>_rotation", axes(&Orientation::rotation), "rad",
     "rotation vector in these axes that turns them into the material's (a winding angle)"},
};

bool given(const Options& options, const std::string& prefix, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(),
                     [&](const char* name) { return options.given(prefix + name); });
}

// name: "material" or "material_<set>".
Material material(const Options& options, const std::string& name) {
  Material material;
  if (!given(options, name + "_", {"E1", "E2", "E3"})) {
    read_rows(options, kIsotropic, material, name);
  } else {
    material.rho = options.positive(name + "_rho");
    read_rows(options, kOrthotropic, material.orthotropic.emplace(), name);
  }
  return material;
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
  for (const auto& [name, of] : {std::pair{"material", ""}, {"material_<set>", " (one cell set)"}})
    for (OptionSpec spec : table_of(kIsotropic, kOrthotropic)) {
      spec.name = with_word(spec.name, name);
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
  for (const std::string& set : sets) regions.push_back({set, material(options, "material_" + set)});
  if (given(options, "material_", {"E", "E1", "rho"})) regions.push_back({"", material(options, "material")});
  return regions;
}

void broadcast(MPI_Comm comm, std::vector<model::MaterialRegion>& regions) {
  int n = static_cast<int>(regions.size());
  broadcast(comm, n);
  regions.resize(static_cast<std::size_t>(n));
  for (model::MaterialRegion& region : regions) broadcast(comm, region);
}

}  // namespace elastogear::app
