#include "elastogear/io/polydata_file.h"

#include <sstream>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"

namespace elastogear::io {
namespace {

void write_points(std::ostream& out, const std::vector<Eigen::Vector3d>& points) {
  out << "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n";
  for (const Eigen::Vector3d& p : points) out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  out << "</DataArray></Points>\n";
}

void write_polygons(std::ostream& out, const std::vector<std::vector<int>>& polygons) {
  out << "<Polys><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n";
  for (const auto& polygon : polygons) {
    for (int vertex : polygon) out << vertex << ' ';
    out << '\n';
  }
  out << "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
  std::size_t end = 0;
  for (const auto& polygon : polygons) out << (end += polygon.size()) << '\n';
  out << "</DataArray></Polys>\n";
}

void write_cell_data(std::ostream& out, const std::map<std::string, std::vector<int>>& cell_data) {
  out << "<CellData>\n";
  for (const auto& [name, values] : cell_data) {
    out << "<DataArray type=\"Int32\" Name=\"" << name << "\" format=\"ascii\">\n";
    for (int value : values) out << value << '\n';
    out << "</DataArray>\n";
  }
  out << "</CellData>\n";
}

}  // namespace

void write_polydata(const std::string& path, const std::vector<Eigen::Vector3d>& points,
                    const std::vector<std::vector<int>>& polygons,
                    const std::map<std::string, std::vector<int>>& cell_data) {
  for (const auto& [name, values] : cell_data)
    require(values.size() == polygons.size(), path, ": data '", name, "' has ", values.size(), " values for ",
            polygons.size(), " polygons");
  std::ostringstream out;
  out.precision(9);
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      << "<PolyData><Piece NumberOfPoints=\"" << points.size() << "\" NumberOfPolys=\"" << polygons.size()
      << "\">\n";
  write_points(out, points);
  write_polygons(out, polygons);
  write_cell_data(out, cell_data);
  out << "</Piece></PolyData></VTKFile>\n";
  write_file(path, out.str());
}

}  // namespace elastogear::io
