#include "elastogear/mesh/file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "mesh/inp/inp_format.h"
#include "mesh/inp/lines/inp.h"
#include "mesh/msh/msh.h"
#include "mesh/msh/msh_format.h"

namespace elastogear::mesh {
namespace {

std::string extension_of(const std::string& path) {
  std::string text = std::filesystem::path(path).extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string mesh_extension(const std::string& path) {
  const std::string text = extension_of(path);
  require(text == ".msh" || text == ".inp", path, ": unknown mesh format '", text,
          "', allowed are .msh (Gmsh 4.1) and .inp (Abaqus/CalculiX)", way_from_bulk_data(path));
  return text;
}

// Names of sets become names in the body file.
template <class Sets>
void require_names(const std::string& path, const Sets& sets) {
  for (const auto& [name, members] : sets)
    require(!name.empty() && name != "." && name.find('/') == name.npos, path, ": a set has the name '", name,
            "'; names must not be empty, '.' or hold a slash: rename it in the mesh");
}

}  // namespace

// Gmsh takes bulk data by its extension, which .dat is not.
std::string way_from_bulk_data(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension != ".bdf" && extension != ".nas" && extension != ".dat") return "";
  const auto with = [&](const char* other) {
    return std::filesystem::path(path).replace_extension(other).string();
  };
  const std::string rename = extension == ".dat" ? "cp " + path + " " + with(".bdf") + " && " : "",
                    deck = extension == ".dat" ? with(".bdf") : path;
  return "; bulk data of Nastran becomes one, with its properties and shells as sets, without materials, "
         "restraints and local coordinate systems, by \"" +
         rename + "gmsh " + deck + " -save -o " + with(".inp") + "\"";
}

Mesh read_mesh(const std::string& path, double unit_in_m, ReadReport* report, const std::string& instance) {
  require(std::isfinite(unit_in_m) && unit_in_m > 0, path, ": unit of length is ", unit_in_m,
          " m, must be positive");
  const bool msh = mesh_extension(path) == ".msh";
  require(!msh || instance.empty(), path, ": a .msh has no instances; give no instance");
  Mesh mesh = msh ? read_msh(path, unit_in_m, report) : read_inp(path, unit_in_m, report, instance);
  require_names(path, mesh.node_sets);
  require_names(path, mesh.cell_sets);
  require_names(path, mesh.face_sets);
  return mesh;
}

void write_mesh(const std::string& path, const Mesh& mesh) {
  if (mesh_extension(path) == ".msh") return write_msh(path, mesh);
  write_inp(path, mesh);
}

bool is_written_mesh(const std::string& path) {
  constexpr std::streamsize kHead = 200;  // bytes, that hold what both formats begin with
  std::string head(kHead, '\0');
  open_input(path).read(head.data(), kHead);
  return head.starts_with(inp_format::kFirstLine) ||
         (head.starts_with("$MeshFormat") && head.find(msh_format::kSignature) != head.npos);
}

}  // namespace elastogear::mesh
