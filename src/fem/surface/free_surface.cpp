#include "fem/surface/free_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace elastogear::fem {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
// Faces belong to one smooth surface when they turn by less than kSmooth, of a hollow as of a fillet by less
// than kSharp; they make an edge when they turn by more than kSharp. Shafts of 8 or 9 facets are at none of
// these bounds.
constexpr double kSmooth = 42 * kDegree, kSharp = 58 * kDegree;
constexpr double kWidest = 60 * kDegree;  // the normals of a patch differ by less from that at its node

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

int corners(const mesh::Face& face) { return face[2] == face[3] ? 3 : 4; }

int corner_of(const mesh::Face& face, int node) {
  return static_cast<int>(std::find(face.begin(), face.end(), node) - face.begin());
}

// Neighbours of a node along the contour of its face.
std::array<int, 2> neighbours(const mesh::Face& face, int node) {
  const int n = corners(face), i = corner_of(face, node);
  return {face[(i + n - 1) % n], face[(i + 1) % n]};
}

// Returns whether both faces have an edge at the node.
bool share_edge(const mesh::Face& f, const mesh::Face& g, int node) {
  const auto a = neighbours(f, node), b = neighbours(g, node);
  return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
}

Eigen::Vector3d normal(const Eigen::Matrix3Xd& X, const mesh::Face& face) {
  const Eigen::Vector3d a = X.col(face[2]) - X.col(face[0]),
                        b = X.col(corners(face) == 3 ? face[0] : face[3]) - X.col(face[1]);
  return a.cross(b).normalized();
}

// Directions in which a face is supported whose nodes are all held in some: all, or the one along its normal.
// (The sides of a plate of one cell's thickness in plane strain are free though all their nodes are held
// across.)
mesh::Directions support(mesh::Directions held, const Eigen::Vector3d& n) {
  if (held == mesh::kAllDirections) return held;
  for (int d = 0; d < 3; ++d)
    if (mesh::holds(held, d) && std::abs(n[d]) > std::cos(kSmooth / 2))
      return static_cast<mesh::Directions>(1 << d);
  return 0;
}

// Labels of the sheets that faces at a node form, joined by smooth edges.
class Labels {
 public:
  explicit Labels(std::size_t n) : label_(n) {
    for (std::size_t i = 0; i < n; ++i) label_[i] = i;
  }
  void join(std::size_t i, std::size_t j) {
    std::replace(label_.begin(), label_.end(), label_[j], label_[i]);
  }
  std::size_t operator[](std::size_t i) const { return label_[i]; }

 private:
  std::vector<std::size_t> label_;
};

}  // namespace

FreeSurface::FreeSurface(const StressedBody& body, const std::vector<int>& region)
    : mesh_(body.mesh), held_(body.held), averaged_(static_cast<std::size_t>(body.mesh.n_nodes()), false) {
  const auto n_nodes = averaged_.size();
  if (held_.empty()) held_.assign(n_nodes, 0);
  std::vector<int> cell;
  face_ = mesh::boundary_faces(mesh_, &cell);
  n_.resize(3, static_cast<Eigen::Index>(face_.size()));
  offset_.assign(n_nodes + 1, 0);
  for (std::size_t f = 0; f < face_.size(); ++f) {
    const mesh::Face& face = face_[f];
    region_.push_back(region[cell[f]]);
    n_.col(static_cast<Eigen::Index>(f)) = normal(mesh_.X, face);
    mesh::Directions held = mesh::kAllDirections;
    for (int node : face) held &= held_[node];
    support_.push_back(support(held, n_.col(static_cast<Eigen::Index>(f))));
    for (int i = 0; i < corners(face); ++i) ++offset_[face[i] + 1];
  }
  for (std::size_t i = 0; i < n_nodes; ++i) offset_[i + 1] += offset_[i];
  at_node_.resize(offset_.back());
  std::vector<int> next(offset_.begin(), offset_.end() - 1);
  for (std::size_t f = 0; f < face_.size(); ++f)
    for (int i = 0; i < corners(face_[f]); ++i) at_node_[next[face_[f][i]]++] = static_cast<int>(f);
  for (int node : body.recovery.loaded) averaged_[node] = true;
  std::vector<int> region_at(n_nodes, -1);
  for (int c = 0; c < mesh_.cells.size(); ++c)
    for (int node : mesh_.cells[c]) {
      if (region_at[node] >= 0 && region_at[node] != region[c]) averaged_[node] = true;
      region_at[node] = region[c];
    }
  for (std::size_t i = 0; i < n_nodes; ++i)
    if (held_[i] == mesh::kAllDirections) averaged_[i] = true;
}

