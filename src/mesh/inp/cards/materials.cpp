#include "mesh/inp/cards/materials.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <utility>

namespace elastogear::mesh {
namespace {

using model::Material;
using model::Orientation;

constexpr std::size_t kOrthotropicConstants = 9;

void skip_table(InpLines& in, const Keyword& key, InpNotes& notes) {
  if (!in.next_data()) return;
  while (in.next_data()) continue;
  notes.lose(in, "*" + key.name, key.line, "of its table only the first row is used");
}

// Reads at least n numbers, from as many lines as they take; further ones in the line are temperature and the
// like.
std::vector<double> read_constants(InpLines& in, const Keyword& key, std::size_t n) {
  std::vector<double> values;
  while (values.size() < n && in.next_data()) {
    const std::vector<double> line = in.reals("a material constant");
    values.insert(values.end(), line.begin(), line.end());
  }
  if (values.size() < n) in.fail_at(key.line, "*", key.name, " needs ", n, " numbers, found ", values.size());
  return values;
}

Material& current_material(const InpLines& in, const Keyword& key, InpMaterials& materials) {
  if (materials.current.empty()) in.fail_at(key.line, "*", key.name, " outside a *MATERIAL");
  return materials.materials.at(materials.current);
}

// D1111 D1122 D2222 D1133 D2233 D3333 D1212 D1313 D2323 -> engineering constants.
model::Orthotropic from_stiffness(const InpLines& in, const std::vector<double>& D) {
  Eigen::Matrix3d C;
  C << D[0], D[1], D[3], D[1], D[2], D[4], D[3], D[4], D[5];
  if (C.llt().info() != Eigen::Success) in.fail_here("*ELASTIC, TYPE=ORTHO is not positive definite");
  const Eigen::Matrix3d S = C.inverse();
  model::Orthotropic constants;
  constants.E = S.diagonal().cwiseInverse();
  constants.nu << -S(0, 1) * constants.E(0), -S(0, 2) * constants.E(0), -S(1, 2) * constants.E(1);
  constants.G << D[6], D[7], D[8];
  return constants;
}

model::Orthotropic from_constants(const std::vector<double>& c) {
  return {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}};
}

void read_elastic(InpLines& in, const Keyword& key, InpMaterials& materials, InpNotes& notes) {
  Material& material = current_material(in, key, materials);
  std::string type = key.value("TYPE");
  std::erase(type, ' ');
  if (type.empty() || type == "ISO" || type == "ISOTROPIC") {
    const auto values = read_constants(in, key, 2);
    if (!(values[0] > 0)) in.fail_here("Young's modulus is ", values[0], ", must be positive");
    material.E = values[0];
    material.nu = values[1];
  } else if (type == "ENGINEERINGCONSTANTS") {
    material.orthotropic = from_constants(read_constants(in, key, kOrthotropicConstants));
  } else if (type == "ORTHO" || type == "ORTHOTROPIC") {
    material.orthotropic = from_stiffness(in, read_constants(in, key, kOrthotropicConstants));
  } else {
    while (in.next_data()) continue;
    notes.lose(in, "*ELASTIC, TYPE=" + type, key.line, "this elasticity is not read");
    return;
  }
  skip_table(in, key, notes);
}

void read_density(InpLines& in, const Keyword& key, InpMaterials& materials, InpNotes& notes) {
  Material& material = current_material(in, key, materials);
  material.rho = read_constants(in, key, 1)[0];
  if (!(material.rho > 0)) in.fail_here("the density is ", material.rho, ", must be positive");
  skip_table(in, key, notes);
}

void set_directions(const InpLines& in, const std::vector<double>& p, Orientation& orientation) {
  if (p.size() != 6 && p.size() != 9)
    in.fail_here("*ORIENTATION needs two or three points, found ", p.size(), " numbers");
  const Eigen::Vector3d a(p[0], p[1], p[2]), b(p[3], p[4], p[5]);
  const Eigen::Vector3d c = p.size() == 9 ? Eigen::Vector3d(p[6], p[7], p[8]) : Eigen::Vector3d::Zero();
  orientation.axis_1 = a - c;
  orientation.axis_2 = b - c;
  orientation.origin = a;
  orientation.axis = b - a;
  const bool cylindrical = orientation.system == Orientation::System::cylindrical;
  const double size =
      cylindrical ? orientation.axis.norm() : orientation.axis_1.cross(orientation.axis_2).norm();
  if (!(size > 0 && std::isfinite(size))) in.fail_here("the points of *ORIENTATION give no directions");
}

void read_orientation(InpLines& in, const Keyword& key, InpMaterials& materials) {
  const std::string system = key.value("SYSTEM"), definition = key.value("DEFINITION");
  if (!key.has("NAME")) in.fail_here("*ORIENTATION without NAME=name");
  const bool known = system.empty() || system == "RECTANGULAR" || system == "CYLINDRICAL";
  if (!known || (!definition.empty() && definition != "COORDINATES"))
    in.fail_here("*ORIENTATION with SYSTEM=", system, " DEFINITION=", definition,
                 ", read are RECTANGULAR and CYLINDRICAL by COORDINATES");
  Orientation orientation;
  if (system == "CYLINDRICAL") orientation.system = Orientation::System::cylindrical;
  if (!in.next_data()) in.fail_at(key.line, "*ORIENTATION without points");
  set_directions(in, in.reals("a coordinate of *ORIENTATION"), orientation);
  if (in.next_data()) {  // axis number and angle in degrees
    const auto turn = in.reals("a rotation of *ORIENTATION");
    const double axis = turn.empty() ? 0 : turn[0];
    if (axis != 1 && axis != 2 && axis != 3)
      in.fail_here("*ORIENTATION turns about axis ", axis, ", must be 1, 2 or 3");
    if (turn.size() > 1) orientation.rotation(static_cast<int>(axis) - 1) = turn[1] * M_PI / 180;
  }
  if (in.next_data()) in.fail_here("*ORIENTATION with more than two lines");
  materials.orientations[key.value("NAME")] = orientation;
}

void read_section(InpLines& in, const Keyword& key, InpMaterials& materials) {
  if (!key.has("ELSET") || !key.has("MATERIAL")) in.fail_here("*SOLID SECTION without ELSET= or MATERIAL=");
  materials.sections.push_back(
      {key.parameters.at("ELSET"), key.value("MATERIAL"), key.value("ORIENTATION"), key.line});
  while (in.next_data()) continue;  // a thickness, which solids have not
}

void start_material(InpLines& in, const Keyword& key, InpMaterials& materials) {
  materials.current = key.value("NAME");
  if (materials.current.empty()) in.fail_here("*MATERIAL without NAME=name");
  if (!materials.materials.try_emplace(materials.current).second)
    in.fail_here("material ", materials.current, " is defined twice");
}

template <class T>
const T& named(const InpLines& in, const std::map<std::string, T>& table, const std::string& name,
               const InpMaterials::Section& section, const char* kind) {
  const auto found = table.find(name);
  if (found == table.end())
    in.fail_at(section.line, "*SOLID SECTION of '", section.cell_set, "' names the unknown ", kind, " '",
               name, "'");
  return found->second;
}

// With N and s as the other units the file's stress is N/unit^2 and its density N s^2/unit^4.
void to_si(double unit_in_m, Material& material) {
  const double stress = 1 / (unit_in_m * unit_in_m);
  material.E *= stress;
  material.rho *= stress * stress;
  if (!material.orthotropic) return;
  material.orthotropic->E *= stress;
  material.orthotropic->G *= stress;
  material.orthotropic->orientation.origin *= unit_in_m;
}

}  // namespace

