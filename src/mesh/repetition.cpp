#include "elastogear/mesh/repetition.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <sstream>

#include "elastogear/base/rotation.h"
#include "mesh/point_index.h"

namespace elastogear::mesh {
namespace {

constexpr double kSamePlace = 1e-6;  // of the shortest edge at a node
constexpr double kPrincipal = 1e-6;  // of the second moments: how well an axis must be a principal one
constexpr double kSameAxis = 1e-6;   // sine of the angle between two axes
constexpr int kSamples = 16;         // nodes whose rings are counted

// The nodes of the cells, and what the search needs to know of them.
struct Cloud {
  const Mesh& mesh;
  const Labels& labels;
  std::vector<int> node;          // of the cells, ascending
  std::vector<double> edge;       // m, of each mesh node the shortest
  std::vector<int> cells, first;  // cells[first[i]] .. are the cells at node i
  Eigen::Vector3d centroid;
  Eigen::Matrix3d moments;  // second ones about the centroid, m^2, per node
};

// Outcome of the trial of one turn.
struct Trial {
  std::optional<Repetition> found;
  std::size_t matched = 0;  // nodes and cells
  std::string reason;
};

std::vector<double> shortest_edges(const Mesh& mesh) {
  std::vector<double> shortest(static_cast<std::size_t>(mesh.n_nodes()),
                               std::numeric_limits<double>::infinity());
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto nodes = mesh.cells[cell];
    double edge = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : edges(mesh.cells.type[cell]))
      edge = std::min(edge, (mesh.X.col(nodes[a]) - mesh.X.col(nodes[b])).norm());
    for (int node : nodes) shortest[node] = std::min(shortest[node], edge);
  }
  return shortest;
}

void list_cells_at_nodes(Cloud& cloud) {
  const Cells& cells = cloud.mesh.cells;
  cloud.first.assign(static_cast<std::size_t>(cloud.mesh.n_nodes()) + 1, 0);
  for (int node : cells.nodes) ++cloud.first[node + std::size_t{1}];
  std::partial_sum(cloud.first.begin(), cloud.first.end(), cloud.first.begin());
  std::vector<int> next = cloud.first;
  cloud.cells.resize(cells.nodes.size());
  for (int cell = 0; cell < cells.size(); ++cell)
    for (int node : cells[cell]) cloud.cells[next[node]++] = cell;
}

Cloud make_cloud(const Mesh& mesh, const Labels& labels) {
  Cloud cloud{mesh, labels, {}, shortest_edges(mesh), {}, {}, Eigen::Vector3d::Zero(), {}};
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (std::isfinite(cloud.edge[node])) cloud.node.push_back(node);
  list_cells_at_nodes(cloud);
  const Eigen::Matrix3Xd X = mesh.X(Eigen::all, cloud.node);
  cloud.centroid = X.rowwise().mean();
  const Eigen::Matrix3Xd D = X.colwise() - cloud.centroid;
  cloud.moments = D * D.transpose() / static_cast<double>(D.cols());
  return cloud;
}

// A turn by less than pi only keeps the second moments when its axis is a principal one.
bool is_principal(const Cloud& cloud, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d image = cloud.moments * axis;
  return (image - axis.dot(image) * axis).norm() <= kPrincipal * cloud.moments.trace();
}

std::vector<Eigen::Vector3d> candidate_axes(const Cloud& cloud) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(cloud.moments);
  Eigen::Matrix<double, 3, 6> directions;
  directions << Eigen::Matrix3d::Identity(), principal.eigenvectors();
  std::vector<Eigen::Vector3d> axes;
  for (const Eigen::Vector3d axis : directions.colwise()) {
    const auto same = [&](const Eigen::Vector3d& other) { return other.cross(axis).norm() < kSameAxis; };
    if (is_principal(cloud, axis) && std::none_of(axes.begin(), axes.end(), same)) axes.push_back(axis);
  }
  return axes;
}

