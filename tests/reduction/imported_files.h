#pragma once
// Matrices of the test's block, written as other programs would write them, and the bodies they give.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <random>

#include "../fem/other_cells.h"
#include "../fem/system.h"
#include "elastogear/io/body_file.h"
#include "elastogear/reduction/imported.h"
#include "elastogear/reduction/reduce.h"

namespace elastogear::test {

inline int rank_of_world() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}
inline bool is_root() { return rank_of_world() == 0; }

// A path of this test, another one for each number of ranks.
inline std::string path_of(const std::string& name) {
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return std::filesystem::temp_directory_path() / ("imported_" + std::to_string(size) + "_" + name);
}

inline mesh::Mesh block() { return distorted(brick({4, 3, 2}, {1, 0.5, 0.3}), 0.02); }

// A matrix with the displacement of each row: dof[i] = 3 node + direction.
struct Labelled {
  Eigen::SparseMatrix<double> A;
  std::vector<int> dof;
};

struct Writer {
  std::ofstream out;

  explicit Writer(const std::string& path) : out(path) { out << std::scientific << std::setprecision(16); }
};

enum class Half { lower, upper, both };

inline bool in_half(Half half, int i, int j) {
  return half == Half::both || (half == Half::lower ? i >= j : i <= j);
}

// "row column value", rows from 1.
inline void write_triplets(const std::string& path, const Labelled& m, Half half) {
  Writer file(path);
  for (int j = 0; j < m.A.cols(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator e(m.A, j); e; ++e)
      if (in_half(half, static_cast<int>(e.row()), j))
        file.out << e.row() + 1 << " " << j + 1 << " " << e.value() << "\n";
}

inline void write_matrix_market(const std::string& path, const Labelled& m) {
  Writer file(path);
  file.out << "%%MatrixMarket matrix coordinate real general\n"
           << m.A.rows() << " " << m.A.cols() << " " << m.A.nonZeros() << "\n";
  for (int j = 0; j < m.A.cols(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator e(m.A, j); e; ++e)
      file.out << e.row() + 1 << " " << j + 1 << " " << e.value() << "\n";
}

inline void write_dofs(const std::string& path, const std::vector<int>& dof) {
  Writer file(path);
  for (int i : dof) file.out << i / 3 + 1 << "." << i % 3 + 1 << "\n";
}

// The data lines of *MATRIX INPUT, which *MATRIX OUTPUT, FORMAT=MATRIX INPUT writes: row node number, degree
// of freedom, column node number, degree of freedom, entry; one half of a symmetric matrix (Abaqus Keywords
// Reference Guide, *MATRIX INPUT). Nodes are numbered 10, 20, ...; lines in any order.
inline void write_abaqus(const std::string& path, const Labelled& m, double unit) {
  std::vector<std::string> lines;
  for (int j = 0; j < m.A.cols(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator e(m.A, j); e; ++e) {
      if (e.row() > j) continue;
      const int row = m.dof[e.row()], column = m.dof[j];
      std::ostringstream line;
      line << std::scientific << std::setprecision(16) << 10 * (row / 3 + 1) << "," << row % 3 + 1 << ", "
           << 10 * (column / 3 + 1) << "," << column % 3 + 1 << ", " << e.value() / unit;
      lines.push_back(line.str());
    }
  std::shuffle(lines.begin(), lines.end(), std::mt19937(3));
  Writer file(path);
  for (const auto& line : lines) file.out << line << "\n";
}

struct Files {
  Labelled K, M;
  reduction::ImportedFiles imported;
};

// K and M of the mesh without the rows of the held sets, as files.
inline Files our_matrices(const mesh::Mesh& mesh, const std::vector<std::string>& held) {
  const auto system = assemble(mesh, held, PETSC_COMM_SELF);
  const auto dof = fem::free_dofs(fem::held_directions(mesh, held));
  return {{fem::gather_matrix(system.matrices.K, system.rows), dof},
          {fem::gather_matrix(system.matrices.M, system.rows), dof},
          {path_of("k.txt"), path_of("m.txt")}};
}

inline reduction::ImportedSystem read(const mesh::Mesh& mesh, const reduction::ImportedFiles& files) {
  MPI_Barrier(PETSC_COMM_WORLD);
  return reduction::read_imported(PETSC_COMM_WORLD, is_root() ? mesh : mesh::Mesh{}, files);
}

inline reduction::ReductionOptions options_of_block() {
  reduction::ReductionOptions options;
  options.name = "block";
  options.regions = kSteelBody;
  options.restrain = {"xmin"};
  options.surface = {"zmax"};
  options.stress_nodes = {"xmax"};
  options.n_modes = 12;
  return options;
}

// The body that `options` give, on rank 0.
inline model::ElasticBody reduced(const mesh::Mesh& mesh, const reduction::ReductionOptions& options,
                                  const std::string& name) {
  MPI_Barrier(PETSC_COMM_WORLD);
  const std::string path = path_of(name + ".h5");
  reduction::reduce(PETSC_COMM_WORLD, is_root() ? mesh : mesh::Mesh{}, options, path);
  return is_root() ? io::read_body(path) : model::ElasticBody{};
}

}  // namespace elastogear::test
