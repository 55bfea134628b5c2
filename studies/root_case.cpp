#include "root_case.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <numeric>
#include <set>

#include "elastogear/base/error.h"
#include "elastogear/fem/restraint.h"
#include "elastogear/fem/stress.h"
#include "elastogear/mesh/surface_patches.h"
#include "elastogear/recovery/patch_error.h"
#include "elastogear/recovery/stress.h"
#include "elastogear/reduction/static_response.h"
#include "elastogear/reduction/stressed_body.h"

namespace root_stress {

using namespace elastogear;
using Eigen::Vector3d;

namespace {

// Points of Gauss's rule of 3 points in each of kPieces equal pieces of [-1, 1], and their weights.
constexpr int kPieces = 4;

struct Rule {
  std::vector<double> at, weight;
};

Rule rule() {
  Rule all;
  for (int piece = 0; piece < kPieces; ++piece)
    for (int i = -1; i <= 1; ++i) {
      all.at.push_back((2 * piece + 1 + i * std::sqrt(0.6)) / kPieces - 1);
      all.weight.push_back((i == 0 ? 8. : 5.) / 9 / kPieces);
    }
  return all;
}

constexpr double kCornerAt[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

// Columns: shape functions of a side's 4 corners, or of its 8 nodes, at (u, v), and their derivatives by u
// and v.
Eigen::MatrixX3d shape_functions(std::size_t nodes, double u, double v) {
  Eigen::MatrixX3d N(nodes, 3);
  for (int i = 0; i < 4; ++i) {
    const double a = kCornerAt[i][0], b = kCornerAt[i][1], x = 1 + a * u, y = 1 + b * v;
    if (nodes == 4) {
      N.row(i) << x * y / 4, a * y / 4, b * x / 4;
      continue;
    }
    const double z = x + y - 3;
    N.row(i) << x * y * z / 4, a * y * (z + x) / 4, b * x * (z + y) / 4;
    const bool along_u = i % 2 == 0;  // the midside node behind corner i
    const double c = along_u ? b : a, w = along_u ? u : v, far = 1 + c * (along_u ? v : u);
    const double by_w = -w * far, across = c * (1 - w * w) / 2;
    N.row(4 + i) << (1 - w * w) * far / 2, along_u ? by_w : across, along_u ? across : by_w;
  }
  return N;
}

// Adds the forces of one side of a cell by its own shape functions. nodes: 4, of a triangle the third one
// twice, or 8.
template <class Add>
void add_side(const Case& c, const std::vector<int>& nodes, const Rule& points, const Add& add) {
  const Eigen::Matrix3Xd X = c.mesh.X(Eigen::all, nodes);
  for (std::size_t i = 0; i < points.at.size(); ++i)
    for (std::size_t j = 0; j < points.at.size(); ++j) {
      const Eigen::MatrixX3d N = shape_functions(nodes.size(), points.at[i], points.at[j]);
      const Eigen::Matrix3d x = X * N;  // place and both tangents
      const Vector3d f = -points.weight[i] * points.weight[j] * c.intensity(x.col(0)) *
                         Vector3d(x.col(1)).cross(Vector3d(x.col(2)));
      for (std::size_t k = 0; k < nodes.size(); ++k) add(nodes[k], N(static_cast<Eigen::Index>(k), 0) * f);
    }
}

// The sides of cells on a set of faces: those of 8 nodes whole, others as faces.
std::vector<std::vector<int>> loaded_sides(const mesh::Mesh& mesh, const std::vector<mesh::Face>& faces) {
  std::set<mesh::Face> keys;
  for (const mesh::Face& face : faces) keys.insert(mesh::face_key(face));
  std::vector<std::vector<int>> sides;
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    for (const auto& side : mesh::cell_side_nodes(mesh.cells.type[cell], mesh.cells[cell])) {
      const std::vector<mesh::Face> parts = mesh::side_faces(side);
      if (!keys.contains(mesh::face_key(parts[0]))) continue;
      if (side.size() == 8)
        sides.push_back(side);
      else
        for (const mesh::Face& part : parts) sides.emplace_back(part.begin(), part.end());
    }
  return sides;
}

// The triangles that quadrilaterals of a surface are cut into.
std::vector<mesh::Face> triangles_on(const std::vector<mesh::Face>& quadrilaterals,
                                     const std::vector<mesh::Face>& triangles) {
  std::set<std::set<int>> halves;
  for (const mesh::Face& face : quadrilaterals)
    for (int left_out : face) {
      std::set<int> half(face.begin(), face.end());
      half.erase(left_out);
      halves.insert(half);
    }
  std::vector<mesh::Face> result;
  std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(result), [&](const mesh::Face& face) {
    return halves.contains({face.begin(), face.end()});
  });
  return result;
}

}  // namespace

mesh::Mesh tetrahedra(const mesh::Mesh& hexahedra) {
  mesh::Mesh result;
  result.X = hexahedra.X;
  result.node_sets = hexahedra.node_sets;
  static constexpr int kPieces[][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                       {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  for (int cell = 0; cell < hexahedra.cells.size(); ++cell)
    for (const auto& piece : kPieces) {
      std::array<int, 4> nodes;
      for (int i = 0; i < 4; ++i) nodes[i] = hexahedra.cells[cell][piece[i]];
      result.cells.add(mesh::CellType::tet4, nodes);
    }
  const std::vector<mesh::Face> surface = mesh::boundary_faces(result);
  require(surface.size() == 2 * mesh::boundary_faces(hexahedra).size(),
          "this mesh's hexahedra are not cut alike from both sides");
  for (const auto& [name, faces] : hexahedra.face_sets) result.face_sets[name] = triangles_on(faces, surface);
  return result;
}

void cut_teeth(Case& c, int n_teeth, int beside) {
  const int n_cells = c.mesh.cells.size() / n_teeth;
  mesh::Cells cells;
  std::set<int> kept, cut;
  for (int cell = 0; cell < c.mesh.cells.size(); ++cell) {
    const int tooth = cell / n_cells;
    const bool keep = tooth <= beside || tooth >= n_teeth - beside;
    if (keep) cells.add(c.mesh.cells.type[cell], c.mesh.cells[cell]);
    (keep ? kept : cut).insert(c.mesh.cells[cell].begin(), c.mesh.cells[cell].end());
  }
  std::set_intersection(kept.begin(), kept.end(), cut.begin(), cut.end(),
                        std::back_inserter(c.mesh.node_sets["cut"]));
  c.mesh.cells = std::move(cells);
  std::erase_if(c.mesh.face_sets.at("flanks"), [&](const mesh::Face& face) {
    return std::any_of(face.begin(), face.end(), [&](int node) { return !kept.contains(node); });
  });
  c.held.emplace_back("cut");
}

double bump(double x, double middle, double half_width) {
  const double t = (x - middle) / half_width;
  return std::abs(t) < 1 ? std::pow(1 - t * t, 2) : 0;
}

std::vector<int> nodes_of(const mesh::Mesh& mesh, const std::string& face_set) {
  std::set<int> nodes;
  for (const mesh::Face& face : mesh.face_sets.at(face_set)) nodes.insert(face.begin(), face.end());
  return {nodes.begin(), nodes.end()};
}

Eigen::Matrix3Xd nodal_forces(const Case& c, const std::vector<int>& node) {
  const Rule points = rule();
  Eigen::Matrix3Xd f = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(node.size()));
  for (const auto& side : loaded_sides(c.mesh, c.mesh.face_sets.at(c.flank)))
    add_side(c, side, points, [&](int n, const Vector3d& part) {
      f.col(std::lower_bound(node.begin(), node.end(), n) - node.begin()) += part;
    });
  return f * (c.load / f.rowwise().sum().norm());
}

Largest largest(const Eigen::MatrixXd& sigma) {
  Largest result;
  for (const auto s : sigma.colwise()) {
    result.von_mises = std::max(result.von_mises, recovery::von_mises(recovery::StressVector(s)));
    result.principal = std::max(result.principal, recovery::rankine(recovery::StressVector(s)));
  }
  return result;
}

namespace {

Eigen::VectorXd von_mises_at_nodes(const Eigen::MatrixXd& sigma) {
  return recovery::von_mises(Eigen::MatrixXd(sigma.reshaped()));
}

// Estimated errors of a recovered stress and of means, Pa, at nodes on free surfaces, and the largest stress
// around them.
struct Errors {
  std::vector<int> node;
  Eigen::VectorXd error, of_mean, largest;
};

Errors recovered_errors(const mesh::Mesh& mesh, const std::vector<int>& nodes, const Eigen::VectorXd& stress,
                        const Eigen::VectorXd& difference) {
  Errors result;
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(result.node),
               [&](int node) { return difference[node] > 0; });
  auto patches = mesh::surface_patches(mesh, result.node);
  const std::vector<int> order = mesh::cell_orders(mesh, result.node);
  result.error.resize(std::ssize(result.node));
  result.of_mean = result.largest = result.error;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    std::erase_if(patches[i], [&](int node) { return difference[node] == 0; });
    const recovery::PatchError e =
        recovery::patch_error(difference(patches[i]), stress(patches[i]), order[i]);
    result.error[static_cast<Eigen::Index>(i)] = e.error;
    result.of_mean[static_cast<Eigen::Index>(i)] = e.of_mean;
    result.largest[static_cast<Eigen::Index>(i)] = e.largest;
  }
  return result;
}

// Share of errors in means near x, from the nodes on free surfaces that are nearest to it. docs/theory,
// Eq. (1.18a).
double share_nearby(const mesh::Mesh& mesh, const Errors& errors, const Vector3d& x) {
  constexpr std::ptrdiff_t kNearest = 8;
  std::vector<int> order(errors.node.size());
  std::iota(order.begin(), order.end(), 0);
  const auto distance = [&](int i) { return (mesh.X.col(errors.node[i]) - x).squaredNorm(); };
  const auto end = order.begin() + std::min(kNearest, std::ssize(order));
  std::partial_sort(order.begin(), end, order.end(), [&](int a, int b) { return distance(a) < distance(b); });
  order.erase(end, order.end());
  return errors.of_mean(order).norm() / errors.largest(order).norm();
}

// Errors of the means at loaded nodes by the strains within the surface, Pa: first factor of Eq. (1.18a).
Eigen::VectorXd errors_within(const mesh::Mesh& mesh, const std::vector<int>& nodes,
                              const Eigen::VectorXd& difference, const Eigen::VectorXd& stress) {
  auto patches = mesh::surface_patches(mesh, nodes);
  const std::vector<int> order = mesh::cell_orders(mesh, nodes);
  Eigen::VectorXd within = Eigen::VectorXd::Zero(stress.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    std::erase_if(patches[i], [&](int node) { return difference[node] == 0; });
    within[nodes[i]] = recovery::error_within_surface(difference(patches[i]), stress(patches[i]), order[i]);
  }
  return within;
}

}  // namespace

