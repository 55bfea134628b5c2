#pragma once
// Static completeness: the share of the static response to a load on the surface that the modes have
// (docs/theory, section 2.3).

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastogear/base/petsc.h"
#include "elastogear/fem/gather.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/reduction/free_body.h"
#include "elastogear/reduction/surface_load.h"

namespace elastogear::reduction {

/// Shares c of the compliance that the modes have: Eq. (2.7).
struct Completeness {
  std::vector<std::string> load;  ///< those that move something
  Eigen::VectorXd share;          ///< f' Phi Lambda^-1 Phi' f / f' K^-1 f, 0..1
};

/// Matrices of the body whose modes are checked. rigid: rigid modes of a free body, whose loads are balanced
/// by inertia; else null.
struct ElasticSystem {
  Mat K, M;
  const fem::VectorGather& gather;
  const RigidModes* rigid = nullptr;
};

/// f (3 n_s, N, on the surface) as forces on all n_nodes nodes.
Eigen::VectorXd at_nodes(const model::Surface& surface, const Eigen::VectorXd& f, int n_nodes);

/// Own rows of n_loads forces, 3 n_nodes each, read on rank 0; of a free body balanced by inertia.
/// Collective.
Eigen::MatrixXd distribute(const ElasticSystem& system, const std::vector<Eigen::VectorXd>& loads,
                           int n_loads);

/// One factorisation, one solve with all loads. Collective; body (modal, its modes
/// complete, of n_nodes nodes) is read on rank 0, where the result is.
Completeness static_completeness(const ElasticSystem& system, const model::ElasticBody& body, int n_nodes);

}  // namespace elastogear::reduction
