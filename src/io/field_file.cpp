#include "elastogear/io/field_file.h"

#include <cstdint>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"

namespace elastogear::io {
namespace {

constexpr std::uint8_t kVtkHexahedron = 12;  // the node order is ours
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

void add_cells(Grid& grid, const mesh::Cells& cells) {
  const std::vector<std::uint8_t> type(cells.type.size(), kVtkHexahedron);
  grid.array("type=\"Int32\" Name=\"connectivity\"", cells.nodes.data(), cells.nodes.size());
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

void write_pvd(const std::string& path, const std::vector<TimeStep>& steps) {
  std::ostringstream out;
  out.precision(17);
  out << "<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
  for (const TimeStep& step : steps)
    out << "<DataSet timestep=\"" << step.time << "\" file=\"" << escaped(step.file) << "\"/>\n";
  out << "</Collection>\n</VTKFile>\n";
  write_file(path, out.str());
}

}  // namespace elastogear::io
