#pragma once
// Stresses and fields of the bodies of a run, with mode acceleration and estimated errors (docs/theory,
// sections 4.1 and 4.3).

#include <memory>
#include <string>
#include <vector>

#include "elastogear/io/stress_file.h"
#include "elastogear/recovery/field.h"
#include "elastogear/recovery/static_response.h"

namespace elastogear::recovery {

/// A body of a run with the static responses that its stresses take.
struct RecoveredBody {
  BodyOfRun run;
  std::unique_ptr<StaticResponseOfRun> response = nullptr;   ///< of mode acceleration, when asked for
  std::unique_ptr<StaticResponseOfRun> reference = nullptr;  ///< of the error, where `response` is none
  FiniteElements finite_elements = {};

  /// The coordinates to multiply modes with: their dynamic part where `response` adds the static one.
  const Eigen::MatrixXd& q() const { return response ? response->q : run.history.q; }
  /// Is it viscoelastic? Then errors are told of the sets of nodes alone, and where `response` is known.
  bool relaxes() const { return run.history.w.rows() > 0; }
  /// The static response by which errors are estimated; nullptr: there is none.
  StaticResponseOfRun* known() const { return response ? response.get() : reference.get(); }
};

/// Sets the static responses. with_error: an error will be estimated. The functions of finite_elements are
/// called when they are needed.
RecoveredBody prepare_recovery(BodyOfRun run, Acceleration acceleration, bool with_error,
                               const FiniteElements& finite_elements);

/// Throws Error unless the set is one of those whose stresses the body file can give.
void require_stress_set(const std::vector<std::string>& known, const std::string& set,
                        const std::string& file);

/// Stress at the evaluation nodes of a set of the body (elastic: its file), with the estimated error when
/// asked for and where it can be told. Error naming the sets when there is none of this name.
io::StressSet recover_stress(RecoveredBody& body, const model::ElasticBody& elastic, const std::string& set,
                             bool with_error);

/// Can the error of the mesh be told from the body's displacements? Not where it is viscoelastic, or comes
/// from matrices.
bool tells_mesh_error(const RecoveredBody& body, const model::ElasticBody& elastic);

/// Placement and coordinates at one output time, without static responses.
FieldState state_of_run(const BodyOfRun& body, Eigen::Index step);
/// States for fields, with the whole body's static response in place of that of the modes when it was asked
/// for. Those of several output times share the factors that it takes.
std::vector<FieldState> recovered_states(const RecoveredBody& body, const std::vector<int>& steps,
                                         bool with_error);

}  // namespace elastogear::recovery