std::span<const int> FreeSurface::faces_at(int node) const {
  return {at_node_.data() + offset_[node], static_cast<std::size_t>(offset_[node + 1] - offset_[node])};
}

Eigen::Vector3d FreeSurface::middle(int f) const {
  const mesh::Face& face = face_[f];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < corners(face); ++i) sum += mesh_.X.col(face[i]);
  return sum / corners(face);
}

// The forces of a support act on faces that it meets at right angles, as a plane of symmetry does.
bool FreeSurface::is_smoothly_held(int node) const {
  mesh::Directions supported = 0;
  for (int f : faces_at(node)) supported |= support_[f];
  return (held_[node] & ~supported) == 0;
}

FreeSurface::Joint FreeSurface::joint(int f, int g) const {
  const double turn = angle(n_.col(f), n_.col(g));
  if (support_[f] != 0 && support_[g] != 0) return Joint::none;
  if (support_[f] != 0 || support_[g] != 0)
    return std::abs(turn - 90 * kDegree) < kSmooth / 2 ? Joint::none : Joint::unclear;
  const bool convex = (middle(g) - middle(f)).dot(n_.col(f)) < 0;
  if (turn < (convex ? kSmooth : kSharp)) return Joint::smooth;
  return convex && turn > kSharp ? Joint::sharp : Joint::unclear;
}

std::vector<Sheet> FreeSurface::sheets(int node) const {
  const auto faces = faces_at(node);
  if (averaged_[node] || faces.empty() || !is_smoothly_held(node)) return {};
  Labels label(faces.size());
  std::size_t sharp = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    int n_joints = 0;
    for (std::size_t j = 0; j < faces.size(); ++j) {
      if (i == j || !share_edge(face_[faces[i]], face_[faces[j]], node)) continue;
      ++n_joints;
      const Joint kind = joint(faces[i], faces[j]);
      if (kind == Joint::unclear) return {};
      if (kind == Joint::smooth) label.join(i, j);
      sharp += kind == Joint::sharp;
    }
    if (n_joints != 2 && faces.size() > 2) return {};
  }
  std::map<std::size_t, Sheet> sheet;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (support_[faces[i]] != 0) continue;
    Sheet& s = sheet.try_emplace(label[i], Sheet{{}, Eigen::Vector3d::Zero()}).first->second;
    s.face.push_back(faces[i]);
    s.n += n_.col(faces[i]);
  }
  std::vector<Sheet> result;
  for (auto& [number, s] : sheet) {
    s.n.normalize();
    result.push_back(std::move(s));
  }
  if (result.size() > 1 && sharp == 0) return {};
  return result;
}

bool FreeSurface::continues(int f, int g, const Sheet& sheet) const {
  return support_[g] == 0 && region_[g] == region_[f] && joint(f, g) == Joint::smooth &&
         angle(sheet.n, n_.col(g)) < kWidest;
}

std::vector<int> FreeSurface::patch(const Sheet& sheet, int rings) const {
  std::set<int> faces(sheet.face.begin(), sheet.face.end()), nodes;
  const auto add_nodes = [&](int f) { nodes.insert(face_[f].begin(), face_[f].end()); };
  for (int f : faces) add_nodes(f);
  for (int ring = 1; ring < rings; ++ring) {
    for (int node : std::set<int>(nodes)) {
      for (bool grows = true; grows;) {
        grows = false;
        for (int f : faces_at(node)) {
          if (!faces.contains(f)) continue;
          for (int g : faces_at(node))
            if (!faces.contains(g) && share_edge(face_[f], face_[g], node) && continues(f, g, sheet))
              grows = faces.insert(g).second;
        }
      }
    }
    for (int f : faces) add_nodes(f);
  }
  return {nodes.begin(), nodes.end()};
}

}  // namespace elastogear::fem