// Nodes at the height and radius of a sample come in whole orbits: Z divides their number.
int common_divisor_of_rings(const Cloud& cloud, const Eigen::Vector3d& axis) {
  const Eigen::Matrix3Xd D = cloud.mesh.X(Eigen::all, cloud.node).colwise() - cloud.centroid;
  const Eigen::VectorXd height = D.transpose() * axis;
  const Eigen::VectorXd radius = (D - axis * height.transpose()).colwise().norm();
  int divisor = 0;
  const auto n = static_cast<std::ptrdiff_t>(cloud.node.size()),
             step = std::max<std::ptrdiff_t>(1, n / kSamples);
  for (std::ptrdiff_t i = 0; i < n && divisor != 1; i += step) {
    const double same = 2 * kSamePlace * cloud.edge[cloud.node[i]];
    if (radius(i) <= same) continue;
    const auto on_ring =
        (height.array() - height(i)).abs() <= same && (radius.array() - radius(i)).abs() <= same;
    divisor = std::gcd(divisor, static_cast<int>(on_ring.count()));
  }
  return divisor;
}

std::string describe(const Turn& turn) {
  std::ostringstream text;
  text << "a turn by 2 pi/" << turn.n_sectors << " about the direction (" << turn.axis.transpose()
       << ") through (" << turn.point.transpose() << ") m";
  return text.str();
}

// "2 of 100 nodes have no image, first node 7": empty when there are none.
std::string misfits(const char* what, const std::vector<int>& unmatched, std::size_t all, const char* lack) {
  if (unmatched.empty()) return {};
  std::ostringstream text;
  text << " leaves " << unmatched.size() << " of " << all << " " << what << "s " << lack << ", first " << what
       << " " << unmatched.front() << " (counted from 0)";
  return text.str();
}

// Returns for each node the node that it is turned to; -1 when there is none.
std::vector<int> images_of_nodes(const Cloud& cloud, const PointIndex& index, const Turn& turn) {
  const Eigen::Matrix3d R = rotation_matrix(2 * std::numbers::pi / turn.n_sectors * turn.axis);
  std::vector<int> image(static_cast<std::size_t>(cloud.mesh.n_nodes()), -1);
  for (int node : cloud.node) {
    const Eigen::Vector3d x = turn.point + R * (cloud.mesh.X.col(node) - turn.point);
    image[node] = index.find(x, kSamePlace * cloud.edge[node]);
  }
  return image;
}

// Nodes without an image, with one of another label, or that share theirs.
std::vector<int> unmatched_nodes(const Cloud& cloud, const std::vector<int>& image) {
  std::vector<int> unmatched;
  std::vector<bool> taken(image.size(), false);
  for (int node : cloud.node) {
    const int to = image[node];
    if (to < 0 || taken[to] || cloud.labels.node[to] != cloud.labels.node[node])
      unmatched.push_back(node);
    else
      taken[to] = true;
  }
  return unmatched;
}

std::vector<Face> sorted_faces(CellType type, std::span<const int> nodes) {
  std::vector<Face> faces = cell_faces(type, nodes);
  for (Face& face : faces) face = face_key(face);
  std::sort(faces.begin(), faces.end());
  return faces;
}

// The cell with these nodes and, as far as its faces tell, in this order; -1 if there is none.
int find_cell(const Cloud& cloud, CellType type, const std::vector<int>& nodes) {
  const Cells& cells = cloud.mesh.cells;
  for (int i = cloud.first[nodes[0]]; i < cloud.first[nodes[0] + 1]; ++i) {
    const int cell = cloud.cells[i];
    const auto other = cells[cell];
    if (cells.type[cell] != type) continue;
    if (std::equal(other.begin(), other.end(), nodes.begin())) return cell;
    if (std::is_permutation(other.begin(), other.end(), nodes.begin()) &&
        sorted_faces(type, other) == sorted_faces(type, nodes))
      return cell;
  }
  return -1;
}

std::vector<int> images_of_cells(const Cloud& cloud, const std::vector<int>& image_of_node) {
  const Cells& cells = cloud.mesh.cells;
  std::vector<int> image, nodes;
  for (int cell = 0; cell < cells.size(); ++cell) {
    nodes.clear();
    for (int node : cells[cell]) nodes.push_back(image_of_node[node]);
    image.push_back(find_cell(cloud, cells.type[cell], nodes));
  }
  return image;
}

std::vector<int> unmatched_cells(const Cloud& cloud, const std::vector<int>& image) {
  std::vector<int> unmatched;
  for (int cell = 0; cell < cloud.mesh.cells.size(); ++cell)
    if (image[cell] < 0 || cloud.labels.cell[image[cell]] != cloud.labels.cell[cell])
      unmatched.push_back(cell);
  return unmatched;
}

