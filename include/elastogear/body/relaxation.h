#pragma once
// Relaxation of one body's viscoelastic materials (docs/theory, section 3.7): internal variables z_i with
// z_i' = (q - z_i)/tau_i, one for each time that occurs in the body, and the elastic force
//   K_r q - sum_p K_p w_p,   w_p = sum_i g_pi z_i.

#include <Eigen/Core>

#include "elastogear/model/elastic_body.h"

namespace elastogear::body {

/// What the moduli of viscoelastic materials are: as their history makes them, those of a load that has just
/// been put on (z = 0), or those after all relaxation (z = q).
enum class Moduli { relaxing, instantaneous, long_term };

struct RelaxationLaw {
  Eigen::VectorXd tau;  ///< n_z, s, ascending
  Eigen::MatrixXd g;    ///< n_p x n_z, relative moduli of each part

  Eigen::Index n_z() const { return tau.size(); }
};
RelaxationLaw relaxation_law(const model::ElasticBody& body);

/// A time, and q and z then.
struct InternalState {
  double time = 0;
  Eigen::VectorXd q;  ///< n_q
  Eigen::MatrixXd z;  ///< n_q x n_z
};

/// Where between the start and the end of a step of length dt (s) a state is taken: at the weight alpha of
/// the end, as generalised-alpha does with q.
struct StepPoint {
  double dt = 0, alpha = 1;
};

/// Share c_i of a change of q in a step that z_i takes over, n_z. Eq. (3.24).
Eigen::VectorXd following_shares(const RelaxationLaw& law, double dt);

/// z at a point of the step that begins at `start`, at which the coordinates are q; exact for q linear over
/// the step. Eq. (3.23).
Eigen::MatrixXd internal_variables(const RelaxationLaw& law, const InternalState& start, const StepPoint& at,
                                   const Eigen::VectorXd& q);

/// sum_p K_p w_p for w = z g', n_q x n_p.
Eigen::VectorXd relaxed_force(const model::ElasticBody& body, const Eigen::MatrixXd& w);

/// J, stored in the body beside 1/2 q.K_r q. Eq. (3.25).
double relaxed_energy(const model::ElasticBody& body, const RelaxationLaw& law, const Eigen::VectorXd& q,
                      const Eigen::MatrixXd& z);

/// J, that the material takes between two states of the body. Eq. (3.26).
double relaxation_loss(const model::ElasticBody& body, const RelaxationLaw& law, const InternalState& from,
                       const InternalState& to);

}  // namespace elastogear::body
