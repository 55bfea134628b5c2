#include <cctype>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"
#include "elastogear/mesh/inp.h"
#include "face_owner.h"
#include "inp_format.h"
#include "inp_lines.h"

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

void write_elements(std::string& out, const Mesh& mesh, const std::string& element) {
  out += "*ELEMENT, TYPE=" + element + "\n";
  for (int i = 0; i < mesh.cells.size(); ++i) {
    print(out, i + 1);
    for (int node : mesh.cells[i]) {
      out += ", ";
      print(out, node + 1);
    }
    out += '\n';
  }
}

void write_surfaces(std::string& out, const Mesh& mesh) {
  const FaceOwners owners(mesh);
  for (const auto& [name, faces] : mesh.face_sets) {
    out += "*SURFACE, NAME=" + name + ", TYPE=ELEMENT\n";
    for (const Face& face : faces) {
      const FaceOwner owner = owners.find(face).value();
      print(out, owner.cell + 1);
      out += ", S";
      print(out, owner.side + 1);
      out += '\n';
    }
  }
}

}  // namespace

void write_inp(const std::string& path, const Mesh& mesh, const std::string& element) {
  validate(mesh, path);
  require(element.starts_with("C3D8"), path, ": element type '", element, "', allowed are C3D8*");
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
