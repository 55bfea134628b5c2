#include "contact/stations/flank_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "elastogear/base/sort_unique.h"
#include "elastogear/contact/face.h"

namespace elastogear::contact {
namespace {

constexpr double kSameLine = 1e-3;   // of the extent of a flank's corners, within which they are one line
constexpr double kSamePlace = 1e-6;  // of that extent, of nodes of flanks that are copies of each other

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

// The nodes of the sides of cells that the faces of a flank are parts of, corners first.
using SideNodes = std::vector<int>;

std::vector<SideNodes> sides(const model::Surface& surface, const std::vector<int>& face) {
  std::set<SideNodes> all;
  for (int f : face) {
    SideNodes nodes;
    if (surface.side.cols() > 0 && surface.side(0, f) >= 0) {
      for (int node : surface.side.col(f))
        if (node >= 0) nodes.push_back(node);
    } else {
      for (int node : surface.face.col(f)) nodes.push_back(node);
      if (nodes[2] == nodes[3]) nodes.pop_back();
    }
    all.insert(nodes);
  }
  return {all.begin(), all.end()};
}

class GridOfFlank {
 public:
  GridOfFlank(const model::Surface& surface, const ExactFlanks& flanks, FlankMesh& mesh)
      : mesh_(mesh), sides_(sides(surface, mesh.face)) {
    for (const SideNodes& side : sides_) mesh_.node.insert(mesh_.node.end(), side.begin(), side.end());
    sort_unique(mesh_.node);
    for (int node : mesh_.node) at_.push_back(flanks.chart(mesh.name, surface.X.col(node)));
    mesh_.grid.n_nodes = static_cast<int>(mesh_.node.size());
    by_number_ = mesh_.node;
  }
  void build() {
    set_lines();
    place_.resize(mesh_.node.size());
    std::iota(place_.begin(), place_.end(), 0);
    const bool grid = is_grid() && (set_order(), set_faces());
    if (!grid) set_patches();
    for (int node : mesh_.node) mesh_.place.push_back(at(node));
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
    for (std::size_t i = 0; i < order.size(); ++i) {
      place_[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
      mesh_.node[i] = by_number_[static_cast<std::size_t>(order[i])];
    }
  }

  void set_lines() {
    std::vector<double> v, z;
    for (const SideNodes& side : sides_)
      for (std::size_t i = 0; i < corners_of(side); ++i) {
        v.push_back(at(side[i])[0]);
        z.push_back(at(side[i])[1]);
      }
    mesh_.grid.v = lines(v);
    mesh_.grid.z = lines(z);
  }

  static std::size_t corners_of(const SideNodes& side) { return side.size() % 3 == 0 ? 3 : 4; }

  // Quadrilaterals of one kind, one in each row of each layer?
  bool is_grid() {
    const std::size_t n = (mesh_.grid.v.size() - 1) * (mesh_.grid.z.size() - 1),
                      nodes = sides_.front().size();
    if (sides_.size() != n || nodes % 4 != 0) return false;
    for (const SideNodes& side : sides_)
      if (side.size() != nodes) return false;
    FlankGrid::Face none;
    none.fill(-1);
    mesh_.grid.face.assign(n, none);
    if (nodes == 8) mesh_.grid.v_mid.assign(mesh_.grid.v.size() - 1, 0);
    return true;
  }

  // Returns whether each place has its face.
  bool set_faces() {
    for (const SideNodes& side : sides_) {
      std::array<int, 4> row{}, layer{};
      for (std::size_t i = 0; i < 4; ++i) {
        row[i] = nearest(mesh_.grid.v, at(side[i])[0]);
        layer[i] = nearest(mesh_.grid.z, at(side[i])[1]);
      }
      const int r = *std::min_element(row.begin(), row.end());
      const int l = *std::min_element(layer.begin(), layer.end());
      const auto row_begin = static_cast<std::size_t>(r) * static_cast<std::size_t>(mesh_.grid.n_layers());
      if (row_begin + static_cast<std::size_t>(l) >= mesh_.grid.face.size()) return false;
      FlankGrid::Face& face = mesh_.grid.face[row_begin + static_cast<std::size_t>(l)];
      if (face[0] >= 0 || !set_in_order(side, row, layer, r, l, face)) return false;
      if (face[4] >= 0)
        mesh_.grid.v_mid[static_cast<std::size_t>(r)] = at(mesh_.node[static_cast<std::size_t>(face[4])])[0];
    }
    return true;
  }

  // Nodes of a side from the corner low-low to that high in v on; false where it is no rectangle of its rows
  // and layers.
  bool set_in_order(const SideNodes& side, const std::array<int, 4>& row, const std::array<int, 4>& layer,
                    int r, int l, FlankGrid::Face& face) const {
    constexpr std::array<std::array<int, 2>, 4> kCorners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    std::array<std::size_t, 4> order{};
    for (std::size_t c = 0; c < 4; ++c) {
      std::size_t i = 0;
      while (i < 4 && (row[i] != r + kCorners[c][0] || layer[i] != l + kCorners[c][1])) ++i;
      if (i == 4) return false;
      order[c] = i;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      face[i] = local(side[order[i]]);
      if (side.size() == 4) continue;
      const std::size_t a = order[i], b = order[(i + 1) % 4];
      face[4 + i] = local(side[4 + ((a + 1) % 4 == b ? a : b)]);  // midside node i stands behind corner i
    }
    return true;
  }

  void set_patches() {
    FlankGrid& grid = mesh_.grid;
    mesh_.node = by_number_;
    std::iota(place_.begin(), place_.end(), 0);
    grid.v = {grid.v.front(), grid.v.back()};
    grid.z = {grid.z.front(), grid.z.back()};
    grid.v_mid.clear();
    grid.face.clear();
    for (const SideNodes& side : sides_) {
      FlankPatch patch;
      for (int node : side) patch.node.push_back(local(node));
      for (std::size_t i = 0; i < 4; ++i)
        patch.at.col(static_cast<Eigen::Index>(i)) = at(side[std::min(i, corners_of(side) - 1)]);
      grid.patch.push_back(patch);
    }
  }

  FlankMesh& mesh_;
  std::vector<SideNodes> sides_;
  std::vector<int> by_number_;       // nodes of the surface, ascending
  std::vector<Eigen::Vector2d> at_;  // of each of them
  std::vector<int> place_;           // the same, row by row
};

bool has_same_grid(const FlankGrid& a, const FlankGrid& b) {
  const double near = kSameLine * (a.v.back() - a.v.front());
  const auto same = [near](const std::vector<double>& x, const std::vector<double>& y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                      [near](double x_i, double y_i) { return std::abs(x_i - y_i) <= near; });
  };
  return a.face == b.face && same(a.v, b.v) && same(a.z, b.z) && same(a.v_mid, b.v_mid);
}

// For each node of the first flank the one of the second in its place; empty when there is none.
std::vector<int> nodes_in_same_places(const FlankMesh& first, const FlankMesh& second) {
  const double near = kSamePlace * (first.grid.v.back() - first.grid.v.front());
  std::vector<int> there;
  if (first.place.size() != second.place.size()) return there;
  for (const Eigen::Vector2d& x : first.place) {
    const auto at = std::find_if(second.place.begin(), second.place.end(), [&](const Eigen::Vector2d& y) {
      return (x - y).cwiseAbs().maxCoeff() <= near;
    });
    if (at == second.place.end()) return {};
    there.push_back(static_cast<int>(at - second.place.begin()));
  }
  return there;
}

std::set<SideNodes> sorted_patches(const FlankMesh& mesh, const std::vector<int>& number) {
  std::set<SideNodes> all;
  for (const FlankPatch& patch : mesh.grid.patch) {
    SideNodes nodes;
    for (int node : patch.node) nodes.push_back(number[static_cast<std::size_t>(node)]);
    std::sort(nodes.begin(), nodes.end());
    all.insert(nodes);
  }
  return all;
}

// Puts the nodes of the second flank in the order of the first where both have the same patches.
bool takes_patches(const FlankMesh& first, FlankMesh& second) {
  const std::vector<int> there = nodes_in_same_places(first, second);
  if (there.empty()) return false;
  std::vector<int> own(there.size()), to_first(there.size(), -1);
  std::iota(own.begin(), own.end(), 0);
  for (std::size_t i = 0; i < there.size(); ++i)
    to_first[static_cast<std::size_t>(there[i])] = static_cast<int>(i);
  if (sorted_patches(first, own) != sorted_patches(second, to_first)) return false;
  FlankMesh ordered = second;
  for (std::size_t i = 0; i < there.size(); ++i)
    ordered.node[i] = second.node[static_cast<std::size_t>(there[i])];
  ordered.grid = first.grid;
  ordered.place = first.place;
  second = std::move(ordered);
  return true;
}

// Have both flanks the same rows and layers, or the same patches? Then they share their loads.
bool is_like(const FlankMesh& first, FlankMesh& second) {
  if (first.name.side != second.name.side || first.grid.patch.size() != second.grid.patch.size())
    return false;
  return first.grid.patch.empty() ? has_same_grid(first.grid, second.grid) : takes_patches(first, second);
}

void set_like(std::vector<FlankMesh>& meshes) {
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    meshes[i].like = static_cast<int>(i);
    for (std::size_t j = 0; j < i && meshes[i].like == static_cast<int>(i); ++j)
      if (meshes[j].like == static_cast<int>(j) && is_like(meshes[j], meshes[i]))
        meshes[i].like = static_cast<int>(j);
  }
}

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
    GridOfFlank(surface, flanks, mesh).build();
    for (int f : mesh.face) {
      Eigen::Matrix<double, 2, 4> corners;
      for (Eigen::Index i = 0; i < 4; ++i)
        corners.col(i) = flanks.chart(mesh.name, surface.X.col(surface.face(i, f)));
      mesh.at.push_back(corners);
    }
    meshes.push_back(std::move(mesh));
  }
  set_like(meshes);
  return meshes;
}

FaceOfFlank face_at(const FlankMesh& flank, double v, double z) {
  FaceOfFlank best{-1, 0, 0};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < flank.face.size(); ++f) {
    const PlaceOnSide on = place_on_side(flank.at[f], {v, z});
    if (!(on.beyond < least)) continue;
    least = on.beyond;
    const Eigen::Vector2d natural = natural_coordinates(on.corners, on.at[0], on.at[1]);
    best = {flank.face[f], std::clamp(natural[0], -1., 1.), std::clamp(natural[1], -1., 1.)};
  }
  return best;
}

}  // namespace elastogear::contact
