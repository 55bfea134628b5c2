// Stress at the root of a pinion on meshes of growing fineness, averaged and recovered on the free surface:
//
//   root_stress plane   the pinion of the test gears C14 in plane strain, hexahedra and tetrahedra
//   root_stress tooth   the same pinion in space, hexahedra and tetrahedra
//
// The load is 1 kN along the normals of a flank, spread smoothly over a place that does not depend on the
// mesh. Printed are the largest von Mises stress and the largest first principal stress (MPa) at all nodes of
// the root that are not on a flank, and the largest and the root mean square error of the stress tensor
// there, as shares of the largest von Mises stress, beside what is recovered on the finest mesh, at the nodes
// that both have; and there and on the loaded flank how many nodes estimates are held against, at how many
// the error is below twice the estimate, and the median of estimate over error.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "elastogear/base/petsc.h"
#include "elastogear/gear/cylindrical.h"
#include "root_case.h"

namespace {

using namespace elastogear;
using namespace root_stress;
using Eigen::Vector3d;

constexpr double kFaceWidth = 14e-3;  // m, of the test gears

// Both at the nodes that the meshes share, all but some where the fillet ends.
std::pair<Solution, Solution> at_common_nodes(const Solution& s, const Solution& reference) {
  std::vector<int> own, others;
  for (int i = 0; i < s.X.cols(); ++i) {
    Eigen::Index nearest = 0;
    const double distance =
        (reference.X.colwise() - Vector3d(s.X.col(i))).colwise().norm().minCoeff(&nearest);
    if (distance > 1e-8) continue;
    own.push_back(i);
    others.push_back(static_cast<int>(nearest));
  }
  const auto part = [](const Solution& of, const std::vector<int>& nodes) {
    return Solution{{},
                    of.X(Eigen::all, nodes),
                    of.averaged(Eigen::all, nodes),
                    of.recovered(Eigen::all, nodes),
                    of.error(nodes)};
  };
  return {part(s, own), part(reference, others)};
}

void print_error(const std::string& kind, const Solutions& whole, const Solutions& reference) {
  const auto [root, exact_root] = at_common_nodes(whole.root, reference.root);
  const double scale = largest(reference.root.recovered).von_mises;
  print_errors(root, exact_root.recovered, scale);
  print_estimates(kind, "estimates at the root", root, exact_root.recovered, scale);
  const auto [flank, exact_flank] = at_common_nodes(whole.flank, reference.flank);
  print_estimates(kind, "on the flank", flank, exact_flank.recovered,
                  largest(exact_flank.recovered).von_mises);
}

gear::CylindricalDrive c14(double face_width = kFaceWidth) {
  gear::CylindricalDrive drive;
  drive.m_n = 4.5e-3;
  drive.rack = gear::basic_rack("A");
  drive.gears = {{.name = "pinion", .z = 16, .x = 0.1817, .r_a = 82.635e-3 / 2},
                 {.name = "wheel", .z = 24, .x = 0.1715, .r_a = 118.544e-3 / 2}};
  for (gear::CylindricalGear& each : drive.gears) each.blank.face_width = face_width;
  drive.pairs = {{.a = 91.5e-3}};
  return drive;
}

// Loads near the tip of a flank, in space near z = 2 mm besides.
std::function<double(const Vector3d& X)> near_tip(double r_a, bool everywhere) {
  return [=](const Vector3d& X) {
    return bump(X.head<2>().norm(), r_a - 2e-3, 1.8e-3) * (everywhere ? 1 : bump(X.z(), 2e-3, 4e-3));
  };
}

Case pinion(const gear::CylindricalDrive& drive, const gear::WheelCounts& counts, bool everywhere) {
  const auto geometry = gear::derive(drive);
  Case c{gear::cylindrical_mesh(drive, geometry, 0, counts),
         {"bore"},
         "tooth_01_left",
         {},
         near_tip(geometry.gear[0].r_a, everywhere)};
  c.root = c.mesh.node_sets.at("root_01");
  return c;
}

gear::WheelCounts counts_of(int times, int layers) {
  gear::WheelCounts counts{.tooth = 4 * times,
                           .space = times,
                           .flank = 3 * times,
                           .fillet = 2 * times,
                           .rim = 2 * times,
                           .ring = times};
  counts.web_layers = layers;
  return counts;
}

Case plane_pinion(int times) {
  const double width = 4e-3 / times;  // a cell as long as those of the section
  Case c = pinion(c14(width), counts_of(times, 1), true);
  c.plane = true;
  c.load *= width / kFaceWidth;
  for (int node = 0; node < c.mesh.n_nodes(); ++node) c.mesh.node_sets["sides"].push_back(node);
  c.held.emplace_back("sides:z");
  return c;
}

// The loaded tooth, its neighbours and the disc below them, held where they are cut from the whole.
Case pinion_in_space(int times) {
  Case c = pinion(c14(), counts_of(times, 6 * times), false);
  c.held = {"bore"};
  cut_teeth(c, 16, 1);
  return c;
}

void run_nested(const std::function<Case(int)>& make, const std::vector<int>& times) {
  const Solutions reference = solve(make(times.back()));
  for (int n : times)
    for (bool cut : {false, true}) {
      if (cut && n == times.back()) continue;
      Case c = make(n);
      if (cut) c.mesh = tetrahedra(c.mesh);
      const Solutions s = solve(c);
      print(cut ? "tet4" : "hex8", c.mesh, s.root);
      print_error((cut ? "tet4 " : "hex8 ") + std::to_string(n), s, reference);
      std::printf("\n");
      std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
  const Session session(argc, argv);
  const std::string what = argc == 2 ? argv[1] : "";
  if (what != "plane" && what != "tooth")
    return std::fprintf(stderr, "usage: root_stress plane | tooth\n"), 2;
  try {
    if (what == "plane") run_nested(plane_pinion, {1, 2, 4, 8, 16});
    if (what == "tooth") run_nested(pinion_in_space, {1, 2, 3, 6});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
