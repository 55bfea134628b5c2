// Block Lanczos in windows against SLEPc's Krylov-Schur, on the same matrices in the same run.
//
//   benchmark_eigenmodes -mesh worm.msh [-restrain seats] [-modes 500] [-window auto] [-slepc 100,200,400]
//   [-at 0,0.5,1] [-kernels | -hertz 50e3,60e3] [-known frequencies.txt]
//
// -kernels: only assembly, one factorisation and solves with it, the measurements of studies/cost_model.py.
// -hertz: only SLEPc, with shifts at these frequencies. -known: the lowest frequencies in Hz, ascending, from
// which the windows go on instead of from 0; -modes counts them too. Else first all modes by windows. Then
// SLEPc at some places of the spectrum (0: its lower end, 1: below the last mode): for each size one EPSSolve
// for so many modes, the shift in their middle, factorisation by MUMPS with its own ordering included. A
// whole walk up the spectrum costs about the mean of the seconds per mode.

#include <slepceps.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>

#include "elastogear/base/error.h"
#include "elastogear/fem/assembly.h"
#include "elastogear/fem/element.h"
#include "elastogear/fem/restraint.h"
#include "elastogear/mesh/file.h"
#include "elastogear/mesh/partition.h"
#include "elastogear/reduction/eigenmodes.h"
#include "reduction/eigensolver/factorisation.h"

