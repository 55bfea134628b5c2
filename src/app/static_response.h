#pragma once
// Mode acceleration for one body of a run: its dynamic coordinates, the contact forces on it, and the whole
// body's static known_response to them.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/io/result_file.h"
#include "elastogear/recovery/mode_acceleration.h"
#include "elastogear/reduction/static_response.h"

namespace elastogear::app {

struct StaticResponseOfRun {
  Eigen::MatrixXd q;          ///< n_q x n_t, without the static part
  std::vector<int> node;      ///< loaded nodes, mesh numbers
  Eigen::MatrixXd force;      ///< 3 n x n_t, N, body frame
  std::string file;           ///< the body's
  model::ElasticBody body;    ///< what it holds, without the basis at the surface
  std::vector<int> position;  ///< of the loaded nodes in body.flexibility; empty unless it has them all
  std::optional<io::BodySource> source = {};                      ///< read when it is needed:
  std::unique_ptr<reduction::StaticResponse> response = nullptr;  ///< a factor of K
};

struct BodyOfRun {
  std::string result, name, file, identity;  ///< identity: that of the file in the run; empty: not known
  const io::BodyHistory& history;
};

/// Throws Error unless the body file holds what the run was made with.
void require_body_of_run(const model::ElasticBody& elastic, const BodyOfRun& body);

/// always: for all modal bodies; automatic: for those whose files hold static answers to their loads.
enum class Acceleration { never, automatic, always };
/// Nothing for a body in its full basis, whose known_response is complete already, for one that was rigid in
/// the run, and where it is not asked for.
std::unique_ptr<StaticResponseOfRun> static_response_of_run(const BodyOfRun& body, Acceleration acceleration);

/// What stresses of a reduced body are held against to estimate their error: from the answers in the body
/// file, or by a factor of K. Nothing where neither serves: for the full basis, and for free bodies, matrices
/// of other programs and more than 500,000 displacements without such answers.
std::unique_ptr<StaticResponseOfRun> error_reference(const BodyOfRun& body);

/// 6 n x n_t, Pa, at mesh nodes: from the answers in the body file, or by a factor of K when it has none.
Eigen::MatrixXd stress_history(StaticResponseOfRun& known_response, const std::vector<int>& nodes);
/// 3 n_nodes, m, at one output time; takes a factor of K.
Eigen::VectorXd displacement(StaticResponseOfRun& known_response, Eigen::Index step);

}  // namespace elastogear::app
