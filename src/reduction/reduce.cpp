#include "elastogear/reduction/reduce.h"

#include <algorithm>

#include "elastogear/fem/elimination.h"
#include "elastogear/fem/gather.h"
#include "elastogear/fem/restraint.h"
#include "reduction/basis.h"
#include "reduction/job/reduce_job.h"
#include "reduction/job/second_moments.h"

namespace elastogear::reduction {
namespace {

void keep_all(Job& job) {
  Plan& plan = job.plan;
  const fem::Matrices matrices = assemble(job);
  job.begin_stage("gathering");
  const auto K = fem::gather_matrix(matrices.K, plan.dof), M = fem::gather_matrix(matrices.M, plan.dof);
  job.on_root([&] {
    set_full_basis(plan.body, plan.free_dof, plan.moments, plan.S);
    plan.body.K_r = K;
    plan.body.M_r = M;
    if (job.options.invariants == Invariants::full)
      plan.body.inertia.S_2 = unit_second_moments(field_mass(job), plan.free_dof);
    set_relaxing_full(job);
  });
  job.begin_stage("writing");
  job.on_root([&] {
    model::validate(plan.body, job.output);
    io::BodyWriter(job.output, job.mesh.n_nodes(), 0).finish(plan.body, source_of(job));
  });
}

void fill_report(Job& job) {
  const model::Inertia& inertia = job.plan.body.inertia;
  const Eigen::Vector3d c = inertia.c;
  ReductionReport& report = job.report;
  report.m = inertia.m;
  report.c = c;
  report.J = inertia.J - inertia.m * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  report.n_nodes = job.mesh.n_nodes();
  report.n_cells = job.mesh.cells.size();
  report.n_dofs = 3 * report.n_nodes;
  report.n_free = static_cast<int>(job.plan.free_dof.size());
  report.n_ranks = job.size;
  report.edge_cut = job.plan.partition.edge_cut;
  if (job.options.imported) return;
  std::vector<int> cells(static_cast<std::size_t>(job.size), 0);
  for (int part : job.plan.partition.part) ++cells[part];
  if (!job.modes_by_sectors())
    report.balance =
        *std::max_element(cells.begin(), cells.end()) * static_cast<double>(job.size) / report.n_cells;
}

fem::Matrices assemble_cells(Job& job) {
  Plan& plan = job.plan;
  job.begin_stage("partition");
  job.on_root([&] {
    plan.partition = mesh::partition_cells(job.mesh, job.size);
    plan.rows = fem::number_rows(job.mesh, plan.is_free, plan.partition.part, job.size);
    plan.dof = fem::row_dofs(plan.rows);
  });
  const fem::MeshPart share = fem::distribute(job.comm, job.mesh, plan.region, plan.rows);
  job.begin_stage("assembly");
  fem::Matrices matrices = fem::assemble(job.comm, share, job.regions, formulation(job), job.progress);
  int single = job.rank == 0 && mesh::has_single_directions(plan.held);
  MPI_Bcast(&single, 1, MPI_INT, 0, job.comm);
  if (single) fem::eliminate(plan.held, matrices, plan.dof);
  return matrices;
}

// Adds the point masses, which are few, to the diagonal of M from rank 0.
void add_point_masses(Job& job, Mat M) {
  if (job.options.point_mass.empty()) return;
  check(MatSetOption(M, MAT_NO_OFF_PROC_ENTRIES, PETSC_FALSE));
  job.on_root([&] {
    const std::map<int, double> masses = point_masses(job);
    for (std::size_t row = 0; row < job.plan.dof.size(); ++row)
      if (const auto at = masses.find(job.plan.dof[row] / 3); at != masses.end())
        check(MatSetValue(M, static_cast<PetscInt>(row), static_cast<PetscInt>(row), at->second, ADD_VALUES));
  });
  check(MatAssemblyBegin(M, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(M, MAT_FINAL_ASSEMBLY));
}

}  // namespace

fem::Matrices assemble(Job& job) {
  fem::Matrices matrices = job.options.imported ? std::move(job.plan.imported) : assemble_cells(job);
  add_point_masses(job, matrices.M);
  return matrices;
}

io::BodySource source_of(const Job& job) {
  return {.mesh = job.mesh,
          .regions = job.regions,
          .element = job.options.element,
          .element_mass = job.options.element_mass,
          .free_dof = job.plan.free_dof,
          .checks = job.report.checks,
          .origin = job.report.origin,
          .recovery = job.plan.recovery};
}

ReductionReport reduce(MPI_Comm comm, const mesh::Mesh& mesh, const ReductionOptions& options,
                       const std::string& output, const Progress& progress) {
  Job job{comm, mesh, options, output, progress};
  MPI_Comm_rank(comm, &job.rank);
  MPI_Comm_size(comm, &job.size);
  job.begin_stage(options.imported ? "reading matrices" : "numbering and symmetry");
  options.imported ? read_matrices(job) : number(job);
  job.begin_stage("inertia, surface and stress operator");
  prepare_body(job);
  if (job.modal())
    reduce_modal(job);
  else
    keep_all(job);
  job.on_root([&] { fill_report(job); });
  job.end_stage();
  return job.report;
}

}  // namespace elastogear::reduction
