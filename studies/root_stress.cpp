// Stress at the roots of teeth on meshes of growing fineness, averaged and recovered on the free surface:
//
//   root_stress plane            the pinion of the test gears C14 in plane strain, hexahedra and tetrahedra
//   root_stress tooth            the same pinion in space
//   root_stress worm SIZE ...    the worm of the reference worm drive, by the sizes of elastogear mesh
//   root_stress wheel SIZE ...   its wheel
//
// The load is 1 kN along the normals of a flank, spread smoothly over a place that does not depend on the
// mesh. Printed are the largest von Mises stress and the largest first principal stress (MPa) at all nodes of
// the root that are not on a flank, and of the pinion the largest and the root mean square error of the
// stress tensor there, as shares of the largest von Mises stress, beside what is recovered on the finest
// mesh, at the nodes that both have.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "elastogear/base/petsc.h"
#include "elastogear/fem/restraint.h"
#include "elastogear/fem/stress.h"
#include "elastogear/gear/cylindrical.h"
#include "elastogear/gear/size.h"
#include "elastogear/gear/worm.h"
#include "elastogear/recovery/stress.h"
#include "elastogear/reduction/static_response.h"
#include "elastogear/reduction/stressed_body.h"

namespace {

using namespace elastogear;
using Eigen::Vector3d;

constexpr double kLoad = 1000;        // N
constexpr double kFaceWidth = 14e-3;  // m, of the test gears

// A body with a load on one flank.
struct Case {
  mesh::Mesh mesh;
  std::vector<std::string> held;
  std::string flank;                                   // face set that is loaded
  std::vector<int> root;                               // nodes at which the largest stress is looked for
  std::function<double(const Vector3d& X)> intensity;  // of the load, over the flank
  bool plane = false;                                  // nothing depends on z
  double load = kLoad;                                 // N
};

Vector3d face_normal(const mesh::Mesh& mesh, const mesh::Face& face) {  // times the area
  return (mesh.X.col(face[2]) - mesh.X.col(face[0])).cross(mesh.X.col(face[3]) - mesh.X.col(face[1])) / 2;
}

// Pressure in proportion to the intensity, with the resultant c.load, by 3 x 3 points on each face.
Eigen::Matrix3Xd nodal_forces(const Case& c, const std::vector<int>& node) {
  const auto local = [&](int n) { return std::lower_bound(node.begin(), node.end(), n) - node.begin(); };
  Eigen::Matrix3Xd f = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(node.size()));
  const double at[] = {-std::sqrt(0.6), 0, std::sqrt(0.6)}, weight[] = {5. / 18, 8. / 18, 5. / 18};
  for (const mesh::Face& face : c.mesh.face_sets.at(c.flank)) {
    const Vector3d area = face_normal(c.mesh, face);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const double u = at[i], v = at[j];
        const double N[] = {(1 - u) * (1 - v) / 4, (1 + u) * (1 - v) / 4, (1 + u) * (1 + v) / 4,
                            (1 - u) * (1 + v) / 4};
        Vector3d X = Vector3d::Zero();
        for (int k = 0; k < 4; ++k) X += N[k] * c.mesh.X.col(face[k]);
        for (int k = 0; k < 4; ++k)
          f.col(local(face[k])) -= weight[i] * weight[j] * c.intensity(X) * N[k] * area;
      }
  }
  return f * (c.load / f.rowwise().sum().norm());
}

struct Largest {
  double von_mises = 0, principal = 0;  // Pa
};

Largest largest(const Eigen::MatrixXd& sigma) {
  Largest result;
  for (const auto s : sigma.colwise()) {
    result.von_mises = std::max(result.von_mises, recovery::von_mises(recovery::StressVector(s)));
    result.principal = std::max(result.principal, recovery::rankine(recovery::StressVector(s)));
  }
  return result;
}

std::vector<int> nodes_of(const mesh::Mesh& mesh, const std::string& face_set) {
  std::set<int> nodes;
  for (const mesh::Face& face : mesh.face_sets.at(face_set)) nodes.insert(face.begin(), face.end());
  return {nodes.begin(), nodes.end()};
}

