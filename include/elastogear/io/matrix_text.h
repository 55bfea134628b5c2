#pragma once
// Matrices of other programs as text, entry by entry (docs/file_format.md, section Matrices). What is
// kept grows with what was read, never with what a file announces.

#include <Eigen/Core>
#include <cstdint>
#include <istream>
#include <string>
#include <vector>

#include "elastogear/io/delimited_reader.h"

namespace elastogear::io {

/// abaqus: "node, direction, node, direction, value"; calculix, triplets: "row column value", the latter also
/// with the banner of Matrix Market; automatic: by the first line.
enum class MatrixFormat { automatic, abaqus, calculix, triplets };

/// How a file names a displacement: node number and direction 1..3, or a row number from 1 and direction 0.
struct MatrixLabel {
  std::int64_t number = 0;
  int direction = 0;

  bool operator==(const MatrixLabel&) const = default;
};
/// "node 7, direction 2" or "row 12"
std::string text(const MatrixLabel& label);

struct MatrixEntry {
  MatrixLabel row, column;
  double value = 0;
};

/// Reads a matrix in pieces. Throws Error naming source and line for anything that is not one: other field
/// counts, numbers that are not finite, directions other than 1..3, rows outside a banner's size, fewer
/// entries than a banner announces.
class MatrixReader {
 public:
  MatrixReader(std::istream& in, std::string source, MatrixFormat format = MatrixFormat::automatic);
  /// The next entries, at most `most`; none at the end.
  std::vector<MatrixEntry> read(std::size_t most);

 private:
  bool next(std::string_view comment);
  bool start();
  void read_banner();
  void read_size();
  MatrixEntry entry() const;

  DelimitedReader lines_;
  MatrixFormat format_;
  bool first_ = true, banner_ = false;
  std::int64_t size_ = 0, announced_ = 0, found_ = 0;  // of the banner
};

struct NodeTable {
  std::vector<std::int64_t> number;  ///< ascending
  Eigen::Matrix3Xd X;                ///< 3 x n, in the file's unit
};

/// Lines "number x y z". Lines that begin with #, * or % are comments. Throws Error for repeated numbers and
/// an empty table.
NodeTable read_node_table(std::istream& in, const std::string& source);

/// Line i names the displacement of row i: "node.direction" (CalculiX' .dof) or "node direction". Throws
/// Error for repeated displacements and an empty table.
std::vector<MatrixLabel> read_dof_table(std::istream& in, const std::string& source);

}  // namespace elastogear::io
