#pragma once
// Elastic boxes for tests: a regular grid of trilinear hexahedra with consistent mass, in both bases.

#include <functional>
#include <memory>

#include "elastogear/model/elastic_body.h"
#include "elastogear/model/material.h"

namespace elastogear::test {

struct BoxSpec {
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d size = Eigen::Vector3d::Ones();    ///< m
  Eigen::Vector3i cells = Eigen::Vector3i::Ones();
  model::Material material;
  /// Is this degree of freedom (0..2) of the node at X held?
  std::function<bool(const Eigen::Vector3d& X, int direction)> held = [](const auto&, int) { return false; };
  int rigid_modes = 0;  ///< lowest modes that a modal basis leaves out
};

/// Surface: the faces at x_min and x_max, groups of those names. n_modes = 0: all.
model::ElasticBody make_box(const BoxSpec& spec, model::Basis basis, int n_modes = 0);

/// 2 x 1 x 1 m of E = 100 Pa, nu = 0.3, rho = 1 kg/m^3 with Rayleigh damping 0.1 /s, 0.01 s.
std::shared_ptr<model::ElasticBody> make_damped_box(const Eigen::Vector3d& corner,
                                                    const Eigen::Vector3i& cells, model::Basis basis,
                                                    int n_modes);

/// A body of the full basis in the modes V of its K_r and M_r, mass-normalised, with the eigenvalues lambda.
model::ElasticBody in_modes(model::ElasticBody full, const Eigen::MatrixXd& V, const Eigen::VectorXd& lambda);

/// Gives a modal body the static responses F (3 n_s x 3 n_s, m/N) to forces on all surface nodes.
void set_flexibility(model::ElasticBody& body, const Eigen::MatrixXd& F);

/// The same modal box with its static responses to forces on all surface nodes; so held that K is regular.
model::ElasticBody make_flexible_box(const BoxSpec& spec, int n_modes);

/// The same box with no elastic coordinate.
model::ElasticBody make_rigid_box(const BoxSpec& spec);

/// q' of a uniform velocity (m/s): M_r q' = C_l v, exact when the basis holds the translation.
Eigen::VectorXd uniform_velocity(const model::ElasticBody& body, const Eigen::Vector3d& v);

}  // namespace elastogear::test
