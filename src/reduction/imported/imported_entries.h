#pragma once
// Entries of one imported matrix on their way from a file to the ranks.

#include <mpi.h>

#include <string>
#include <vector>

#include "elastogear/base/progress.h"
#include "elastogear/mesh/mesh.h"
#include "elastogear/reduction/imported.h"

namespace elastogear::reduction {

/// row, column: displacements 3 node + direction.
struct Entry {
  int row = 0, column = 0;
  double value = 0;
};

/// Displacements of this rank: begin <= dof < end, of n in all.
struct Range {
  int begin = 0, end = 0, n = 0;
  bool owns(int dof) const { return dof >= begin && dof < end; }
};
Range own_range(MPI_Comm comm, int n_nodes);

/// From labels in a file to displacements. Used on rank 0.
class LabelTable {
 public:
  LabelTable(const mesh::Mesh& mesh, const ImportedFiles& files);
  /// Error naming `source` for labels that no node or row has.
  int dof(const io::MatrixLabel& label, const std::string& source) const;
  /// "node 7, direction 2"
  std::string name(int dof) const;

 private:
  int node(std::int64_t number, const std::string& source) const;

  std::vector<std::int64_t> number_;
  int n_nodes_;
  std::vector<int> dof_of_row_;
  std::string rows_source_;
};

/// The upper half (row <= column) of the symmetric matrix in `path`, times `unit`, of the rows this rank
/// owns, sorted, each place once. labels: on rank 0, else null. Collective. Errors as read_imported.
std::vector<Entry> read_upper_half(MPI_Comm comm, const std::string& path, const LabelTable* labels,
                                   const Range& range,
                                   const std::pair<io::MatrixFormat, double>& format_and_unit);

}  // namespace elastogear::reduction
