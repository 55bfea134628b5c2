#include "elastogear/fem/mesh_part.h"

#include <algorithm>
#include <numeric>

#include "elastogear/base/sort_unique.h"

namespace elastogear::fem {
namespace {

int rank_of_row(const RowNumbering& rows, int row) {
  return static_cast<int>(std::upper_bound(rows.row_begin.begin(), rows.row_begin.end(), row) -
                          rows.row_begin.begin()) -
         1;
}

// Per rank the cells that touch one of its nodes, ascending.
std::vector<std::vector<int>> cells_of_ranks(const mesh::Mesh& mesh, const RowNumbering& rows) {
  std::vector<std::vector<int>> cells(rows.row_begin.size() - 1);
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    for (int node : mesh.cells[cell]) {
      if (rows.row[node] < 0) continue;
      auto& mine = cells[rank_of_row(rows, rows.row[node])];
      if (mine.empty() || mine.back() != cell) mine.push_back(cell);
    }
  return cells;
}

MeshPart make_mesh_part(const mesh::Mesh& mesh, const std::vector<int>& region, const RowNumbering& rows,
                        const std::vector<int>& cells) {
  MeshPart part;
  std::vector<int> nodes;
  for (int cell : cells) nodes.insert(nodes.end(), mesh.cells[cell].begin(), mesh.cells[cell].end());
  sort_unique(nodes);
  std::vector<int> local;
  for (int cell : cells) {
    local.clear();
    for (int node : mesh.cells[cell])
      local.push_back(static_cast<int>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin()));
    part.mesh.cells.add(mesh.cells.type[cell], local);
    part.region.push_back(region[cell]);
  }
  part.mesh.X = mesh.X(Eigen::all, nodes);
  for (int node : nodes) part.row.push_back(rows.row[node]);
  return part;
}

constexpr int kTag = 1;

template <class T>
void send(MPI_Comm comm, int rank, const T* data, std::size_t size) {
  MPI_Send(data, static_cast<int>(size * sizeof(T)), MPI_BYTE, rank, kTag, comm);
}

template <class T>
std::vector<T> receive(MPI_Comm comm) {
  MPI_Status status;
  int bytes = 0;
  MPI_Probe(0, kTag, comm, &status);
  MPI_Get_count(&status, MPI_BYTE, &bytes);
  std::vector<T> data(static_cast<std::size_t>(bytes) / sizeof(T));
  MPI_Recv(data.data(), bytes, MPI_BYTE, 0, kTag, comm, MPI_STATUS_IGNORE);
  return data;
}

void send(MPI_Comm comm, int rank, const MeshPart& part) {
  send(comm, rank, part.mesh.X.data(), static_cast<std::size_t>(part.mesh.X.size()));
  send(comm, rank, part.mesh.cells.type.data(), part.mesh.cells.type.size());
  send(comm, rank, part.mesh.cells.offset.data(), part.mesh.cells.offset.size());
  send(comm, rank, part.mesh.cells.nodes.data(), part.mesh.cells.nodes.size());
  send(comm, rank, part.region.data(), part.region.size());
  send(comm, rank, part.row.data(), part.row.size());
}

MeshPart receive_mesh_part(MPI_Comm comm) {
  MeshPart part;
  const auto X = receive<double>(comm);
  part.mesh.X = Eigen::Map<const Eigen::Matrix3Xd>(X.data(), 3, static_cast<Eigen::Index>(X.size() / 3));
  part.mesh.cells.type = receive<mesh::CellType>(comm);
  part.mesh.cells.offset = receive<int>(comm);
  part.mesh.cells.nodes = receive<int>(comm);
  part.region = receive<int>(comm);
  part.row = receive<int>(comm);
  return part;
}

}  // namespace

RowNumbering number_rows(const mesh::Mesh& mesh, const std::vector<bool>& is_free,
                         const std::vector<int>& part, int n_ranks) {
  std::vector<int> owner(is_free.size(), -1);
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    for (int node : mesh.cells[cell])
      if (is_free[node] && owner[node] < 0) owner[node] = part[cell];
  RowNumbering rows{std::vector<int>(is_free.size(), -1), {}, std::vector<int>(n_ranks + std::size_t{1}, 0)};
  for (int rank : owner)
    if (rank >= 0) ++rows.row_begin[rank + std::size_t{1}];
  std::partial_sum(rows.row_begin.begin(), rows.row_begin.end(), rows.row_begin.begin());
  rows.node.resize(static_cast<std::size_t>(rows.row_begin.back()));
  std::vector<int> next = rows.row_begin;
  for (int node = 0; node < static_cast<int>(owner.size()); ++node)
    if (owner[node] >= 0) rows.node[rows.row[node] = next[owner[node]]++] = node;
  return rows;
}

MeshPart distribute(MPI_Comm comm, const mesh::Mesh& mesh, const std::vector<int>& region,
                    const RowNumbering& rows) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  std::vector<int> row_begin = rows.row_begin;
  row_begin.resize(size + std::size_t{1});
  MPI_Bcast(row_begin.data(), size + 1, MPI_INT, 0, comm);
  MeshPart part;
  if (rank == 0) {
    const auto cells = cells_of_ranks(mesh, rows);
    for (int other = 1; other < size; ++other)
      send(comm, other, make_mesh_part(mesh, region, rows, cells[other]));
    part = make_mesh_part(mesh, region, rows, cells[0]);
  } else {
    part = receive_mesh_part(comm);
  }
  part.row_begin = row_begin[rank];
  part.row_end = row_begin[rank + std::size_t{1}];
  return part;
}

}  // namespace elastogear::fem