Solutions solve(const Case& c) {
  io::BodySource source;
  source.mesh = c.mesh;
  source.regions = {{"", {210e9, 0.3, 7850}}};
  source.free_dof = fem::free_dofs(fem::held_directions(c.mesh, c.held));
  const std::vector<int> loaded = nodes_of(c.mesh, c.flank), flanks = nodes_of(c.mesh, "flanks");
  source.recovery = {model::RecoveryMethod::surface, flanks};
  const Eigen::VectorXd u =
      reduction::StaticResponse(source).displacement(loaded, nodal_forces(c, loaded).reshaped());
  std::vector<int> root;
  std::set_difference(c.root.begin(), c.root.end(), flanks.begin(), flanks.end(), std::back_inserter(root));
  fem::StressedBody body = reduction::stressed_body(source);
  const Eigen::MatrixXd recovered = fem::nodal_stress(body, u);
  Eigen::VectorXd difference = Eigen::VectorXd::Zero(recovered.cols());
  difference(flanks) = recovery::von_mises(Eigen::MatrixXd(fem::difference_within_surface(body, flanks) * u));
  body.recovery.method = model::RecoveryMethod::average;
  const Eigen::MatrixXd averaged = fem::nodal_stress(body, u);
  const Eigen::VectorXd stress = von_mises_at_nodes(recovered);
  const Errors errors = recovered_errors(c.mesh, c.root, stress, von_mises_at_nodes(recovered - averaged));
  const Eigen::VectorXd within = errors_within(c.mesh, flanks, difference, stress);
  const auto at = [&](const std::vector<int>& nodes) {
    Solution s{nodes, c.mesh.X(Eigen::all, nodes), averaged(Eigen::all, nodes), recovered(Eigen::all, nodes),
               Eigen::VectorXd(std::ssize(nodes))};
    for (Eigen::Index i = 0; i < s.error.size(); ++i) {
      const int node = nodes[static_cast<std::size_t>(i)];
      const auto found = std::lower_bound(errors.node.begin(), errors.node.end(), node);
      if (found != errors.node.end() && *found == node) {
        s.error[i] = errors.error[found - errors.node.begin()];
        continue;
      }
      const double share = share_nearby(c.mesh, errors, c.mesh.X.col(node));
      s.error[i] =
          within[node] > 0 ? recovery::loaded_error(within[node], stress[node], share) : share * stress[node];
    }
    if (c.plane) s.X.row(2).setZero();
    return s;
  };
  return {at(root), at(loaded)};
}

