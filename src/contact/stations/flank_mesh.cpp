#include "contact/stations/flank_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "elastogear/base/error.h"
#include "elastogear/base/sort_unique.h"
#include "elastogear/contact/face.h"

namespace elastogear::contact {
namespace {

constexpr double kSameLine = 1e-3;  // of the extent of a flank's corners, within which they are one line

// Ascending values without those that are nearly equal to the one before.
std::vector<double> lines(std::vector<double> value) {
  std::sort(value.begin(), value.end());
  const double near = kSameLine * (value.back() - value.front());
  std::vector<double> line, group;
  const auto close = [&] {
    double sum = 0;
    for (double x : group) sum += x;
    line.push_back(sum / static_cast<double>(group.size()));
    group.clear();
  };
  for (double x : value) {
    if (!group.empty() && x > group.back() + near) close();
    group.push_back(x);
  }
  close();
  return line;
}

int nearest(const std::vector<double>& line, double x) {
  const auto at = std::min_element(line.begin(), line.end(),
                                   [&](double a, double b) { return std::abs(a - x) < std::abs(b - x); });
  return static_cast<int>(at - line.begin());
}

// The nodes of the sides of cells that the faces of a flank are parts of: 4 or 8 each, as FlankGrid::Face.
std::vector<FlankGrid::Face> sides(const model::Surface& surface, const std::vector<int>& face,
                                   const std::string& group) {
  std::set<FlankGrid::Face> all;
  for (int f : face) {
    FlankGrid::Face nodes;
    nodes.fill(-1);
    if (surface.side.cols() > 0 && surface.side(0, f) >= 0)
      for (std::size_t i = 0; i < 8; ++i) nodes[i] = surface.side(static_cast<Eigen::Index>(i), f);
    else
      for (std::size_t i = 0; i < 4; ++i) nodes[i] = surface.face(static_cast<Eigen::Index>(i), f);
    require(nodes[3] >= 0 && nodes[2] != nodes[3] && (nodes[4] < 0 || nodes[7] >= 0), "the flank ", group,
            " has triangles; contact at stations needs quadrilaterals in rows and layers");
    all.insert(nodes);
  }
  return {all.begin(), all.end()};
}

class GridOfFlank {
 public:
  GridOfFlank(const model::Surface& surface, const ExactFlanks& flanks, FlankMesh& mesh, std::string group)
      : mesh_(mesh), group_(std::move(group)), sides_(sides(surface, mesh.face, group_)) {
    for (const FlankGrid::Face& side : sides_)
      for (int node : side)
        if (node >= 0) mesh_.node.push_back(node);
    sort_unique(mesh_.node);
    for (int node : mesh_.node) at_.push_back(flanks.chart(mesh.name, surface.X.col(node)));
    mesh_.grid.n_nodes = static_cast<int>(mesh_.node.size());
    by_number_ = mesh_.node;
  }
  void build() {
    set_lines();
    set_order();
    set_faces();
  }

 private:
  // Among the nodes by their numbers.
  std::size_t number(int node) const {
    return static_cast<std::size_t>(std::lower_bound(by_number_.begin(), by_number_.end(), node) -
                                    by_number_.begin());
  }
  // Among them row by row.
  int local(int node) const { return place_[number(node)]; }
  const Eigen::Vector2d& at(int node) const { return at_[number(node)]; }

  // Nodes row by row and along it, whatever their numbers are.
  void set_order() {
    const double near = kSameLine * (mesh_.grid.v.back() - mesh_.grid.v.front());
    std::vector<int> order(mesh_.node.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int i, int j) {
      const Eigen::Vector2d &a = at_[static_cast<std::size_t>(i)], &b = at_[static_cast<std::size_t>(j)];
      const auto row_a = std::llround(a[0] / near), row_b = std::llround(b[0] / near);
      return std::abs(row_a - row_b) > 1 ? row_a < row_b : a[1] < b[1];
    });
    place_.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      place_[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
      mesh_.node[i] = by_number_[static_cast<std::size_t>(order[i])];
    }
  }

  void set_lines() {
    std::vector<double> v, z;
    for (const FlankGrid::Face& side : sides_)
      for (std::size_t i = 0; i < 4; ++i) {
        v.push_back(at(side[i])[0]);
        z.push_back(at(side[i])[1]);
      }
    mesh_.grid.v = lines(v);
    mesh_.grid.z = lines(z);
    const std::size_t n = (mesh_.grid.v.size() - 1) * (mesh_.grid.z.size() - 1);
    require(sides_.size() == n, "the flank ", group_, " has ", sides_.size(), " faces in ",
            mesh_.grid.v.size() - 1, " rows and ", mesh_.grid.z.size() - 1,
            " layers; contact at stations needs one in each");
    mesh_.grid.face.resize(n);
    if (sides_.front()[4] >= 0) mesh_.grid.v_mid.assign(mesh_.grid.v.size() - 1, 0);
  }