bool read_material_card(InpLines& in, const Keyword& key, InpMaterials& materials, InpNotes& notes) {
  if (key.name == "MATERIAL") {
    start_material(in, key, materials);
  } else if (key.name == "ELASTIC") {
    read_elastic(in, key, materials, notes);
  } else if (key.name == "DENSITY") {
    read_density(in, key, materials, notes);
  } else if (key.name == "ORIENTATION") {
    read_orientation(in, key, materials);
  } else if (key.name == "SOLID SECTION") {
    read_section(in, key, materials);
  } else {
    return false;
  }
  return true;
}

std::vector<model::MaterialRegion> material_regions(const InpLines& in, const InpMaterials& materials,
                                                    const InpSets& cell_sets, const Mesh& mesh,
                                                    double unit_in_m) {
  std::vector<model::MaterialRegion> regions;
  for (const auto& section : materials.sections) {
    const std::string* set = cell_sets.spelling(section.cell_set);
    if (!set)
      in.fail_at(section.line, "*SOLID SECTION names the unknown element set '", section.cell_set, "'");
    model::MaterialRegion region{*set, named(in, materials.materials, section.material, section, "material")};
    if (!section.orientation.empty()) {
      const auto& orientation =
          named(in, materials.orientations, section.orientation, section, "orientation");
      if (region.material.orthotropic) region.material.orthotropic->orientation = orientation;
    }
    to_si(unit_in_m, region.material);
    if (!mesh.cell_sets.at(*set).empty()) regions.push_back(std::move(region));
  }
  return regions;
}

}  // namespace elastogear::mesh