namespace {

using namespace elastogear;
using UniqueEPS = Handle<EPS, EPSDestroy>;

const std::vector<model::MaterialRegion> kSteel{{"", {210e9, 0.3, 7850}}};

std::string text_option(const char* name, const std::string& fallback) {
  char text[1024] = "";
  PetscBool given = PETSC_FALSE;
  check(PetscOptionsGetString(nullptr, nullptr, name, text, sizeof text, &given));
  return given ? text : fallback;
}

std::vector<double> numbers(const std::string& text) {
  std::vector<double> values;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');) values.push_back(std::stod(word));
  return values;
}

struct Time {
  double wall = MPI_Wtime(), cpu = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
};

template <class... Arguments>
void print(const char* format, Arguments... arguments) {
  check(PetscPrintf(PETSC_COMM_WORLD, format, arguments...));
}

// Per mode, and in all; CPU time of rank 0.
void print_time(const std::string& what, const Time& start, int modes) {
  const Time end;
  print("%-44s %5d modes %9.2f s wall %9.2f s cpu %8.4f s wall/mode %8.4f s cpu/mode\n", what.c_str(), modes,
        end.wall - start.wall, end.cpu - start.cpu, (end.wall - start.wall) / modes,
        (end.cpu - start.cpu) / modes);
}

// CPU time: the most of any rank, which other jobs on the machine do not lengthen.
void print_span(const std::string& what, const Time& start) {
  const Time end;
  double cpu = end.cpu - start.cpu;
  check(MPI_Allreduce(MPI_IN_PLACE, &cpu, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD));
  print("%-44s %9.3f s wall %9.3f s cpu\n", what.c_str(), end.wall - start.wall, cpu);
}

// Cells at the border of two ranks are computed by both.
void print_cells(const fem::MeshPart& share, int n_cells) {
  const int own = share.mesh.cells.size();
  int most = 0, all = 0;
  check(MPI_Allreduce(&own, &most, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD));
  check(MPI_Allreduce(&own, &all, 1, MPI_INT, MPI_SUM, PETSC_COMM_WORLD));
  check(MPI_Bcast(&n_cells, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  print("%d cells, computed %d, the most by a rank %d: gain of assembly at most %.3f\n", n_cells, all, most,
        static_cast<double>(n_cells) / most);
}

fem::Matrices read_and_assemble() {
  int rank = 0, size = 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  mesh::Mesh mesh;
  std::vector<int> region;
  fem::RowNumbering rows;
  if (rank == 0) {
    mesh::ReadReport report;
    mesh = mesh::read_mesh(text_option("-mesh", ""), 1, &report);
    region = fem::cell_regions(mesh, kSteel);
    const auto is_free = fem::free_nodes(mesh, {text_option("-restrain", "seats")});
    rows = fem::number_rows(mesh, is_free, mesh::partition_cells(mesh, size).part, size);
  }
  const fem::MeshPart share = fem::distribute(PETSC_COMM_WORLD, mesh, region, rows);
  print_cells(share, mesh.cells.size());
  const Time start;
  fem::Matrices matrices = fem::assemble(PETSC_COMM_WORLD, share, kSteel, {});
  print_span("assembly", start);
  return matrices;
}

double peak_gigabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double kilobyte = 1024, gigabyte = 1e9;
  return usage.ru_maxrss * kilobyte / gigabyte;
}

void run_kernels(const fem::Matrices& matrices) {
  PetscInt n_own = 0;
  check(MatGetLocalSize(matrices.K, &n_own, nullptr));
  Time start;
  reduction::ShiftedFactor factor(matrices.K, matrices.M);
  print_span("analysis", start);
  print("factor: %.4e entries, %.4e flops\n", factor.size().entries, factor.size().flops);
  start = Time{};
  factor.factorise(0);
  print_span("factorisation", start);
  for (int block : {8, 16, 32}) {
    Eigen::MatrixXd X = Eigen::MatrixXd::Random(n_own, block);
    start = Time{};
    factor.solve(X);
    print_span("solve, columns " + std::to_string(block), start);
  }
  print("peak memory of rank 0 %.3f GB\n", peak_gigabytes());
}

// A search that has found these modes.
reduction::SearchState state_above(const std::string& file, int n_own) {
  std::ifstream in(file);
  const std::vector<double> f{std::istream_iterator<double>(in), {}};
  require(f.size() >= 2, file, ": no frequencies");
  reduction::SearchState state;
  const auto n = static_cast<Eigen::Index>(f.size()) - 1;  // the last shows the gap
  state.eigenvalue = (2 * M_PI * Eigen::Map<const Eigen::VectorXd>(f.data(), n)).array().square();
  state.residual = Eigen::VectorXd::Zero(n);
  state.edge.resize(n_own, 0);
  state.lower = state.shift = std::pow(M_PI * (f[f.size() - 2] + f.back()), 2);
  state.below_shift = static_cast<int>(n);
  return state;
}

Eigen::VectorXd run_windows(const fem::Matrices& matrices, int n_modes) {
  reduction::EigenOptions options;
  const std::string window = text_option("-window", "auto");
  options.n_modes = n_modes;
  options.window = window == "auto" ? reduction::kAutomaticWindow : std::stoi(window);
  options.block = std::stoi(text_option("-block", "0"));
  const std::string known = text_option("-known", "");
  PetscInt n_own = 0;
  check(MatGetLocalSize(matrices.K, &n_own, nullptr));
  if (!known.empty()) options.start = state_above(known, static_cast<int>(n_own));
  Time last;
  int before = static_cast<int>(options.start.eigenvalue.size()), blocks = 0;
  options.commit = [&](const reduction::SearchState& state) {
    const int now = static_cast<int>(state.eigenvalue.size());
    print_time("  window, blocks " + std::to_string(state.iterations - blocks), last, now - before);
    last = Time{};
    before = now;
    blocks = state.iterations;
  };
  const Time start;
  const auto modes = reduction::find_eigenmodes(matrices.K, matrices.M, options, [](int, Vec) {});
  print_time("block Lanczos in windows, all", start, n_modes);
  print("  largest residual %.2e, largest phi_i' M phi_j %.2e, peak memory of rank 0 %.2f GB\n",
        modes.residual.maxCoeff(), modes.orthogonality, peak_gigabytes());
  return modes.eigenvalue;
}

// `size` modes about sigma; `where` that is.
void run_slepc(const fem::Matrices& matrices, double sigma, int size, const std::string& where) {
  UniqueEPS eps;
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  const Time start;
  check(EPSCreate(PETSC_COMM_WORLD, eps.out()));
  check(EPSSetOperators(eps, matrices.K, matrices.M));
  check(EPSSetProblemType(eps, EPS_GHEP));
  check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  check(EPSSetTarget(eps, sigma));
  check(EPSSetDimensions(eps, size, PETSC_DEFAULT, PETSC_DEFAULT));
  check(EPSSetTolerances(eps, reduction::EigenOptions{}.tolerance, PETSC_DEFAULT));
  check(EPSSetPurify(eps, PETSC_FALSE));
  check(EPSGetST(eps, &st));
  check(STSetType(st, STSINVERT));
  check(STGetKSP(st, &ksp));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(EPSSetFromOptions(eps));
  check(EPSSolve(eps));
  PetscInt converged = 0;
  check(EPSGetConverged(eps, &converged));
  require(converged > 0, "Krylov-Schur found no mode about ", where);
  print_time("Krylov-Schur, " + std::to_string(size) + " modes about " + where, start,
             static_cast<int>(converged));
}

// `size` modes from number `first` on.
void run_slepc_among(const fem::Matrices& matrices, const Eigen::VectorXd& lambda, int first, int size) {
  const int middle = first == 0 ? 0 : first + size / 2;
  const double sigma = middle == 0 ? 0 : (lambda(middle - 1) + lambda(middle)) / 2;
  run_slepc(matrices, sigma, size, "number " + std::to_string(middle));
}

std::vector<double> sizes() { return numbers(text_option("-slepc", "100,200,400")); }

void run_slepc_at(const fem::Matrices& matrices, const std::string& frequencies) {
  for (double f : numbers(frequencies))
    for (double size : sizes())
      run_slepc(matrices, std::pow(2 * M_PI * f, 2), static_cast<int>(size), std::to_string(f) + " Hz");
}

void allow_indefinite(Mat K) {
  check(MatSetOption(K, MAT_SPD, PETSC_FALSE));
  check(MatSetOption(K, MAT_SYMMETRIC, PETSC_TRUE));
}

void run() {
  const int n_modes = std::stoi(text_option("-modes", "500"));
  const fem::Matrices matrices = read_and_assemble();
  PetscInt n = 0;
  check(MatGetSize(matrices.K, &n, nullptr));
  PetscBool kernels = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, nullptr, "-kernels", &kernels));
  print("%d free degrees of freedom, %d modes\n", static_cast<int>(n), kernels ? 0 : n_modes);
  if (kernels) return run_kernels(matrices);
  const std::string frequencies = text_option("-hertz", "");
  allow_indefinite(matrices.K);
  if (!frequencies.empty()) return run_slepc_at(matrices, frequencies);
  const Eigen::VectorXd lambda = run_windows(matrices, n_modes);
  for (double place : numbers(text_option("-at", "0,0.5,1")))
    for (double size : sizes()) {
      if (size > n_modes) continue;
      const int first = static_cast<int>(place * (static_cast<double>(lambda.size()) - size));
      run_slepc_among(matrices, lambda, first, static_cast<int>(size));
    }
}

}  // namespace

int main(int argc, char** argv) {
  const Session session(argc, argv);
  try {
    run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
