#include "python/meshes.h"

#include <pybind11/stl.h>

#include <memory>
#include <utility>

#include "app/gear/design_options.h"
#include "app/gear/drive_options.h"
#include "app/verbs/registry.h"
#include "elastogear/base/error.h"
#include "elastogear/mesh/file.h"
#include "elastogear/mesh/quality.h"
#include "python/arrays.h"
#include "python/runtime.h"
#include "python/verbs.h"

namespace elastogear::python {
namespace {

using mesh::Mesh, mesh::CellType;
using SharedMesh = std::shared_ptr<Mesh>;

CellType cell_type(const std::string& name) {
  std::string known;
  for (int i = 0; i < mesh::kCellTypes; ++i) {
    const auto type = static_cast<CellType>(i);
    if (name == mesh::name(type)) return type;
    known += std::string(known.empty() ? "" : ", ") + mesh::name(type);
  }
  fail("cells: unknown type '", name, "'; the types are ", known);
}

// Whole numbers from an argument of `dimensions` dimensions.
py::array_t<int> whole_numbers(const py::object& argument, int dimensions, const std::string& what) {
  const py::array_t<double> numbers = numbers_of(argument, dimensions, what);
  py::array_t<int> whole(std::vector<py::ssize_t>(numbers.shape(), numbers.shape() + dimensions));
  for (py::ssize_t i = 0; i < numbers.size(); ++i) {
    const double x = numbers.data()[i];
    require(x == std::floor(x) && std::abs(x) < 2e9, what, ": ", x, " is no number of a node or cell");
    whole.mutable_data()[i] = static_cast<int>(x);
  }
  return whole;
}

std::vector<int> list_of_numbers(const py::object& argument, const std::string& what) {
  const py::array_t<int> numbers = whole_numbers(argument, 1, what);
  std::vector<int> all(numbers.data(), numbers.data() + numbers.size());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void add_cells(Mesh& mesh, const std::string& name, const py::object& argument) {
  const CellType type = cell_type(name);
  const std::string what = "cells of type " + name;
  const py::array_t<int> nodes = whole_numbers(argument, 2, what);
  const int per_cell = mesh::node_count(type);
  require(nodes.shape(1) == per_cell, what, ": must have the shape (n, ", per_cell, "), not (n, ",
          nodes.shape(1), ")");
  for (py::ssize_t i = 0; i < nodes.shape(0); ++i)
    mesh.cells.add(type, {nodes.data(i, 0), static_cast<std::size_t>(per_cell)});
}

std::vector<mesh::Face> faces_of(const py::object& argument, const std::string& what) {
  const py::array_t<int> nodes = whole_numbers(argument, 2, what);
  require(nodes.shape(1) == 3 || nodes.shape(1) == 4, what,
          ": must have the shape (n, 3) or (n, 4), not (n, ", nodes.shape(1), ")");
  std::vector<mesh::Face> faces;
  for (py::ssize_t i = 0; i < nodes.shape(0); ++i) {
    const int* n = nodes.data(i, 0);
    faces.push_back({n[0], n[1], n[2], nodes.shape(1) == 4 ? n[3] : n[2]});
  }
  return faces;
}

using Sets = std::map<std::string, py::object>;

SharedMesh make_mesh(const py::object& points, const Sets& cells, const Sets& node_sets,
                     const Sets& face_sets, const Sets& cell_sets) {
  const py::array_t<double> X = numbers_of(points, 2, "points");
  require(X.shape(1) == 3, "points: must have the shape (n, 3), not (n, ", X.shape(1), ")");
  auto made = std::make_shared<Mesh>();
  made->X = Eigen::Map<const Eigen::Matrix3Xd>(X.data(), 3, X.shape(0));
  for (const auto& [name, nodes] : cells) add_cells(*made, name, nodes);
  for (const auto& [name, nodes] : node_sets)
    made->node_sets[name] = list_of_numbers(nodes, "node set '" + name + "'");
  for (const auto& [name, faces] : face_sets)
    made->face_sets[name] = faces_of(faces, "face set '" + name + "'");
  for (const auto& [name, numbers] : cell_sets)
    made->cell_sets[name] = list_of_numbers(numbers, "cell set '" + name + "'");
  mesh::validate(*made, "mesh");
  return made;
}

py::array int_view(const std::vector<int>& numbers, const py::object& owner) {
  return view(numbers.data(), {static_cast<py::ssize_t>(numbers.size())}, owner);
}

// Nodes of all cells of a type, (n, nodes of a cell).
py::dict cells(const Mesh& mesh) {
  py::dict all;
  for (int i = 0; i < mesh::kCellTypes; ++i) {
    const auto type = static_cast<CellType>(i);
    std::vector<int> nodes;
    for (int cell = 0; cell < mesh.cells.size(); ++cell)
      if (mesh.cells.type[cell] == type)
        nodes.insert(nodes.end(), mesh.cells[cell].begin(), mesh.cells[cell].end());
    if (nodes.empty()) continue;
    const py::ssize_t per_cell = mesh::node_count(type);
    const Shape shape{static_cast<py::ssize_t>(nodes.size()) / per_cell, per_cell};
    all[mesh::name(type)] = owning_view(std::move(nodes), shape);
  }
  return all;
}

py::dict sets(const py::object& self, const std::map<std::string, std::vector<int>>& of) {
  py::dict all;
  for (const auto& [name, numbers] : of) all[py::str(name)] = int_view(numbers, self);
  return all;
}

py::dict face_sets(const py::object& self) {
  py::dict all;
  for (const auto& [name, faces] : self.cast<const Mesh&>().face_sets) {
    const int* first = faces.empty() ? nullptr : faces.front().data();
    all[py::str(name)] = view(first, {static_cast<py::ssize_t>(faces.size()), 4}, self);
  }
  return all;
}

std::map<std::string, SharedMesh> drive_meshes(const Given& given) {
  const std::vector<app::Verb> verbs = app::all_verbs();
  const OptionDatabase database;
  Work work(Ranks::this_one, &database);
  return work.without_gil([&] {
    const app::Options options =
        app::with_gears(app::load_options(app::find_verb(verbs, "mesh"), verbs, sources(given)));
    require(app::is_drive(options), "option -drive is missing: these are not the keys of a drive");
    options.reject_unknown();
    std::map<std::string, SharedMesh> meshes;
    const app::MeshDensity density = app::mesh_density(options);
    for (const app::DriveMember& member : app::read_drive(options).members) {
      mesh::ReadReport report;
      meshes[member.name] = std::make_shared<Mesh>(member.mesh(density, report));
    }
    return meshes;
  });
}

py::dict quality(const Mesh& mesh) {
  const mesh::Quality q = mesh::quality(mesh);
  py::dict all;
  all["min_scaled_jacobian"] = q.min_scaled_jacobian;
  all["mean_scaled_jacobian"] = q.mean_scaled_jacobian;
  all["worst_cell"] = q.worst_cell;
  all["min_jacobian"] = q.min_jacobian;
  return all;
}

SharedMesh read(const std::string& path, double unit_in_m) {
  const Work work;
  return std::make_shared<Mesh>(mesh::read_mesh(path, unit_in_m));
}

void write(const Mesh& mesh, const std::string& path) {
  const Work work;
  mesh::write_mesh(path, mesh);
}

}  // namespace

void bind_meshes(py::module_& module) {
  py::class_<Mesh, SharedMesh>(module, "Mesh",
                               "A volume mesh with named sets. Lengths are in m; numbers of nodes and cells "
                               "begin at 0. Arrays are views that cannot be written to.")
      .def(py::init(&make_mesh), py::arg("points"), py::arg("cells"), py::arg("node_sets") = Sets{},
           py::arg("face_sets") = Sets{}, py::arg("cell_sets") = Sets{},
           "points: (n, 3), m. cells: nodes by the type of cell, {'hex8': (n, 8)}, in the order of Abaqus. "
           "face_sets: (n, 4) or (n, 3) nodes each. Error for what is no mesh.")
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            const Eigen::Matrix3Xd& X = self.cast<const Mesh&>().X;
            return view(X.data(), {X.cols(), 3}, self);
          },
          "(n, 3), m")
      .def_property_readonly("cells", cells, "nodes of the cells by their type, (n, nodes of a cell) each")
      .def_property_readonly(
          "node_sets", [](const py::object& self) { return sets(self, self.cast<const Mesh&>().node_sets); },
          "numbers of nodes, (n,) each")
      .def_property_readonly(
          "cell_sets", [](const py::object& self) { return sets(self, self.cast<const Mesh&>().cell_sets); },
          "numbers of cells, (n,) each")
      .def_property_readonly("face_sets", face_sets,
                             "nodes of faces, (n, 4) each; a triangle repeats its last node")
      .def("quality", quality, "Smallest and mean scaled Jacobian (-), worst cell, smallest Jacobian (m^3).")
      .def("write", write, py::arg("path"), "Writes a .msh or .inp file, coordinates in m.");
  module.def("read_mesh", read, py::arg("path"), py::arg("unit_in_m") = 1.0,
             "Reads a .msh or .inp file. unit_in_m: length of its unit of length, 0.001 for mm.");
  module.def("drive_meshes", drive_meshes, py::arg("given"),
             "The meshes of a drive, by the names of its gears.");
}

}  // namespace elastogear::python
