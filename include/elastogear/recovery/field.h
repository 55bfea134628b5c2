#pragma once
// Whole-body fields over time, for ParaView: what recovery gives, on the mesh the body file keeps.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/io/body_file.h"
#include "elastogear/io/field_file.h"
#include "elastogear/recovery/finite_elements.h"

namespace elastogear::recovery {

/// Data for the estimated error of a reduced body's field, Eq. (4.9).
struct FieldReference {
  Eigen::VectorXd q, q_d;    ///< elastic coordinates of the run, without static response to contact forces,
  Eigen::VectorXd q_upper;   ///< and the dynamic part of the upper half of the modes
  Eigen::VectorXd u_static;  ///< 3 n_nodes, m, BRF, the whole body's static response; empty: no force acts
  double share = 0;          ///< dynamic_share, Eq. (4.8)
};

/// One body at one time.
struct FieldState {
  Eigen::Vector3d r_WB;
  Eigen::Matrix3d R_WB;
  Eigen::VectorXd q;
  Eigen::MatrixXd w = {};         ///< n_q x n_p, of a viscoelastic body: model::BodyState
  Eigen::VectorXd u_static = {};  ///< 3 n_nodes, m, BRF, added to Phi q; empty: nothing
  std::vector<io::NodeField> more = {};
  std::optional<FieldReference> reference = {};  ///< none: no error of the reduction is estimated
  std::optional<std::vector<int>> touched =
      {};  ///< mesh numbers of the contact surface's nodes; none: no error of the mesh is estimated
  Eigen::VectorXd q_error = {};  ///< of q by the steps in time; empty: no error in time is estimated
};

/// Fields that are found together: what a mesh costs is paid once for all of them, 200 MB of them are in
/// memory.
int fields_together(int n_nodes);

/// Writes a body at several times, one file each: undeformed in its placement (world frame) with displacement
/// (world frame), stress (body frame), von_mises, its estimated errors, rankine and the fields in `more`.
/// `body_file` gives Phi, and `source` is read from it. States have the same estimates.
void write_fields(const std::vector<std::string>& paths, const std::string& body_file,
                  const io::BodySource& source, const std::vector<FieldState>& states,
                  const FiniteElements& finite_elements);

}  // namespace elastogear::recovery
