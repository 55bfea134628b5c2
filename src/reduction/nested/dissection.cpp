#include "reduction/nested/dissection.h"

#include <metis.h>

#include <algorithm>
#include <array>
#include <utility>

#include "elastogear/base/error.h"
#include "elastogear/base/sort_unique.h"

namespace elastogear::reduction {
namespace {

static_assert(sizeof(idx_t) == sizeof(int), "METIS must be built with 32-bit indices");
constexpr idx_t kDissectionSeed = 1;

// Rows with entries in the same columns that follow each other, as those of one node do, are one vertex.
struct Vertices {
  std::vector<int> first{0};  // row of each vertex, then their number
  std::vector<std::vector<int>> neighbour;
};

Vertices find_vertices(Mat A, const std::vector<char>& is_kept) {
  PetscInt n_rows = 0;
  check(MatGetSize(A, &n_rows, nullptr));
  Vertices vertices;
  std::vector<int> vertex(static_cast<std::size_t>(n_rows)), before;
  for (PetscInt i = 0; i < n_rows; ++i) {
    PetscInt n = 0;
    const PetscInt* column = nullptr;
    check(MatGetRow(A, i, &n, &column, nullptr));
    if (i == 0 || is_kept[i] != is_kept[i - 1] ||
        !std::equal(column, column + n, before.begin(), before.end())) {
      before.assign(column, column + n);
      if (i > 0) vertices.first.push_back(i);
      vertices.neighbour.push_back(before);
    }
    vertex[i] = static_cast<int>(vertices.neighbour.size()) - 1;
    check(MatRestoreRow(A, i, &n, &column, nullptr));
  }
  if (n_rows > 0) vertices.first.push_back(n_rows);
  for (std::size_t v = 0; v < vertices.neighbour.size(); ++v) {
    std::vector<int>& near = vertices.neighbour[v];
    for (int& column : near) column = vertex[column];
    sort_unique(near);
    std::erase(near, static_cast<int>(v));
  }
  return vertices;
}

class Dissection {
 public:
  Dissection(Mat A, int largest_leaf, const std::vector<char>& is_kept)
      : vertices_(find_vertices(A, is_kept)),
        largest_leaf_(largest_leaf),
        local_(vertices_.neighbour.size(), -1) {
    for (std::size_t v = 0; v < vertices_.neighbour.size(); ++v)
      if (!is_kept[vertices_.first[v]]) all_.push_back(static_cast<int>(v));
  }

  std::vector<Part> parts() {
    add(all_);
    return std::move(parts_);
  }

 private:
  // Adds the parts of these vertices; returns the last one.
  int add(const std::vector<int>& of) {
    Part part;
    for (int v : of)
      for (int row = vertices_.first[v]; row < vertices_.first[v + std::size_t{1}]; ++row)
        part.row.push_back(row);
    if (static_cast<int>(part.row.size()) > largest_leaf_) {
      const auto [left, right, separator] = separate(of);
      if (!left.empty() && !right.empty()) {
        part.left = add(left);
        part.right = add(right);
        part.row.clear();
        for (int v : separator)
          for (int row = vertices_.first[v]; row < vertices_.first[v + std::size_t{1}]; ++row)
            part.row.push_back(row);
      }
    }
    parts_.push_back(std::move(part));
    return static_cast<int>(parts_.size()) - 1;
  }

  std::array<std::vector<int>, 3> separate(const std::vector<int>& of) {
    std::vector<idx_t> offset{0}, neighbour, weight, side(of.size());
    for (std::size_t i = 0; i < of.size(); ++i) local_[of[i]] = static_cast<int>(i);
    for (int v : of) {
      for (int w : vertices_.neighbour[v])
        if (local_[w] >= 0) neighbour.push_back(local_[w]);
      offset.push_back(static_cast<idx_t>(neighbour.size()));
      weight.push_back(vertices_.first[v + std::size_t{1}] - vertices_.first[v]);
    }
    for (int v : of) local_[v] = -1;
    idx_t n = static_cast<idx_t>(of.size()), separator_size = 0, options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = kDissectionSeed;
    const int status = METIS_ComputeVertexSeparator(&n, offset.data(), neighbour.data(), weight.data(),
                                                    options, &separator_size, side.data());
    require(status == METIS_OK, "METIS could not separate ", n, " rows (status ", status, ")");
    std::array<std::vector<int>, 3> result;
    for (std::size_t i = 0; i < of.size(); ++i) result[static_cast<std::size_t>(side[i])].push_back(of[i]);
    return result;
  }

  Vertices vertices_;
  std::vector<int> all_ = {};  // that are not kept
  int largest_leaf_;
  std::vector<int> local_;
  std::vector<Part> parts_;
};

}  // namespace

std::vector<Part> dissect(Mat A, int largest_leaf, const std::vector<int>& kept) {
  PetscInt n_rows = 0;
  check(MatGetSize(A, &n_rows, nullptr));
  std::vector<char> is_kept(static_cast<std::size_t>(n_rows), 0);
  for (int row : kept) is_kept[row] = 1;
  return Dissection(A, largest_leaf, is_kept).parts();
}

}  // namespace elastogear::reduction
