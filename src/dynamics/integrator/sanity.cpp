#include "dynamics/integrator/sanity.h"

#include <Eigen/Cholesky>

#include "dynamics/integrator/rigid_fields.h"
#include "elastogear/base/error.h"
#include "elastogear/base/rotation.h"
#include "elastogear/body/deformed_inertia.h"

namespace elastogear::dynamics {
namespace {

constexpr double kLimitOfLinearity = 0.5;  // elastic rotation (rad) or strain
constexpr double kEnergyGrowth = 100;      // energy that is made over the energy, at once
constexpr double kMostMade = 0.1;          // energy that may be made, of the energy that is turned over
constexpr int kMostBeyond = 10;            // successive steps with more
constexpr double kNoEnergy = 1e-9;         // J, that may be roundoff of a system at rest
constexpr double kInertiaRoundoff = 1e-8;  // of the inertia that elastic coordinates carry

double stored(const model::Energies& energy) {
  return energy.kinetic + energy.elastic + energy.contact + energy.bushing;
}

bool may_lose_its_mass(const System::Body& body) {
  return body.eq.level == body::InertiaLevel::linear && body.eq.n_q() > 0 && body.n_open() > 0;
}

Eigen::Matrix<double, 6, 6> carried_inertia(const model::ElasticBody& body) {
  Eigen::MatrixXd C(body.n_q(), 6);
  C << body.inertia.C_l, body.inertia.C_r;
  return C.transpose() * rigid_fields(body);
}

// Inertia of the body's frame in the deformed state, 6 x 6.
Eigen::Matrix<double, 6, 6> frame_inertia(const System::Body& body, const model::BodyState& x) {
  const body::Shape shape = body::shape(body.eq, {x.s, x.s_dot, x.s_ddot, x.q, x.q_dot, x.q_ddot});
  const Eigen::Matrix3d S = skew(shape.S);
  Eigen::Matrix<double, 6, 6> M;
  M << body.eq.body->inertia.m * Eigen::Matrix3d::Identity(), -S, S, shape.J;
  return M;
}

}  // namespace

Sanity::Sanity(const System& system) : system_(&system) {
  for (const System::Body& body : system.bodies()) {
    Body watched{DeformationWatch(*body.eq.body), Eigen::Matrix<double, 6, 6>::Zero()};
    if (may_lose_its_mass(body)) watched.carried = carried_inertia(*body.eq.body);
    bodies_.push_back(std::move(watched));
  }
}

// Elastic coordinates at rest follow any motion of the frame: the inertia that is left must be positive.
void Sanity::require_positive_mass(std::size_t b, const model::Snapshot& now) const {
  const System::Body& body = system_->bodies()[b];
  const Eigen::MatrixXd H = body.eq.H(Eigen::all, body.open);
  const Eigen::MatrixXd all = H.transpose() * frame_inertia(body, now.bodies[b]) * H;
  const Eigen::MatrixXd left = all - H.transpose() * bodies_[b].carried * H +
                               kInertiaRoundoff * Eigen::MatrixXd(all.diagonal().asDiagonal());
  require(
      Eigen::LLT<Eigen::MatrixXd>(left).info() == Eigen::Success, "body '", body.name, "' at t = ", now.time,
      " s: the mass matrix is no longer positive definite, for inertia level 'linear' leaves out what the "
      "deformation does to it in second order. Use -inertia affine (the default), full (body files made "
      "with -invariants full) or constant");
}

void Sanity::require_small(const model::Snapshot& now) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const System::Body& body = system_->bodies()[b];
    const double change = bodies_[b].deformation.largest(now.bodies[b].q, kLimitOfLinearity);
    require(
        !(change > kLimitOfLinearity), "body '", body.name, "' at t = ", now.time,
        " s: elastic rotation or strain ", change, ", must be at most ", kLimitOfLinearity,
        " for equations that are linear in it. Check loads, speeds and stiffness (-material_E of reduce), "
        "or take shorter steps (-ts_dt)");
    if (may_lose_its_mass(body)) require_positive_mass(b, now);
  }
}

void Sanity::require_balance(double time, const model::Energies& now) {
  if (start_ < 0) start_ = stored(now);
  turnover_ += std::abs(now.work - work_);
  work_ = now.work;
  const double energy = std::max(turned_over(), kNoEnergy);
  beyond_ = now.balance > kMostMade * energy ? beyond_ + 1 : 0;
  require(beyond_ < kMostBeyond && !(now.balance > kEnergyGrowth * energy), "at t = ", time,
          " s the energy balance is off by ", now.balance, " J, more than ", 100 * kMostMade, " % of the ",
          energy,
          " J that there were at the start and came in by loads and motions: the run makes energy. Try a "
          "smaller time step (-ts_dt, or a smaller -step_error), -ts_alpha_radius below 1, or a smaller "
          "-contact_stiffness");
}

void Sanity::serialize(Archive& archive) {
  for (double* x : {&start_, &turnover_, &work_}) archive(*x);
  archive(beyond_);
}

}  // namespace elastogear::dynamics
