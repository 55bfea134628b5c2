#pragma once
// Stress from reduced coordinates: sigma = Psi q (docs/theory, Eq. (4.1)), and the equivalent stresses
// engineers read. Components in the body frame, Pa, order xx yy zz xy yz xz.

#include <Eigen/Core>
#include <vector>

#include "elastogear/model/elastic_body.h"

namespace elastogear::recovery {

using StressVector = Eigen::Matrix<double, 6, 1>;

/// sqrt(((xx-yy)^2 + (yy-zz)^2 + (zz-xx)^2)/2 + 3 (xy^2 + yz^2 + xz^2)), Pa. Eq. (4.2).
double von_mises(const StressVector& sigma);

/// Largest principal stress (Rankine), Pa. Eqs. (4.2) and (4.2a).
double rankine(const StressVector& sigma);

/// Histories at n nodes over n_t times.
struct StressHistory {
  std::vector<int> node;      ///< n, mesh numbers
  Eigen::MatrixXd stress;     ///< 6 n x n_t, Pa
  Eigen::MatrixXd von_mises;  ///< n x n_t, Pa
  Eigen::MatrixXd rankine;    ///< n x n_t, Pa
};

/// Equivalent stresses, n x n_t, of a 6 n x n_t history.
Eigen::MatrixXd von_mises(const Eigen::MatrixXd& stress);
Eigen::MatrixXd rankine(const Eigen::MatrixXd& stress);

/// Psi q at the evaluation nodes `members` (local numbers in stress.node), 6 n x n_t, Pa; q: n_q x n_t.
/// Eq. (4.1).
Eigen::MatrixXd modal_stress(const model::Stress& stress, const std::vector<int>& members,
                             const Eigen::Ref<const Eigen::MatrixXd>& q);

/// Stress that the relaxing parts of a viscoelastic body have lost at these nodes, 6 n x n_t, Pa; w: n_q n_p
/// x n_t, model::BodyState::w part by part. To be subtracted from that of q. Eq. (4.10).
Eigen::MatrixXd relaxed_stress(const model::ElasticBody& body, const std::vector<int>& members,
                               const Eigen::Ref<const Eigen::MatrixXd>& w);

/// The part of stresses (6 n x n_t) that the shear or the bulk modulus makes: deviators or mean stresses.
Eigen::MatrixXd stress_of_part(Eigen::MatrixXd stress, model::ModulusPart part);

/// sigma(t) = Psi q(t) + sigma_static(t) at the evaluation nodes `members` (local numbers in stress.node);
/// q: n_q x n_t; sigma_static: 6 n x n_t, Pa, or empty.
StressHistory stress_history(const model::Stress& stress, const std::vector<int>& members,
                             const Eigen::MatrixXd& q, const Eigen::MatrixXd& sigma_static = {});

}  // namespace elastogear::recovery
