#include "elastogear/reduction/imported.h"

#include <petscksp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <set>

#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "reduction/imported/imported_entries.h"

namespace elastogear::reduction {
namespace {

constexpr double kHeld =
    1e36;  // what Abaqus adds to the diagonal of a displacement with a boundary condition
constexpr double kRounded = 1e-8;                             // relative, of sums over rounded output
constexpr char kHasStiffness = 1, kHasMass = 2, kIsHeld = 4;  // flags of a displacement

void flag_diagonals(const std::vector<Entry>& half, char flag, double unit, std::vector<char>& flags) {
  for (const Entry& e : half)
    if (e.row == e.column && e.value > 0) flags[e.row] |= flag | (e.value >= kHeld * unit ? kIsHeld : 0);
}

// Flags of all displacements, on all ranks.
std::vector<char> find_flags(MPI_Comm comm, const std::vector<Entry>& K, const std::vector<Entry>& M,
                             std::pair<double, int> unit_and_size) {
  std::vector<char> own(static_cast<std::size_t>(unit_and_size.second), 0), all(own.size());
  flag_diagonals(K, kHasStiffness, unit_and_size.first, own);
  flag_diagonals(M, kHasMass, std::numeric_limits<double>::infinity(), own);
  MPI_Allreduce(own.data(), all.data(), static_cast<int>(own.size()), MPI_BYTE, MPI_BOR, comm);
  return all;
}

bool is_active(char flags) { return flags == (kHasStiffness | kHasMass); }

void require_matching(const std::vector<char>& flags, const LabelTable& labels, const ImportedFiles& files) {
  for (std::size_t dof = 0; dof < flags.size(); ++dof) {
    if (flags[dof] == 0 || (flags[dof] & kIsHeld)) continue;
    require(is_active(flags[dof]), flags[dof] & kHasStiffness ? files.mass : files.stiffness, ": ",
            labels.name(static_cast<int>(dof)), " has no positive entry on the diagonal, but one in ",
            flags[dof] & kHasStiffness ? files.stiffness : files.mass, " (is the file complete?)");
  }
}

// Off-diagonal entries of displacements that have no row must belong to held ones.
void require_rows(const std::vector<Entry>& half, const std::vector<char>& flags, const std::string& path) {
  for (const Entry& e : half)
    for (int dof : {e.row, e.column})
      require(is_active(flags[dof]) || (flags[dof] & kIsHeld) || e.value == 0, path, ": displacement ", dof,
              " (3 node + direction, from 0) has entries but no positive one on the diagonal");
}

// Rows of the active displacements, ascending; -1 for others.
std::vector<int> number_active(const std::vector<char>& flags) {
  std::vector<int> row;
  int next = 0;
  for (char f : flags) row.push_back(is_active(f) ? next++ : -1);
  return row;
}

// Places of both matrices, and the values of one of them there.
struct Coordinates {
  std::vector<PetscInt> i, j;
  std::vector<double> value[2];

