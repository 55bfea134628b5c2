#include "reduction/job/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "elastogear/base/error.h"
#include "elastogear/fem/element.h"

namespace elastogear::reduction {
namespace {

using mesh::Face;

struct BoundaryFace {
  Face face;  // turned outward
  int cell = 0;
  const std::string* group = nullptr;
  std::size_t group_size = 0;
};

using Boundary = std::map<Face, BoundaryFace>;  // by face_key

Boundary find_boundary(const mesh::Mesh& mesh) {
  std::vector<int> cell;
  const std::vector<Face> faces = mesh::boundary_faces(mesh, &cell);
  Boundary boundary;
  for (std::size_t i = 0; i < faces.size(); ++i) boundary[mesh::face_key(faces[i])] = {faces[i], cell[i]};
  return boundary;
}

// std::map visits sets alphabetically, so that `<` keeps the first of equal ones.
void assign_groups(const mesh::Mesh& mesh, Boundary& boundary) {
  for (const auto& [name, faces] : mesh.face_sets)
    for (const Face& face : faces) {
      const auto found = boundary.find(mesh::face_key(face));
      if (found == boundary.end()) continue;
      BoundaryFace& f = found->second;
      if (f.group && f.group_size <= faces.size()) continue;
      f.group = &name;
      f.group_size = faces.size();
    }
}

std::vector<BoundaryFace> select_faces(const mesh::Mesh& mesh, const std::vector<std::string>& face_sets) {
  Boundary boundary = find_boundary(mesh);
  assign_groups(mesh, boundary);
  std::vector<BoundaryFace> selected;
  for (const std::string& name : face_sets)
    for (const Face& face : mesh::face_set(mesh, name)) {
      const auto found = boundary.find(mesh::face_key(face));
      if (found == boundary.end())
        fail("face set '", name, "' holds the face of ", mesh::face_text(mesh, face),
             ", which is inside the body");
      selected.push_back(found->second);
    }
  return selected;
}

Eigen::Vector3d vector_area(const mesh::Mesh& mesh, const Face& f) {
  const Eigen::Vector3d d_1 = mesh.X.col(f[2]) - mesh.X.col(f[0]), d_2 = mesh.X.col(f[3]) - mesh.X.col(f[1]);
  return d_1.cross(d_2) / 2;
}

// Area of the whole side of the cell that the face is a part of.
double side_area(const mesh::Mesh& mesh, int cell, const Face& face) {
  double sum = 0;
  for (const auto& side : mesh::cell_sides(mesh.cells.type[cell], mesh.cells[cell])) {
    if (std::find(side.begin(), side.end(), face) == side.end()) continue;
    for (const Face& part : side) sum += vector_area(mesh, part).norm();
  }
  return sum;
}

double cell_volume(const mesh::Mesh& mesh, int cell) {
  return fem::element_functions(mesh.cells.type[cell]).volume(fem::cell_coordinates(mesh, cell));
}

void number_nodes(const mesh::Mesh& mesh, const std::vector<BoundaryFace>& faces, model::Surface& surface) {
  std::set<int> nodes;
  for (const auto& f : faces) nodes.insert(f.face.begin(), f.face.end());
  surface.node.assign(nodes.begin(), nodes.end());
  surface.X = mesh.X(Eigen::all, surface.node);
  surface.face.resize(4, static_cast<Eigen::Index>(faces.size()));
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (int k = 0; k < 4; ++k) {
      const auto at = std::lower_bound(surface.node.begin(), surface.node.end(), faces[i].face[k]);
      surface.face(k, static_cast<Eigen::Index>(i)) = static_cast<int>(at - surface.node.begin());
    }
}

// Nodes of the second-order side that a face is a part of; none of a linear cell.
std::vector<int> second_order_side(const mesh::Mesh& mesh, const BoundaryFace& f) {
  const auto type = mesh.cells.type[f.cell];
  if (mesh::node_count(type) == mesh::corner_count(type)) return {};
  const auto sides = mesh::cell_sides(type, mesh.cells[f.cell]);
  for (std::size_t s = 0; s < sides.size(); ++s)
    if (std::find(sides[s].begin(), sides[s].end(), f.face) != sides[s].end())
      return mesh::cell_side_nodes(type, mesh.cells[f.cell])[s];
  return {};
}

// Only where a cell is of second order, and of sides all nodes of which are on the surface.
void set_sides(const mesh::Mesh& mesh, const std::vector<BoundaryFace>& faces, model::Surface& surface) {
  Eigen::Matrix<int, 8, Eigen::Dynamic> all(8, static_cast<Eigen::Index>(faces.size()));
  all.setConstant(-1);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const std::vector<int> nodes = second_order_side(mesh, faces[i]);
    Eigen::Matrix<int, 8, 1> side = Eigen::Matrix<int, 8, 1>::Constant(-1);
    bool on_surface = true;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const auto at = std::lower_bound(surface.node.begin(), surface.node.end(), nodes[k]);
      on_surface = on_surface && at != surface.node.end() && *at == nodes[k];
      side[static_cast<Eigen::Index>(k)] = static_cast<int>(at - surface.node.begin());
    }
    if (on_surface) all.col(static_cast<Eigen::Index>(i)) = side;
  }
  if ((all.array() >= 0).any()) surface.side = all;
}

void number_groups(const std::vector<BoundaryFace>& faces, model::Surface& surface) {
  std::set<std::string> names;
  for (const auto& f : faces) names.insert(*f.group);
  surface.group_name.assign(names.begin(), names.end());
  for (const auto& f : faces) {
    const auto at = std::lower_bound(surface.group_name.begin(), surface.group_name.end(), *f.group);
    surface.group.push_back(static_cast<int>(at - surface.group_name.begin()));
  }
}

// A face that two of the selected sets share counts once.
void drop_repeated(std::vector<BoundaryFace>& faces) {
  std::set<Face> seen;
  std::erase_if(faces, [&](const BoundaryFace& f) { return !seen.insert(f.face).second; });
}

}  // namespace

model::Surface make_surface(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions,
                            const std::vector<std::string>& face_sets) {
  const std::vector<int> region = fem::cell_regions(mesh, regions);
  std::vector<BoundaryFace> faces = select_faces(mesh, face_sets);
  drop_repeated(faces);
  model::Surface surface;
  number_nodes(mesh, faces, surface);
  set_sides(mesh, faces, surface);
  number_groups(faces, surface);
  surface.c_f.resize(static_cast<Eigen::Index>(faces.size()));
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Face& face = faces[i].face;
    const Eigen::Vector3d middle = (mesh.X.col(face[0]) + mesh.X.col(face[1]) + mesh.X.col(face[2])) / 3;
    const double E =
        fem::youngs_modulus(regions[region[faces[i].cell]].material, vector_area(mesh, face), middle);
    surface.c_f(static_cast<Eigen::Index>(i)) =
        E * side_area(mesh, faces[i].cell, faces[i].face) / cell_volume(mesh, faces[i].cell);
  }
  return surface;
}

}  // namespace elastogear::reduction