void print(const std::string& kind, const mesh::Mesh& mesh, const Solution& s) {
  const std::size_t n_nodes = std::set<int>(mesh.cells.nodes.begin(), mesh.cells.nodes.end()).size();
  const Largest averaged = largest(s.averaged), recovered = largest(s.recovered);
  std::printf("%-6s %8zu nodes, averaged / recovered: von Mises %7.2f / %7.2f, principal %7.2f / %7.2f",
              kind.c_str(), n_nodes, 1e-6 * averaged.von_mises, 1e-6 * recovered.von_mises,
              1e-6 * averaged.principal, 1e-6 * recovered.principal);
  Eigen::Index at = 0;
  recovery::von_mises(Eigen::MatrixXd(s.recovered.reshaped(s.recovered.size(), 1))).col(0).maxCoeff(&at);
  const Vector3d X = s.X.col(at);
  std::printf(", at r %.2f mm, %.1f deg, z %.2f mm", 1e3 * X.head<2>().norm(),
              std::atan2(X[1], X[0]) * 180 / M_PI, 1e3 * X[2]);
}

namespace {

// Prints of a list of positive numbers its length, the share above one half in percent, and the median, and
// adds the list to a file.
void print_ratios(const std::string& kind, const std::string& what, std::vector<double> ratio) {
  if (ratio.empty()) return;
  std::ofstream file("ratios.csv", std::ios::app);
  for (double r : ratio) file << '"' << kind << "\"," << what << "," << r << "\n";
  std::sort(ratio.begin(), ratio.end());
  const auto above = std::count_if(ratio.begin(), ratio.end(), [](double r) { return r > 0.5; });
  std::printf(" %zu nodes, %.0f %%, %.2f;", ratio.size(),
              100. * static_cast<double>(above) / static_cast<double>(ratio.size()), ratio[ratio.size() / 2]);
}

}  // namespace

