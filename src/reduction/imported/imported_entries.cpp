#include "reduction/imported/imported_entries.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <numeric>

#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"

namespace elastogear::reduction {
namespace {

constexpr std::size_t kPiece = 1 << 16;  // entries that travel together
constexpr double kSymmetry = 1e-9;       // of the largest entry: what rounded output may differ by

std::pair<int, int> place(const Entry& e) { return std::minmax(e.row, e.column); }

// The next checkpoint of the file, on all ranks; empty at the end.
std::vector<Entry> share_piece(MPI_Comm comm, const std::function<std::vector<Entry>()>& next, int rank) {
  std::vector<Entry> checkpoint;
  collectively(comm, [&] {
    if (rank == 0) checkpoint = next();
  });
  int size = static_cast<int>(checkpoint.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  checkpoint.resize(static_cast<std::size_t>(size));
  MPI_Bcast(checkpoint.data(), static_cast<int>(checkpoint.size() * sizeof(Entry)), MPI_BYTE, 0, comm);
  return checkpoint;
}

struct File {
  std::ifstream in;
  io::MatrixReader reader;

  File(const std::string& path, io::MatrixFormat format) : in(open_input(path)), reader(in, path, format) {}
};

// All entries of `path` whose smaller index this rank owns.
std::vector<Entry> read_own(MPI_Comm comm, const std::string& path, const LabelTable* labels,
                            const Range& range, io::MatrixFormat format) {
  std::unique_ptr<File> file;
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  collectively(comm, [&] {
    if (rank == 0) file = std::make_unique<File>(path, format);
  });
  const auto next = [&] {
    std::vector<Entry> checkpoint;
    for (const io::MatrixEntry& e : file->reader.read(kPiece))
      checkpoint.push_back({labels->dof(e.row, path), labels->dof(e.column, path), e.value});
    return checkpoint;
  };
  std::vector<Entry> own;
  for (;;) {
    const std::vector<Entry> checkpoint = share_piece(comm, next, rank);
    if (checkpoint.empty()) return own;
    for (const Entry& e : checkpoint)
      if (range.owns(std::min(e.row, e.column))) own.push_back(e);
  }
}

// Entries of the file for one place of the upper half: above the diagonal (or on it), below, or both.
struct Pair {
  Entry upper;
  double lower = 0;
  bool has_upper = false, has_lower = false;
};

std::vector<Pair> pair_up(std::vector<Entry> entries) {
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return place(a) < place(b); });
  std::vector<Pair> pairs;
  for (const Entry& e : entries) {
    const auto [row, column] = place(e);
    if (pairs.empty() || place(pairs.back().upper) != place(e)) pairs.push_back({{row, column, 0}});
    Pair& pair = pairs.back();
    (e.row > e.column ? pair.lower : pair.upper.value) += e.value;
    (e.row > e.column ? pair.has_lower : pair.has_upper) = true;
  }
  return pairs;
}

double largest(MPI_Comm comm, const std::vector<Pair>& pairs) {
  double own = 0, all = 0;
  for (const Pair& p : pairs) own = std::max({own, std::abs(p.upper.value), std::abs(p.lower)});
  MPI_Allreduce(&own, &all, 1, MPI_DOUBLE, MPI_MAX, comm);
  return all;
}

bool anywhere(MPI_Comm comm, bool own) {
  int mine = own, all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, comm);
  return all != 0;
}

}  // namespace

Range own_range(MPI_Comm comm, int n_nodes) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  MPI_Bcast(&n_nodes, 1, MPI_INT, 0, comm);
  const auto first = [&](int r) {
    return 3 * static_cast<int>(static_cast<std::int64_t>(n_nodes) * r / size);
  };
  return {first(rank), first(rank + 1), 3 * n_nodes};
}

LabelTable::LabelTable(const mesh::Mesh& mesh, const ImportedFiles& files)
    : number_(files.node_number), n_nodes_(mesh.n_nodes()), rows_source_(files.dofs) {
  if (number_.empty()) {
    number_.resize(static_cast<std::size_t>(n_nodes_));
    std::iota(number_.begin(), number_.end(), 1);
  }
  require(number_.size() == static_cast<std::size_t>(n_nodes_), "there are ", number_.size(),
          " node numbers for ", n_nodes_, " nodes");
  if (files.dofs.empty()) {
    dof_of_row_.resize(3 * number_.size());
    std::iota(dof_of_row_.begin(), dof_of_row_.end(), 0);
    return;
  }
  std::ifstream in = open_input(files.dofs);
  for (const io::MatrixLabel& label : io::read_dof_table(in, files.dofs))
    dof_of_row_.push_back(dof(label, files.dofs));
}

int LabelTable::node(std::int64_t number, const std::string& source) const {
  const auto found = std::lower_bound(number_.begin(), number_.end(), number);
  require(found != number_.end() && *found == number, source, ": node ", number, " is none of the ", n_nodes_,
          " nodes of the mesh or node table");
  return static_cast<int>(found - number_.begin());
}

int LabelTable::dof(const io::MatrixLabel& label, const std::string& source) const {
  if (label.direction > 0) return 3 * node(label.number, source) + label.direction - 1;
  require(label.number <= static_cast<std::int64_t>(dof_of_row_.size()), source, ": row ", label.number,
          " of ", dof_of_row_.size(),
          rows_source_.empty() ? " (three a node; option dofs names rows otherwise)" : " in ", rows_source_);
  return dof_of_row_[static_cast<std::size_t>(label.number - 1)];
}

std::string LabelTable::name(int dof) const {
  return io::text({number_[static_cast<std::size_t>(dof / 3)], dof % 3 + 1});
}

std::vector<Entry> read_upper_half(MPI_Comm comm, const std::string& path, const LabelTable* labels,
                                   const Range& range,
                                   const std::pair<io::MatrixFormat, double>& format_and_unit) {
  const auto& [format, unit] = format_and_unit;
  const std::vector<Pair> pairs = pair_up(read_own(comm, path, labels, range, format));
  const bool whole = anywhere(comm, std::any_of(pairs.begin(), pairs.end(),
                                                [](const Pair& p) { return p.has_upper && p.has_lower; }));
  const double tolerance = kSymmetry * largest(comm, pairs);
  std::vector<Entry> half;
  collectively(comm, [&] {
    for (const Pair& p : pairs) {
      const bool diagonal = p.upper.row == p.upper.column;
      require(!whole || diagonal || std::abs(p.upper.value - p.lower) <= tolerance, path,
              ": the matrix is not symmetric: displacements ", p.upper.row, " and ", p.upper.column,
              " (3 node + direction, from 0) have the entries ", p.upper.value, " and ", p.lower);
      half.push_back({p.upper.row, p.upper.column, unit * (p.has_upper ? p.upper.value : p.lower)});
    }
  });
  return half;
}

}  // namespace elastogear::reduction
