// Meshes of some teeth of the test gears C14 (examples/drives/spur_c14.yaml) with fine flanks, for
// spur_pair_calculix.py:
//
//   spur_pair_mesh FOLDER FLANK TOOTH LAYERS TEETH [PINION_LAYERS PINION_WIDTH]
//
// FLANK rows of faces up each flank, TOOTH columns across a tooth, LAYERS across the face, TEETH of each
// gear, those nearest to the mate. PINION_LAYERS and PINION_WIDTH, m, are the pinion's own. Writes
// FOLDER/pinion.inp and FOLDER/wheel.inp, in the gears' body frames, with the sets of whole gears, and the
// node set hub: the bore, and where the teeth are cut from the disc.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <string>

#include "elastogear/gear/cylindrical.h"
#include "elastogear/mesh/file.h"

namespace {

using namespace elastogear;
using std::numbers::pi;

constexpr double kWidth = 14e-3;  // m, of a face

gear::CylindricalDrive c14(double pinion_width) {
  gear::CylindricalDrive drive;
  drive.m_n = 4.5e-3;
  drive.rack = gear::basic_rack("A");
  drive.gears = {{.name = "pinion", .z = 16, .x = 0.1817, .r_a = 82.635e-3 / 2},
                 {.name = "wheel", .z = 24, .x = 0.1715, .r_a = 118.544e-3 / 2}};
  for (gear::CylindricalGear& each : drive.gears) each.blank.face_width = kWidth;
  drive.gears[0].blank.face_width = pinion_width;
  drive.pairs = {{.a = 91.5e-3}};
  return drive;
}

// Number of the tooth that is nearest to the mate half a pitch after the first tooth of the pinion points to
// it.
int nearest_tooth(const gear::CylindricalGeometry& g, const std::vector<double>& angle, int i) {
  const double towards = i == 0 ? g.pair[0].direction : g.pair[0].direction + pi;
  const double turns = (towards - angle[i] - g.gear[i].theta_1) / (2 * pi / g.gear[i].z);
  return (static_cast<int>(std::lround(turns)) % g.gear[i].z + g.gear[i].z) % g.gear[i].z;
}

// The cells of `teeth` sectors from `first` on; nodes and cells are numbered sector by sector.
mesh::Mesh sectors(const mesh::Mesh& whole, int z, int first, int teeth) {
  const int n_cells = whole.cells.size() / z;
  std::vector<int> node(static_cast<std::size_t>(whole.n_nodes()), -1);
  mesh::Mesh part;
  std::vector<Eigen::Vector3d> X;
  for (int k = 0; k < teeth; ++k)
    for (int cell = (first + k) % z * n_cells, end = cell + n_cells; cell < end; ++cell) {
      std::vector<int> nodes(whole.cells[cell].begin(), whole.cells[cell].end());
      for (int& n : nodes) {
        if (node[n] < 0) {
          node[n] = static_cast<int>(X.size());
          X.push_back(whole.X.col(n));
        }
        n = node[n];
      }
      part.cells.add(whole.cells.type[cell], nodes);
    }
  part.X.resize(3, static_cast<Eigen::Index>(X.size()));
  for (std::size_t i = 0; i < X.size(); ++i) part.X.col(static_cast<Eigen::Index>(i)) = X[i];
  for (const auto& [name, nodes] : whole.node_sets)
    for (int n : nodes)
      if (node[n] >= 0) part.node_sets[name].push_back(node[n]);
  part.node_sets["hub"] = part.node_sets["bore"];
  for (int k = teeth; k < z; ++k)
    for (int cell = (first + k) % z * n_cells, end = cell + n_cells; cell < end; ++cell)
      for (int n : whole.cells[cell])
        if (node[n] >= 0) part.node_sets["hub"].push_back(node[n]);
  for (auto& [name, nodes] : part.node_sets) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  for (const auto& [name, faces] : whole.face_sets)
    for (const mesh::Face& f : faces)
      if (const mesh::Face own = {node[f[0]], node[f[1]], node[f[2]], node[f[3]]};
          std::none_of(own.begin(), own.end(), [](int n) { return n < 0; }))
        part.face_sets[name].push_back(own);
  return part;
}

void write(const std::string& folder, gear::WheelCounts counts, int teeth, int pinion_layers,
           double pinion_width) {
  const int layers = counts.web_layers;
  const gear::CylindricalDrive drive = c14(pinion_width);
  const gear::CylindricalGeometry g = gear::derive(drive);
  const std::vector<double> angle = gear::angles(drive, g, 0.5);
  for (int i = 0; i < 2; ++i) {
    const int first = nearest_tooth(g, angle, i) - teeth / 2 + g.gear[i].z;
    counts.web_layers = i == 0 ? pinion_layers : layers;
    const mesh::Mesh part = sectors(gear::cylindrical_mesh(drive, g, i, counts), g.gear[i].z, first, teeth);
    mesh::write_mesh(folder + "/" + drive.gears[i].name + ".inp", part);
    std::printf("%s: %d nodes, %d cells\n", drive.gears[i].name.c_str(), part.n_nodes(), part.cells.size());
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6 && argc != 8) {
    std::fprintf(stderr,
                 "usage: spur_pair_mesh FOLDER FLANK TOOTH LAYERS TEETH [PINION_LAYERS PINION_WIDTH]\n");
    return 2;
  }
  gear::WheelCounts counts{
      .tooth = std::atoi(argv[3]), .space = 3, .flank = std::atoi(argv[2]), .fillet = 3, .rim = 2, .ring = 3};
  counts.web_layers = std::atoi(argv[4]);
  try {
    write(argv[1], counts, std::atoi(argv[5]), argc == 8 ? std::atoi(argv[6]) : counts.web_layers,
          argc == 8 ? std::atof(argv[7]) : kWidth);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
