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
  Eigen::VectorXd q_error = {};  ///< of q by the steps in time; empty: no error in time is estimated
};

/// Fields that are found together: their stresses and those of their estimates, 300 MB, are in memory.
int fields_together(int n_nodes);

/// The loaded nodes of a body with what the estimated error by the mesh needs of them.
struct LoadedSurface {
  std::vector<int> node;         ///< mesh numbers
  SurfacePatches patches;        ///< around each; of means none
  model::SparseRows difference;  ///< Eq. (1.16a), 6 n x 3 n_nodes, Pa/m
};

/// A body as its fields take it. What the mesh costs is paid once.
struct FieldBody {
  const std::string& file;  ///< that gives Phi
  const io::BodySource& source;
  FiniteElements finite_elements;
  NodalStresses nodal_stresses;
  SurfacePatches around_free = {};           ///< of nodal_stresses.free; of means none
  std::optional<LoadedSurface> loaded = {};  ///< none: no error of the mesh is estimated
};

/// `source` is read from `body_file`, and both outlive the result. touched: mesh numbers of the nodes of the
/// contact surface; none: no error of the mesh is estimated.
FieldBody field_body(const std::string& body_file, const io::BodySource& source,
                     const std::optional<std::vector<int>>& touched, const FiniteElements& finite_elements);

/// Writes a body at several times, one file each: undeformed in its placement (world frame) with displacement
/// (world frame), stress (body frame), von_mises, its estimated errors, rankine and the fields in `more`.
/// States have the same estimates.
void write_fields(const std::vector<std::string>& paths, const FieldBody& body,
                  const std::vector<FieldState>& states);

}  // namespace elastogear::recovery