  void set_faces() {
    for (const FlankGrid::Face& side : sides_) {
      std::array<int, 4> row{}, layer{};
      for (std::size_t i = 0; i < 4; ++i) {
        row[i] = nearest(mesh_.grid.v, at(side[i])[0]);
        layer[i] = nearest(mesh_.grid.z, at(side[i])[1]);
      }
      const int r = *std::min_element(row.begin(), row.end());
      const int l = *std::min_element(layer.begin(), layer.end());
      const auto row_begin = static_cast<std::size_t>(r) * static_cast<std::size_t>(mesh_.grid.n_layers());
      FlankGrid::Face& face = mesh_.grid.face[row_begin + static_cast<std::size_t>(l)];
      face = in_order(side, row, layer, r, l);
      if (face[4] >= 0)
        mesh_.grid.v_mid[static_cast<std::size_t>(r)] = at(mesh_.node[static_cast<std::size_t>(face[4])])[0];
    }
  }

  // Nodes of a side from the corner low-low to that high in v on.
  FlankGrid::Face in_order(const FlankGrid::Face& side, const std::array<int, 4>& row,
                           const std::array<int, 4>& layer, int r, int l) const {
    const auto corner = [&](int up, int far) {
      for (std::size_t i = 0; i < 4; ++i)
        if (row[i] == r + up && layer[i] == l + far) return i;
      fail("a face of the flank ", group_, " is no rectangle of its rows and layers");
    };
    const std::array<std::size_t, 4> order{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
    FlankGrid::Face face;
    face.fill(-1);
    for (std::size_t i = 0; i < 4; ++i) {
      face[i] = local(side[order[i]]);
      if (side[4] < 0) continue;
      const std::size_t a = order[i], b = order[(i + 1) % 4];
      face[4 + i] = local(side[4 + ((a + 1) % 4 == b ? a : b)]);  // midside node i stands behind corner i
    }
    return face;
  }

  FlankMesh& mesh_;
  std::string group_;
  std::vector<FlankGrid::Face> sides_;
  std::vector<int> by_number_;       // nodes of the surface, ascending
  std::vector<Eigen::Vector2d> at_;  // of each of them
  std::vector<int> place_;           // the same, row by row
};

}  // namespace

std::vector<FlankMesh> flank_meshes(const model::Surface& surface, const ExactFlanks& flanks) {
  std::map<int, FlankMesh> by_group;
  for (int f = 0; f < surface.face.cols(); ++f) {
    const int group = surface.group[static_cast<std::size_t>(f)];
    if (const auto known = by_group.find(group); known != by_group.end()) {
      known->second.face.push_back(f);
      continue;
    }
    const FlankName name = flanks.flank_of(surface.group_name[static_cast<std::size_t>(group)]);
    if (name.tooth < 0) continue;
    by_group.emplace(group, FlankMesh{name}).first->second.face.push_back(f);
  }
  std::vector<FlankMesh> meshes;
  for (auto& [group, mesh] : by_group) {
    GridOfFlank(surface, flanks, mesh, surface.group_name[static_cast<std::size_t>(group)]).build();
    for (int f : mesh.face) {
      Eigen::Matrix<double, 2, 4> corners;
      for (Eigen::Index i = 0; i < 4; ++i)
        corners.col(i) = flanks.chart(mesh.name, surface.X.col(surface.face(i, f)));
      mesh.at.push_back(corners);
    }
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

namespace {

// Local coordinates of a place on a face by Newton's method, and how far it lies beyond the face.
struct OnFace {
  int sides;
  Eigen::Vector2d at;
  double beyond;
};

OnFace on_face(const Eigen::Matrix<double, 2, 4>& corner, const Eigen::Vector2d& place) {
  constexpr int kSteps = 3;  // faces are nearly parallelograms
  OnFace on{corner.col(2) == corner.col(3) ? 3 : 4, {0, 0}, 0};
  for (int step = 0; step < kSteps; ++step) {
    const Shape s = shape(on.sides, on.at[0], on.at[1]);
    Eigen::Matrix2d J;
    J << corner * s.N_u, corner * s.N_v;
    on.at -= J.inverse() * (corner * s.N - place);
  }
  if (on.sides == 4)
    on.beyond = on.at.cwiseAbs().maxCoeff() - 1;
  else
    on.beyond = 2 * std::max({-on.at[0], -on.at[1], on.at.sum() - 1});
  return on;
}

}  // namespace

FaceOfFlank face_at(const FlankMesh& flank, double v, double z) {
  FaceOfFlank best{-1, 0, 0};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < flank.face.size(); ++f) {
    const OnFace on = on_face(flank.at[f], {v, z});
    if (!(on.beyond < least)) continue;
    least = on.beyond;
    const Eigen::Vector2d natural = natural_coordinates(on.sides, on.at[0], on.at[1]);
    best = {flank.face[f], std::clamp(natural[0], -1., 1.), std::clamp(natural[1], -1., 1.)};
  }
  return best;
}

}  // namespace elastogear::contact
