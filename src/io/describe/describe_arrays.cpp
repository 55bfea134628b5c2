#include "io/describe/describe_arrays.h"

#include <fstream>
#include <set>
#include <vector>

#include "elastogear/base/error.h"
#include "elastogear/base/text.h"
#include "io/hdf5/hdf5.h"

namespace elastogear::io {
namespace {

// The value of an attribute of an XML tag; empty when it has none of this name.
std::string xml_attribute(const std::string& tag, const std::string& name) {
  const std::string key = " " + name + "=\"";
  const auto start = tag.find(key);
  if (start == tag.npos) return "";
  std::string value = tag.substr(start + key.size(), tag.find('"', start + key.size()) - start - key.size());
  for (const auto& [code, character] : {std::pair{"&lt;", "<"}, {"&quot;", "\""}, {"&amp;", "&"}})
    for (auto at = value.find(code); at != value.npos; at = value.find(code, at + 1))
      value.replace(at, std::string(code).size(), character);
  return value;
}

// The position of the > that ends the tag of XML which begins at `open`; one in an attribute's value does
// not.
std::size_t end_of_tag(const std::string& text, std::size_t open) {
  bool quoted = false;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (text[i] == '>' && !quoted) return i;
  }
  return text.size();
}

// Tags in their order, up to the appended bytes.
std::vector<std::string> tags_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> tags;
  for (std::string text; std::getline(file, text);)
    for (auto open = text.find('<'); open != text.npos; open = text.find('<', open + 1)) {
      tags.push_back(text.substr(open, end_of_tag(text, open) - open));
      if (tags.back().starts_with("<AppendedData")) return tags;
    }
  require(!tags.empty() && file.eof(), path, ": holds no VTK data");
  return tags;
}

void describe_pieces(Out& out, const std::vector<std::string>& tags) {
  std::string place;
  for (const std::string& tag : tags) {
    if (tag.starts_with("<Piece")) {
      const std::string cells = xml_attribute(tag, "NumberOfCells"),
                        polygons = xml_attribute(tag, "NumberOfPolys");
      line(out, "points: ", xml_attribute(tag, "NumberOfPoints"), ", ",
           cells.empty() ? "polygons: " : "cells: ", cells.empty() ? polygons : cells);
    } else if (tag.starts_with("<PointData")) {
      place = "points";
    } else if (tag.starts_with("<CellData")) {
      place = "cells";
    } else if (tag.starts_with("</")) {
      if (tag != "</DataArray") place.clear();
    } else if (tag.starts_with("<DataArray") && !place.empty()) {
      const std::string components = xml_attribute(tag, "NumberOfComponents");
      line(out, "array of ", place, ": ", xml_attribute(tag, "Name"),
           ", components: ", components.empty() ? "1" : components);
    }
  }
}

void describe_collection(Out& out, const std::vector<std::string>& tags) {
  std::set<std::string> times, bodies;
  std::size_t files = 0;
  for (const std::string& tag : tags) {
    if (!tag.starts_with("<DataSet")) continue;
    ++files;
    times.insert(xml_attribute(tag, "timestep"));
    bodies.insert(xml_attribute(tag, "name"));
  }
  line(out, counted(files, "file"), ": ", counted(times.size(), "time"), " of ", join(bodies));
  for (const std::string& tag : tags)
    if (tag.starts_with("<DataSet"))
      line(out, "  ", xml_attribute(tag, "timestep"), " s: ", xml_attribute(tag, "file"));
}

}  // namespace

void describe_datasets(Out& out, const std::string& path) {
  const h5::File file = h5::open(path);
  line(out, "arrays:");
  for (const std::string& name : h5::datasets(file)) {
    const h5::Shape shape = h5::shape(file, name);
    const std::string extents = join(shape, " x ", [](hsize_t n) { return std::to_string(n); });
    const std::string unit = h5::has_attribute(file, name, "unit") ? h5::unit(file, name) : "text";
    line(out, "  ", name, ": ", extents.empty() ? "a number" : extents, unit == "1" ? "" : ", " + unit);
  }
}

void describe_vtk(Out& out, const std::string& path, const std::string& extension) {
  const bool collection = extension == ".pvd";
  line(out, "format: VTK ",
       collection            ? "collection of times and bodies"
       : extension == ".vtu" ? "unstructured grid"
                             : "polygons",
       " (open it with ParaView)");
  (collection ? describe_collection : describe_pieces)(out, tags_of(path));
}

void describe_table(Out& out, const std::string& path) {
  std::ifstream file(path);
  std::string head, row;
  require(static_cast<bool>(std::getline(file, head)), path, ": is empty");
  std::size_t rows = 0;
  while (std::getline(file, row)) ++rows;
  line(out, "format: table, ", counted(rows, "row"));
  std::istringstream columns(head);
  while (std::getline(columns, row, ',')) line(out, "column: ", row);
}

}  // namespace elastogear::io