// Stresses at the root's nodes that are not on a flank.
struct Solution {
  Eigen::Matrix3Xd X;                   // m
  Eigen::MatrixXd averaged, recovered;  // 6 x n, Pa
};

Solution solve(const Case& c) {
  io::BodySource source;
  source.mesh = c.mesh;
  source.regions = {{"", {210e9, 0.3, 7850}}};
  source.free_dof = fem::free_dofs(fem::held_directions(c.mesh, c.held));
  const std::vector<int> loaded = nodes_of(c.mesh, c.flank), flanks = nodes_of(c.mesh, "flanks");
  source.recovery = {model::RecoveryMethod::surface, flanks};
  const Eigen::VectorXd u = reduction::StaticResponse(source).displacement(loaded, nodal_forces(c, loaded));
  std::vector<int> root;
  std::set_difference(c.root.begin(), c.root.end(), flanks.begin(), flanks.end(), std::back_inserter(root));
  fem::StressedBody body = reduction::stressed_body(source);
  const Eigen::MatrixXd recovered = fem::nodal_stress(body, u);
  body.recovery.method = model::RecoveryMethod::average;
  const Eigen::MatrixXd averaged = fem::nodal_stress(body, u);
  Solution s{c.mesh.X(Eigen::all, root), averaged(Eigen::all, root), recovered(Eigen::all, root)};
  if (c.plane) s.X.row(2).setZero();
  return s;
}

void print(const std::string& kind, const mesh::Mesh& mesh, const Solution& s) {
  const std::size_t n_nodes = std::set<int>(mesh.cells.nodes.begin(), mesh.cells.nodes.end()).size();
  const Largest averaged = largest(s.averaged), recovered = largest(s.recovered);
  std::printf("%-6s %8zu nodes, averaged / recovered: von Mises %7.2f / %7.2f, principal %7.2f / %7.2f",
              kind.c_str(), n_nodes, 1e-6 * averaged.von_mises, 1e-6 * recovered.von_mises,
              1e-6 * averaged.principal, 1e-6 * recovered.principal);
}

// How well the square of the difference of both, over the largest stress, estimates what is recovered: at how
// many nodes the error is below twice the estimate, and the median of estimate over error.
void print_estimate(const Solution& s, const Eigen::MatrixXd& error, double scale) {
  const Eigen::ArrayXd estimate = (s.recovered - s.averaged).colwise().squaredNorm() / scale,
                       true_error = error.colwise().norm();
  std::vector<double> ratio;
  for (Eigen::Index i = 0; i < estimate.size(); ++i)
    if (true_error[i] > 0) ratio.push_back(estimate[i] / true_error[i]);
  if (ratio.empty()) return;
  std::sort(ratio.begin(), ratio.end());
  const auto above = std::count_if(ratio.begin(), ratio.end(), [](double r) { return r > 0.5; });
  std::printf(", estimate holds at %.0f %%, median %.2f",
              100. * static_cast<double>(above) / static_cast<double>(ratio.size()), ratio[ratio.size() / 2]);
}

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
    return Solution{of.X(Eigen::all, nodes), of.averaged(Eigen::all, nodes), of.recovered(Eigen::all, nodes)};
  };
  return {part(s, own), part(reference, others)};
}

void print_error(const Solution& whole, const Solution& reference) {
  const auto [s, exact] = at_common_nodes(whole, reference);
  const double scale = largest(reference.recovered).von_mises;
  for (const Eigen::MatrixXd* sigma : {&s.averaged, &s.recovered}) {
    const Eigen::VectorXd error = (*sigma - exact.recovered).colwise().norm() / scale;
    std::printf("%s %.1f %% (%.1f %%)", sigma == &s.averaged ? ", errors" : " /", 100 * error.maxCoeff(),
                100 * std::sqrt(error.squaredNorm() / static_cast<double>(error.size())));
  }
  print_estimate(s, s.recovered - exact.recovered, scale);
}