  void add(PetscInt row, PetscInt column, int matrix, double a) {
    i.push_back(row);
    j.push_back(column);
    value[matrix].push_back(a);
    value[1 - matrix].push_back(0);
  }
};

void add(Coordinates& coordinates, const std::vector<Entry>& half, const std::vector<int>& row, int matrix) {
  for (const Entry& e : half) {
    const int i = row[e.row], j = row[e.column];
    if (i < 0 || j < 0) continue;
    coordinates.add(i, j, matrix, e.value);
    if (i != j) coordinates.add(j, i, matrix, e.value);
  }
}

UniqueMat create(MPI_Comm comm, PetscInt n_own, const Coordinates& coordinates, int matrix) {
  UniqueMat A;
  std::vector<PetscInt> i = coordinates.i, j = coordinates.j;  // PETSc may change its arguments
  check(MatCreate(comm, A.out()));
  check(MatSetSizes(A, n_own, n_own, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetType(A, MATAIJ));
  check(MatSetPreallocationCOO(A, static_cast<PetscCount>(i.size()), i.data(), j.data()));
  check(MatSetValuesCOO(A, coordinates.value[matrix].data(), INSERT_VALUES));
  check(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  return A;
}

int count_rows(const std::vector<int>& row, int begin, int end) {
  return static_cast<int>(
      std::count_if(row.begin() + begin, row.begin() + end, [](int r) { return r >= 0; }));
}

std::vector<int> dofs_of(const std::vector<int>& row) {
  std::vector<int> dof;
  for (int i = 0; i < static_cast<int>(row.size()); ++i)
    if (row[i] >= 0) dof.push_back(i);
  return dof;
}

// Returns for every node the directions that have rows, one bit each.
std::vector<unsigned> find_directions(const std::vector<int>& dof, int n_nodes) {
  std::vector<unsigned> directions(static_cast<std::size_t>(n_nodes), 0);
  for (int i : dof) directions[i / 3] |= 1U << (i % 3);
  return directions;
}

// Two nodes that move in no common direction may share a mass that no entry of M shows.
void require_common_directions(const std::vector<unsigned>& directions) {
  const std::set<unsigned> kinds(directions.begin(), directions.end());
  for (unsigned a : kinds)
    for (unsigned b : kinds)
      require(a == 0 || b == 0 || (a & b) != 0,
              "full invariants need a mass matrix in which all nodes share a direction: export it before "
              "nodes are held in single directions, and hold them here (option restrain)");
}

// Entries of M between equal directions, as n_nodes x n_nodes each. Those between different ones must vanish.
std::array<model::SparseRows, 3> split_directions(const Eigen::SparseMatrix<double>& M,
                                                  const std::vector<int>& dof, int n_nodes) {
  std::array<std::vector<Eigen::Triplet<double>>, 3> entries;
  double largest = 0, coupling = 0;
  for (int j = 0; j < M.outerSize(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator it(M, j); it; ++it) {
      const int row = dof[it.row()], column = dof[j];
      const bool equal = row % 3 == column % 3;
      (equal ? largest : coupling) = std::max(equal ? largest : coupling, std::abs(it.value()));
      if (equal && it.value() != 0) entries[row % 3].emplace_back(row / 3, column / 3, it.value());
    }
  require(coupling <= kRounded * largest, "the mass matrix couples different directions (an entry ", coupling,
          " beside ", largest, "): only solid elements in one coordinate system are supported");
  std::array<model::SparseRows, 3> parts;
  for (int d = 0; d < 3; ++d) {
    parts[d].resize(n_nodes, n_nodes);
    parts[d].setFromTriplets(entries[d].begin(), entries[d].end());
  }
  return parts;
}

// Returns for each pair of nodes the mean of the entries over the directions that both nodes have. Throws
// Error unless these entries agree.
model::SparseRows mean_of(const std::array<model::SparseRows, 3>& parts,
                          const std::vector<unsigned>& directions) {
  model::SparseRows mean = parts[0] + parts[1] + parts[2];
  const double largest = mean.nonZeros() > 0 ? mean.coeffs().cwiseAbs().maxCoeff() : 0;
  for (int row = 0; row < mean.outerSize(); ++row)
    for (model::SparseRows::InnerIterator it(mean, row); it; ++it) {
      const unsigned both = directions[row] & directions[it.col()];
      it.valueRef() /= std::popcount(both);
      for (int d = 0; d < 3; ++d) {
        if ((both >> d & 1U) == 0) continue;
        const double entry = parts[d].coeff(row, it.col());
        require(std::abs(entry - it.value()) <= kRounded * largest,
                "the mass matrix does not move all directions alike (an entry ", entry, " in direction ",
                d + 1, ", ", it.value(), " on average): only solid elements in one coordinate system are ",
                "supported");
      }
    }
  return mean;
}

// M u gathered on rank 0, as three rows of directions.
Eigen::Matrix3Xd momentum(Mat M, const fem::VectorGather& gather, const Eigen::VectorXd& u,
                          const std::pair<Vec, Vec>& work) {
  gather.scatter(u, work.first);
  check(MatMult(M, work.first, work.second));
  const Eigen::VectorXd p = gather(work.second);
  return Eigen::Map<const Eigen::Matrix3Xd>(p.data(), 3, p.size() / 3);
}

// The scalar field `w` (one number a node) moved in direction d, and what M makes of it: three equal results,
// each in its own direction only.
Eigen::VectorXd scalar_momentum(Mat M, const fem::VectorGather& gather, const Eigen::VectorXd& w,
                                const std::pair<Vec, Vec>& work) {
  Eigen::VectorXd result;
  for (int d = 0; d < 3; ++d) {
    Eigen::Matrix3Xd u = Eigen::Matrix3Xd::Zero(3, w.size());
    u.row(d) = w;
    const Eigen::Matrix3Xd p = momentum(M, gather, u.reshaped(), work);
    collectively(comm_of(M), [&] {
      if (p.cols() == 0) return;
      const double size = p.row(d).cwiseAbs().maxCoeff();
      if (d == 0) result = p.row(0);
      Eigen::Matrix3Xd rest = p;
      rest.row(d) -= result.transpose();
      require(rest.cwiseAbs().maxCoeff() <= kRounded * size,
              "the mass matrix does not move all directions alike ", "(largest difference ",
              rest.cwiseAbs().maxCoeff(), " of ", size,
              "): only solid elements in one coordinate system are supported");
    });
  }
  return result;
}

}  // namespace

ImportedSystem read_imported(MPI_Comm comm, const mesh::Mesh& mesh, const ImportedFiles& files,
                             const Progress& progress) {
  int rank = 0;
  std::unique_ptr<LabelTable> labels;
  MPI_Comm_rank(comm, &rank);
  collectively(comm, [&] {
    if (rank == 0) labels = std::make_unique<LabelTable>(mesh, files);
  });
  const Range range = own_range(comm, mesh.n_nodes());
  report(progress, "reading matrices", 0);
  const auto K =
      read_upper_half(comm, files.stiffness, labels.get(), range, {files.format, files.stiffness_unit});
  report(progress, "reading matrices", 0.5);
  const auto M = read_upper_half(comm, files.mass, labels.get(), range, {files.format, files.mass_unit});
  report(progress, "reading matrices", 1);
  const std::vector<char> flags = find_flags(comm, K, M, {files.stiffness_unit, range.n});
  collectively(comm, [&] {
    if (rank == 0) require_matching(flags, *labels, files);
    require_rows(K, flags, files.stiffness);
    require_rows(M, flags, files.mass);
  });
  const std::vector<int> row = number_active(flags);
  Coordinates coordinates;
  add(coordinates, K, row, 0);
  add(coordinates, M, row, 1);
  const int n_own = count_rows(row, range.begin, range.end);
  ImportedSystem system{{create(comm, n_own, coordinates, 0), create(comm, n_own, coordinates, 1)}, {}};
  if (rank == 0) system.dof = dofs_of(row);
  return system;
}

bool is_complete(const mesh::Mesh& mesh, const std::vector<int>& dof) {
  std::vector<bool> needed(static_cast<std::size_t>(mesh.n_nodes()), mesh.cells.size() == 0);
  for (int node : mesh.cells.nodes) needed[node] = true;
  std::vector<int> count(needed.size(), 0);
  for (int i : dof) ++count[i / 3];
  for (std::size_t node = 0; node < needed.size(); ++node)
    if (needed[node] && count[node] < 3) return false;
  return true;
}

fem::MassMoments mass_moments(Mat M, const fem::VectorGather& gather, const mesh::Mesh& mesh) {
  UniqueVec u, p;
  check(MatCreateVecs(M, u.out(), p.out()));
  const std::pair<Vec, Vec> work{u, p};
  fem::MassMoments moments;
  moments.w_0 = scalar_momentum(M, gather, Eigen::VectorXd::Ones(mesh.n_nodes()), work);
  moments.w_1.resize(3, moments.w_0.size());
  for (int a = 0; a < 3; ++a) {
    const Eigen::VectorXd w_1 = scalar_momentum(M, gather, mesh.X.row(a).transpose(), work);
    if (w_1.size() > 0) moments.w_1.row(a) = w_1;
  }
  return moments;
}

model::SparseRows scalar_mass(const ImportedSystem& system, int n_nodes) {
  const Mat M = system.matrices.M;
  const Eigen::SparseMatrix<double> all = fem::gather_matrix(M, system.dof);
  model::SparseRows M_s;
  collectively(comm_of(M), [&] {
    int rank = 0;
    MPI_Comm_rank(comm_of(M), &rank);
    if (rank != 0) return;
    const std::vector<unsigned> directions = find_directions(system.dof, n_nodes);
    require_common_directions(directions);
    M_s = mean_of(split_directions(all, system.dof, n_nodes), directions);
  });
  return M_s;
}

void require_positive(Mat A, const std::string& what) {
  constexpr int kSteps = 300;
  UniqueKSP ksp;
  UniqueVec b, x;
  PC pc = nullptr;
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(MatCreateVecs(A, x.out(), b.out()));
  check(VecSetRandom(b, nullptr));
  check(KSPCreate(comm_of(A), ksp.out()));
  check(KSPSetOperators(ksp, A, A));
  check(KSPSetType(ksp, KSPCG));
  check(KSPSetTolerances(ksp, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, kSteps));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCJACOBI));
  check(KSPSolve(ksp, b, x));
  check(KSPGetConvergedReason(ksp, &reason));
  require(reason > 0 || reason == KSP_DIVERGED_ITS, what, ": the matrix is not positive definite");
}

}  // namespace elastogear::reduction
