#pragma once
// Mode acceleration for one body of a run: its dynamic coordinates, the contact forces on it, and the whole
// body's static response to them.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/io/body_file.h"
#include "elastogear/recovery/body_of_run.h"
#include "elastogear/recovery/finite_elements.h"

namespace elastogear::recovery {

/// Forces to which a viscoelastic body of several materials responds as one of its relaxed states:
/// docs/theory, Eq. (4.12).
struct CreptForces {
  Eigen::MatrixXd force;         ///< 3 n x n_t, N: chi_k of the n nodes that have been loaded
  Eigen::MatrixXd q, q_relaxed;  ///< n_q x n_t: the modes' response to chi_k, instantaneous and of the state
};
struct CreptResponse {
  std::vector<int> position;        ///< of the loaded nodes in body.flexibility
  std::vector<CreptForces> states;  ///< of each of the relaxed states there
};

struct StaticResponseOfRun {
  Eigen::MatrixXd q;          ///< n_q x n_t, without the static part
  std::vector<int> node;      ///< loaded nodes, mesh numbers
  Eigen::MatrixXd force;      ///< 3 n x n_t, N, body frame
  std::string file;           ///< the body's
  model::ElasticBody body;    ///< what it holds, without the basis at the surface
  std::vector<int> position;  ///< of the loaded nodes in body.flexibility; empty unless it has them all
  FiniteElements finite_elements;
  std::optional<CreptResponse> crept = {};          ///< where there is one
  std::optional<io::BodySource> source = {};        ///< read when it is needed:
  std::optional<UnreducedResponse> unreduced = {};  ///< by a factor of K
};

/// Bodies for which mode acceleration is asked: always, all modal ones; automatic, those whose files hold
/// static responses to their loads.
enum class Acceleration { never, automatic, always };
/// Static response of a body over the run. Nothing for a body in its full basis, whose response is complete
/// already, for one that was rigid in the run or is viscoelastic, and where mode acceleration is not asked
/// for. Error where it is asked for always and the body is viscoelastic or no factor of K can serve.
std::unique_ptr<StaticResponseOfRun> static_response_of_run(const BodyOfRun& body, Acceleration acceleration,
                                                            const FiniteElements& finite_elements);

/// Static response by which the error of stresses of a reduced body is estimated, from the body file or by a
/// factor of K. Nothing for the full basis; nothing for free bodies with point masses, matrices of other
/// programs and more than 500,000 displacements when the body file holds no static responses.
std::unique_ptr<StaticResponseOfRun> error_reference(const BodyOfRun& body,
                                                     const FiniteElements& finite_elements);

/// The body's whole finite elements with a factor of K, made when it is first asked for. Error where none can
/// serve.
const UnreducedResponse& unreduced_response(StaticResponseOfRun& known_response);
/// Displacements of the static response at n_t output times, 3 n_nodes x n_t, m; takes a factor of K. Without
/// rows when no force acts.
Eigen::MatrixXd static_displacements(StaticResponseOfRun& known_response, const std::vector<int>& steps);

}  // namespace elastogear::recovery
