#pragma once
// One reduction while it runs: what its stages hand on to each other. reduce_body.cpp reads, numbers and
// places the body, reduce_modal.cpp finds its modes, static_response/reduce_flexibility.cpp its static
// responses, reduce_relaxing.cpp what relaxes in it, reduce.cpp assembles and ends it.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/base/collectively.h"
#include "elastogear/base/log_stage.h"
#include "elastogear/fem/assembly.h"
#include "elastogear/fem/inertia.h"
#include "elastogear/fem/stressed_body.h"
#include "elastogear/io/body_file.h"
#include "elastogear/mesh/hold.h"
#include "elastogear/mesh/partition.h"
#include "elastogear/mesh/repetition.h"
#include "elastogear/reduction/flexibility.h"
#include "elastogear/reduction/reduce.h"
#include "reduction/job/relaxed_states.h"

namespace elastogear::reduction {

/// Data that rank 0 alone has: the numbering, and all of the body that needs no solution.
struct Plan {
  std::vector<int> region;             // of each cell
  std::vector<mesh::Directions> held;  // of each node
  std::vector<bool> is_free;           // of each node: in some direction
  std::vector<int> free_dof;
  mesh::Repetition repetition;  // n_sectors = 1 (on all ranks): none
  mesh::Partition partition;
  fem::RowNumbering rows;           // own matrices only
  fem::Matrices imported;           // on all ranks
  model::SparseRows imported_mass;  // its scalar mass, for full invariants
  std::vector<int> dof;             // displacement of every scalar row
  model::StressRecovery recovery;
  fem::MassMoments moments;
  model::SparseRows S;  // of stress, then of markers: see reduction/basis.h
  model::ElasticBody body;
};

class WaitingModes;

struct Job {
  MPI_Comm comm;
  mesh::Mesh mesh;
  const ReductionOptions& options;
  const std::string& output;
  const Progress& progress;
  int rank = 0, size = 1;
  Plan plan = {};
  ReductionReport report = {};
  std::vector<model::MaterialRegion> regions = options.regions;  // in the body frame, as the mesh is
  const char* stage_name = nullptr;                              // of the stage that goes on
  std::optional<LogStage> stage = {};                            // in PETSc's log
  double started = 0;                                            // s, when it began

  bool modal() const { return options.basis == model::Basis::modal; }
  bool cyclic() const { return plan.repetition.turn.n_sectors > 1; }
  /// Returns whether the modes come from one sector; of a free body only the static responses do.
  bool modes_by_sectors() const { return cyclic() && !options.floating; }

  /// Runs `f` on rank 0; its errors reach all ranks.
  void on_root(const std::function<void()>& f) {
    collectively(comm, [&] {
      if (rank == 0) f();
    });
  }

  /// Ends the stage that goes on. Its time goes to the report.
  void end_stage() {
    if (stage) report.times.push_back({stage_name, MPI_Wtime() - started});
    stage.reset();
  }
  /// Begins a stage. name: as it stands in the report and in PETSc's log.
  void begin_stage(const char* name) {
    end_stage();
    stage_name = name;
    started = MPI_Wtime();
    stage.emplace(name);
  }
};

/// Checks options and mesh, numbers the displacements and looks for symmetry. Collective.
void number(Job& job);
/// Reads the matrices of another program, checks options and mesh and numbers the displacements. Collective.
void read_matrices(Job& job);
/// Point masses, kg, of every node that has some. Rank 0.
std::map<int, double> point_masses(const Job& job);
/// The mass between the displacements of all nodes and modes, point masses included. Rank 0.
fem::FieldMass field_mass(const Job& job);
/// Moves all coordinates into the body frame and makes what needs no solution. Collective.
void prepare_body(Job& job);

/// How the job's cells are computed.
model::Formulation formulation(const Job& job);

/// K and M of the whole body, assembled or as they were read; once. Collective.
fem::Matrices assemble(Job& job);
io::BodySource source_of(const Job& job);
/// The body as its stresses are recovered. The job outlives it.
fem::StressedBody stressed_body(const Job& job);

/// Finds the modes and writes the body file. Collective.
void reduce_modal(Job& job);

fem::MeshedBody meshed_body(const Job& job);
/// Says what the static responses will take before anything is solved. Collective.
void announce_flexibility(Job& job);
/// Is the basis made of static responses alone, so that no eigenmode is looked for?
bool without_modes(const ReductionOptions& options);
/// Do the loaded nodes repeat as the mesh does? Collective.
bool flexibility_repeats(Job& job);
/// Finds the static responses. whole: of the whole body; not needed where they repeat, and then the sink gets
/// their columns, unless there are states of relaxation. Collective.
void add_flexibility(Job& job, const ElasticSystem* whole, const ColumnSink& sink);

/// Are there viscoelastic materials?
bool relaxes(const ReductionOptions& options);
/// Throws Error for what viscoelastic materials do not go with.
void validate_relaxing(const ReductionOptions& options);
/// The method that the options choose or, automatically, the materials allow.
model::RecoveryMethod recovery_method(const ReductionOptions& options);
/// Sets body.relaxing, after body.K_r, with the stiffness of the parts between closed modes. Rank 0.
void set_relaxing(Job& job, const WaitingModes& modes);
/// The same for the full basis.
void set_relaxing_full(Job& job);
/// Relaxes all of the body in the same ratio? Rank 0.
bool relaxes_alike(const Job& job);
/// The states of relaxation in which static responses of the body are found; the same on all ranks.
RelaxedStates relaxed_states(const Job& job);
/// Sets what of the moduli is gone, from the shares of the relaxing parts.
void set_relaxed(std::vector<model::MaterialRegion>& regions, const Eigen::VectorXd& share);
/// Takes the relaxed stress out of G, 6 rows of instantaneous stress for each mesh node. Rank 0.
void relax_stresses(const Job& job, const std::vector<int>& nodes, Eigen::MatrixXf& G);

}  // namespace elastogear::reduction