// Six tetrahedra for each hexahedron, around its diagonal 0-6, which structured meshes cut alike from both
// sides.
mesh::Mesh tetrahedra(const mesh::Mesh& hexahedra) {
  mesh::Mesh result;
  result.X = hexahedra.X;
  result.node_sets = hexahedra.node_sets;
  result.face_sets = hexahedra.face_sets;
  static constexpr int kPieces[][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                       {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  for (int cell = 0; cell < hexahedra.cells.size(); ++cell)
    for (const auto& piece : kPieces) {
      std::array<int, 4> nodes;
      for (int i = 0; i < 4; ++i) nodes[i] = hexahedra.cells[cell][piece[i]];
      result.cells.add(mesh::CellType::tet4, nodes);
    }
  return result;
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

// 1 in the middle, 0 from half_width on, with smooth slopes.
double bump(double x, double middle, double half_width) {
  const double t = (x - middle) / half_width;
  return std::abs(t) < 1 ? std::pow(1 - t * t, 2) : 0;
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
  const int n_teeth = 16, n_cells = c.mesh.cells.size() / n_teeth;
  mesh::Cells cells;
  std::set<int> kept, cut;
  for (int cell = 0; cell < c.mesh.cells.size(); ++cell) {
    const int tooth = cell / n_cells;
    const bool keep = tooth <= 1 || tooth == n_teeth - 1;
    if (keep) cells.add(mesh::CellType::hex8, c.mesh.cells[cell]);
    (keep ? kept : cut).insert(c.mesh.cells[cell].begin(), c.mesh.cells[cell].end());
  }
  std::set_intersection(kept.begin(), kept.end(), cut.begin(), cut.end(),
                        std::back_inserter(c.mesh.node_sets["cut"]));
  c.mesh.cells = std::move(cells);
  std::erase_if(c.mesh.face_sets.at("flanks"), [&](const mesh::Face& face) {
    return std::any_of(face.begin(), face.end(), [&](int node) { return !kept.contains(node); });
  });
  c.held = {"bore", "cut"};
  return c;
}

// Loads a flank around the point of it that lies nearest to the pitch cylinder and to the middle of the body.
Case of_worm_drive(const std::string& what, const std::string& size) {
  const gear::Design design;
  const gear::Geometry geometry = gear::derive(design);
  const bool worm = what == "worm";
  Case c{worm ? gear::worm_mesh(design, gear::worm_counts(gear::size(size)))
              : gear::wheel_mesh(design, gear::wheel_counts(gear::size(size))),
         {worm ? "seats" : "bore"},
         worm ? "thread_1_left" : "tooth_01_left",
         {},
         {}};
  const gear::Toothing& toothing = worm ? geometry.worm : geometry.wheel;
  const double theta = gear::tooth_angle(toothing, 0) + gear::psi(toothing, toothing.r);
  const Vector3d middle(toothing.r * std::cos(theta), toothing.r * std::sin(theta), 0);
  c.intensity = [middle](const Vector3d& X) { return bump((X - middle).norm(), 0, 1.5e-3); };
  c.root = c.mesh.node_sets.at("root");
  return c;
}

void run_nested(const std::function<Case(int)>& make, const std::vector<int>& times, bool tetrahedral) {
  const Solution reference = solve(make(times.back()));
  for (int n : times)
    for (bool cut : {false, true}) {
      if (cut && !tetrahedral) continue;
      Case c = make(n);
      if (cut) c.mesh = tetrahedra(c.mesh);
      const Solution s = solve(c);
      print(cut ? "tet4" : "hex8", c.mesh, s);
      print_error(s, reference);
      std::printf("\n");
      std::fflush(stdout);
    }
}

void run(const std::string& what, const std::vector<std::string>& sizes) {
  if (what == "plane") return run_nested(plane_pinion, {1, 2, 4, 8, 16}, true);
  if (what == "tooth") return run_nested(pinion_in_space, {1, 2, 3, 6}, false);
  for (const std::string& size : sizes) {
    const Case c = of_worm_drive(what, size);
    print(size, c.mesh, solve(c));
    std::printf("\n");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Session session(argc, argv);
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty())
    return std::fprintf(stderr, "usage: root_stress plane | tooth | worm SIZE ... | wheel SIZE ...\n"), 2;
  try {
    run(words[0], {words.begin() + 1, words.end()});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
