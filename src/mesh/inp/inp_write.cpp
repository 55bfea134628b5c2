#include <cctype>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"
#include "mesh/inp/inp_format.h"
#include "mesh/inp/lines/inp.h"
#include "mesh/inp/lines/inp_lines.h"
#include "mesh/raw/face_owner.h"

namespace elastogear::mesh {
namespace {

constexpr int kNumbersPerLine = 16;  // the format's limit

template <class Set>
void check_names(const std::string& path, const std::map<std::string, Set>& sets) {
  std::map<std::string, std::string> seen;
  for (const auto& [name, members] : sets) {
    const bool first = !name.empty() && (std::isalpha(static_cast<unsigned char>(name[0])) || name[0] == '_');
    require(first && name.find_first_of(" \t\r\n,=\"*") == std::string::npos, path, ": set name '", name,
            "' cannot be written: .inp wants a letter first and no blank, comma, '=', '*' or quote");
    const auto [twin, fresh] = seen.emplace(upper(name), name);
    require(fresh, path, ": sets '", twin->second, "' and '", name,
            "' cannot both be written: .inp does not tell case apart");
  }
}

void write_numbers(std::string& out, const std::vector<int>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    print(out, numbers[i] + 1);
    out += (i + 1) % kNumbersPerLine == 0 || i + 1 == numbers.size() ? "\n" : ", ";
  }
}

void write_nodes(std::string& out, const Mesh& mesh) {
  out += "*NODE\n";
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    print(out, i + 1);
    for (double x : mesh.X.col(i)) {
      out += ", ";
      print(out, x);
    }
    out += '\n';
  }
}

// One block per run of cells of one type.
void write_elements(std::string& out, const Mesh& mesh, const std::string& hex8) {
  const auto& type = mesh.cells.type;
  for (int i = 0; i < mesh.cells.size(); ++i) {
    if (i == 0 || type[i] != type[i - 1]) {
      out += "*ELEMENT, TYPE=";
      out += type[i] == CellType::hex8 ? hex8 : inp_format::kElementTypes[static_cast<int>(type[i])];
      out += '\n';
    }
    print(out, i + 1);
    for (int k = 0; int node : mesh.cells[i]) {
      out += ++k % kNumbersPerLine == 0 ? ",\n" : ", ";
      print(out, node + 1);
    }
    out += '\n';
  }
}

// Sides in the order of their first faces. A side of a second-order cell is written whole or not at all.
void write_surface(std::string& out, const Mesh& mesh, const FaceOwners& owners, const std::string& name) {
  std::map<std::pair<int, int>, std::size_t> parts;  // faces by cell and side
  std::vector<std::pair<int, int>> sides;
  for (const Face& face : mesh.face_sets.at(name)) {
    const FaceOwner owner = owners.find(face).value();
    if (parts[{owner.cell, owner.side}]++ == 0) sides.emplace_back(owner.cell, owner.side);
  }
  for (const auto& [cell, side] : sides) {
    const std::size_t whole = cell_sides(mesh.cells.type[cell], mesh.cells[cell])[side].size();
    require(parts[{cell, side}] == whole, "face set '", name, "' holds ", parts[{cell, side}], " of the ",
            whole, " parts of side S", side + 1, " of cell ", cell, ": .inp stores whole sides only");
    print(out, cell + 1);
    out += ", S";
    print(out, side + 1);
    out += '\n';
  }
}

void write_surfaces(std::string& out, const Mesh& mesh) {
  const FaceOwners owners(mesh);
  for (const auto& [name, faces] : mesh.face_sets) {
    out += "*SURFACE, NAME=" + name + ", TYPE=ELEMENT\n";
    write_surface(out, mesh, owners, name);
  }
}

}  // namespace

void write_inp(const std::string& path, const Mesh& mesh, const std::string& element) {
  validate(mesh, path);
  require(inp_format::cell_type(element) == CellType::hex8, path, ": element type '", element,
          "', allowed are C3D8*");
  check_names(path, mesh.node_sets);
  check_names(path, mesh.cell_sets);
  check_names(path, mesh.face_sets);
  std::string out(inp_format::kFirstLine);
  write_nodes(out, mesh);
  write_elements(out, mesh, element);
  for (const auto& [name, nodes] : mesh.node_sets) {
    out += "*NSET, NSET=" + name + "\n";
    write_numbers(out, nodes);
  }
  for (const auto& [name, cells] : mesh.cell_sets) {
    out += "*ELSET, ELSET=" + name + "\n";
    write_numbers(out, cells);
  }
  write_surfaces(out, mesh);
  out += inp_format::kLastLine;
  write_file(path, out);
}

}  // namespace elastogear::mesh