// The first node of each orbit: neighbours of such nodes where possible, so that they make up a sector in one
// piece.
void number_nodes(const Cloud& cloud, const std::vector<int>& image, Repetition& repetition) {
  std::vector<int> reached;
  const auto reach = [&](int first) {
    if (repetition.orbit[first] >= 0) return;
    int sector_index = 0;
    for (int node = first; repetition.orbit[node] < 0; node = image[node]) {
      repetition.orbit[node] = static_cast<int>(repetition.on_axis.size());
      repetition.sector_index[node] = sector_index++;
    }
    repetition.on_axis.push_back(sector_index == 1);
    reached.push_back(first);
  };
  std::size_t next = 0;
  for (int node : cloud.node)
    for (reach(node); next < reached.size(); ++next)
      for (int at = cloud.first[reached[next]], end = cloud.first[reached[next] + 1]; at < end; ++at)
        for (int neighbour : cloud.mesh.cells[cloud.cells[at]]) reach(neighbour);
}

void number_cells(const std::vector<int>& image, Repetition& repetition) {
  std::vector<bool> seen(image.size(), false);
  for (int first = 0; first < static_cast<int>(image.size()); ++first) {
    if (seen[first]) continue;
    int count = 0;
    for (int cell = first; !seen[cell]; cell = image[cell], ++count) seen[cell] = true;
    repetition.cell.push_back(first);
    repetition.cell_count.push_back(count);
  }
}

Repetition number_orbits(const Cloud& cloud, const Turn& turn, const std::vector<int>& image_of_node,
                         const std::vector<int>& image_of_cell) {
  Repetition repetition{
      turn, std::vector<int>(image_of_node.size(), -1), std::vector<int>(image_of_node.size(), 0), {}, {},
      {}};
  number_nodes(cloud, image_of_node, repetition);
  number_cells(image_of_cell, repetition);
  return repetition;
}

Trial try_turn(const Cloud& cloud, const PointIndex& index, const Turn& turn) {
  const std::vector<int> image = images_of_nodes(cloud, index, turn);
  const std::vector<int> nodes = unmatched_nodes(cloud, image);
  Trial trial;
  trial.matched = cloud.node.size() - nodes.size();
  trial.reason =
      describe(turn) + misfits("node", nodes, cloud.node.size(), "without an equal image of their own");
  if (!nodes.empty()) return trial;
  const std::vector<int> image_of_cell = images_of_cells(cloud, image);
  const std::vector<int> cells = unmatched_cells(cloud, image_of_cell);
  trial.matched += image_of_cell.size() - cells.size();
  trial.reason =
      describe(turn) + misfits("cell", cells, image_of_cell.size(), "without an image of their material");
  if (cells.empty()) trial.found = number_orbits(cloud, turn, image, image_of_cell);
  return trial;
}

// The largest Z greater than `above` about one axis.
Trial try_axis(const Cloud& cloud, const PointIndex& index, const Eigen::Vector3d& axis, int above) {
  Trial best;
  const int divisor = common_divisor_of_rings(cloud, axis);
  for (int Z = divisor; Z > std::max(above, 1); --Z) {
    if (divisor % Z != 0) continue;
    Trial trial = try_turn(cloud, index, {Z, cloud.centroid, axis});
    if (trial.matched >= best.matched) best = std::move(trial);
    if (best.found) break;
  }
  return best;
}

}  // namespace

RepetitionSearch find_repetition(const Mesh& mesh, const Labels& labels) {
  if (mesh.cells.size() == 0) return {{}, "it has no cells"};
  const Cloud cloud = make_cloud(mesh, labels);
  const PointIndex index(mesh.X, cloud.node);
  Trial best{{}, 0, "its rings of nodes about the principal axes have no common divisor"};
  for (const Eigen::Vector3d& axis : candidate_axes(cloud)) {
    Trial trial = try_axis(cloud, index, axis, best.found ? best.found->turn.n_sectors : 1);
    if (trial.found || (!best.found && trial.matched > best.matched)) best = std::move(trial);
  }
  if (best.found) best.reason.clear();
  return {std::move(best.found), std::move(best.reason)};
}

}  // namespace elastogear::mesh
