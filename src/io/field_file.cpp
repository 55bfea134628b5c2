#include "elastogear/io/field_file.h"

#include <cstdint>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"

namespace elastogear::io {
namespace {

// VTK's cell types in the order of mesh::CellType.
constexpr std::uint8_t kVtkType[mesh::kCellTypes] = {12, 25, 10, 24, 13, 26, 14};
// VTK's node order is ours but for the wedges: their first triangle faces outward.
constexpr int kVtkWedge[] = {0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13};
constexpr const char* kTensor[] = {"XX", "YY", "ZZ", "XY", "YZ", "XZ"};

std::string escaped(const std::string& text) {
  std::string result;
  for (char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

// The XML part of the file and the bytes appended to it.
struct Grid {
  std::string xml, bytes;

  template <class T>
  void append(const T* data, std::size_t n) {
    const std::uint64_t size = n * sizeof(T);
    bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
    bytes.append(reinterpret_cast<const char*>(data), size);
  }
  template <class T>
  void array(const std::string& attributes, const T* data, std::size_t n) {
    xml += "<DataArray " + attributes + " format=\"appended\" offset=\"" + std::to_string(bytes.size()) +
           "\"/>\n";
    append(data, n);
  }
};

std::string component_names(Eigen::Index n) {
  std::string text = " NumberOfComponents=\"" + std::to_string(n) + "\"";
  for (int i = 0; n == std::ssize(kTensor) && i < n; ++i)
    text += " ComponentName" + std::to_string(i) + "=\"" + kTensor[i] + "\"";
  return text;
}

void add_field(Grid& grid, const NodeField& field) {
  grid.array("type=\"Float64\" Name=\"" + escaped(field.name) + "\"" + component_names(field.values.rows()),
             field.values.data(), static_cast<std::size_t>(field.values.size()));
}

bool is_wedge(mesh::CellType type) {
  return type == mesh::CellType::wedge6 || type == mesh::CellType::wedge15;
}

std::vector<int> vtk_nodes(const mesh::Cells& cells) {
  std::vector<int> nodes = cells.nodes;
  for (int i = 0; i < cells.size(); ++i)
    if (is_wedge(cells.type[i]))
      for (int k = 0; k < std::ssize(cells[i]); ++k) nodes[cells.offset[i] + k] = cells[i][kVtkWedge[k]];
  return nodes;
}

void add_cells(Grid& grid, const mesh::Cells& cells) {
  std::vector<std::uint8_t> type;
  for (mesh::CellType t : cells.type) type.push_back(kVtkType[static_cast<int>(t)]);
  grid.array("type=\"Int32\" Name=\"connectivity\"", vtk_nodes(cells).data(), cells.nodes.size());
  grid.array("type=\"Int32\" Name=\"offsets\"", cells.offset.data() + 1, cells.type.size());
  grid.array("type=\"UInt8\" Name=\"types\"", type.data(), type.size());
}

}  // namespace

void write_vtu(const std::string& path, const mesh::Mesh& mesh, const std::vector<NodeField>& fields) {
  for (const NodeField& field : fields) {
    require(field.values.cols() == mesh.n_nodes(), path, ": field '", field.name, "' has ",
            field.values.cols(), " values for ", mesh.n_nodes(), " nodes");
    require(field.values.allFinite(), path, ": field '", field.name, "' is not finite");
  }
  Grid grid;
  grid.xml =
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
      std::to_string(mesh.n_nodes()) + "\" NumberOfCells=\"" + std::to_string(mesh.cells.size()) +
      "\">\n<PointData>\n";
  for (const NodeField& field : fields) add_field(grid, field);
  grid.xml += "</PointData>\n<Points>\n";
  grid.array("type=\"Float64\" NumberOfComponents=\"3\"", mesh.X.data(),
             static_cast<std::size_t>(mesh.X.size()));
  grid.xml += "</Points>\n<Cells>\n";
  add_cells(grid, mesh.cells);
  grid.xml += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  write_file(path, grid.xml + grid.bytes + "\n</AppendedData>\n</VTKFile>\n");
}

void write_pvd(const std::string& path, const std::vector<SeriesFile>& files) {
  std::ostringstream out;
  out.precision(17);
  out << "<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
  for (const auto& [time, file, part, name] : files) {
    out << "<DataSet timestep=\"" << time << "\" part=\"" << part;
    if (!name.empty()) out << "\" name=\"" << escaped(name);
    out << "\" file=\"" << escaped(file) << "\"/>\n";
  }
  out << "</Collection>\n</VTKFile>\n";
  write_file(path, out.str());
}

}  // namespace elastogear::io