void print_errors(const Solution& s, const Eigen::MatrixXd& exact, double scale) {
  for (const Eigen::MatrixXd* sigma : {&s.averaged, &s.recovered}) {
    const Eigen::VectorXd error = (*sigma - exact).colwise().norm() / scale;
    std::printf("%s %.1f %% (%.1f %%)", sigma == &s.averaged ? ", errors" : " /", 100 * error.maxCoeff(),
                100 * std::sqrt(error.squaredNorm() / static_cast<double>(error.size())));
  }
}

void print_estimates(const std::string& kind, const std::string& what, const Solution& s,
                     const Eigen::MatrixXd& exact, double scale) {
  const Eigen::VectorXd difference = von_mises_at_nodes(s.recovered - s.averaged),
                        averaged = von_mises_at_nodes(s.averaged),
                        recovered = von_mises_at_nodes(s.recovered), truth = von_mises_at_nodes(exact);
  std::vector<double> of_averaged, of_recovered;
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    if (truth[i] < 0.1 * scale) continue;
    if (difference[i] > 0) of_averaged.push_back(difference[i] / std::abs(averaged[i] - truth[i]));
    of_recovered.push_back(s.error[i] / std::abs(recovered[i] - truth[i]));
  }
  std::printf(", %s:", what.c_str());
  if (!of_averaged.empty()) std::printf(" of averaged");
  print_ratios(kind, what + " of averaged", of_averaged);
  std::printf(" of recovered");
  print_ratios(kind, what + " of recovered", of_recovered);
}

}  // namespace root_stress
