#include "dynamics/contact/coulomb.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace elastogear::dynamics {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kTolerance = 1e-12;  // of the largest force
constexpr int kNewtonSteps = 40;
constexpr int kHalvings = 6;
constexpr int kSweeps = 2000;
constexpr int kAttempts = 3;  // of Newton's method, with sweeps before all but the first

// Forces per displacement of a contact, which give both one unit.
struct Scale {
  double n = 0, t = 0;  // N/m
};

class Problem {
 public:
  Problem(const MatrixXd& C, const VectorXd& q, const std::vector<CoulombContact>& contacts)
      : C_(C), q_(q), contacts_(contacts) {
    for (const CoulombContact& c : contacts) {
      const Index i = c.first;
      scale_.push_back({1 / C(i, i), c.sticks ? 1 / std::max(C(i + 1, i + 1), C(i + 2, i + 2)) : 0});
    }
  }

  // N, what the projections change in the forces z.
  VectorXd residual(const VectorXd& z) const;
  // Its derivative.
  MatrixXd derivative(const VectorXd& z) const;
  // Projects the forces of one contact after the other, each with those before it. Returns the largest
  // change.
  double sweep(VectorXd& z) const;

 private:
  struct Trial {
    double p;    // N, projected
    Vector2d s;  // N, tangential force to be projected on the disc of the radius mu p
  };
  Trial trial(std::size_t c, const VectorXd& z, const Eigen::Vector3d& y) const;
  Eigen::Vector3d at(const CoulombContact& c, const VectorXd& z) const;

  const MatrixXd& C_;
  const VectorXd& q_;
  const std::vector<CoulombContact>& contacts_;
  std::vector<Scale> scale_;
};

Vector2d on_disc(const Vector2d& s, double radius) {
  const double length = s.norm();
  return length <= radius ? s : Vector2d(std::max(0.0, radius) / length * s);
}

// y of one contact.
Eigen::Vector3d Problem::at(const CoulombContact& c, const VectorXd& z) const {
  Eigen::Vector3d y = Eigen::Vector3d::Zero();
  const Index n = c.sticks ? 3 : 1;
  y.head(n) = q_.segment(c.first, n) + C_.middleRows(c.first, n) * z;
  return y;
}

Problem::Trial Problem::trial(std::size_t c, const VectorXd& z, const Eigen::Vector3d& y) const {
  const CoulombContact& contact = contacts_[c];
  const Index i = contact.first;
  Trial trial{std::max(0.0, z[i] - scale_[c].n * y[0]), Vector2d::Zero()};
  if (contact.sticks) trial.s = z.segment<2>(i + 1) - scale_[c].t * y.tail<2>();
  return trial;
}

VectorXd Problem::residual(const VectorXd& z) const {
  VectorXd r(z.size());
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const CoulombContact& contact = contacts_[c];
    const Index i = contact.first;
    const Trial to = trial(c, z, at(contact, z));
    r[i] = z[i] - to.p;
    if (contact.sticks) r.segment<2>(i + 1) = z.segment<2>(i + 1) - on_disc(to.s, contact.mu * to.p);
  }
  return r;
}

MatrixXd Problem::derivative(const VectorXd& z) const {
  MatrixXd J = MatrixXd::Identity(z.size(), z.size());
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const CoulombContact& contact = contacts_[c];
    const Index i = contact.first;
    const Scale& scale = scale_[c];
    const Trial to = trial(c, z, at(contact, z));
    const bool closed = to.p > 0;
    if (closed) J.row(i) = scale.n * C_.row(i);
    if (!contact.sticks) continue;
    const double radius = contact.mu * to.p, length = to.s.norm();
    if (closed && length <= radius) {
      J.middleRows<2>(i + 1) = scale.t * C_.middleRows<2>(i + 1);
    } else if (closed) {
      const Vector2d d = to.s / length;
      const Matrix2d turn = radius / length * (Matrix2d::Identity() - d * d.transpose());
      J.middleRows<2>(i + 1) += turn * scale.t * C_.middleRows<2>(i + 1);
      J.block<2, 2>(i + 1, i + 1) -= turn;
      J.middleRows<2>(i + 1) += contact.mu * scale.n * d * C_.row(i);
      J.block<2, 1>(i + 1, i) -= contact.mu * d;
    }
  }
  return J;
}

double Problem::sweep(VectorXd& z) const {
  double most = 0;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const CoulombContact& contact = contacts_[c];
    const Index i = contact.first;
    const double p = trial(c, z, at(contact, z)).p;
    most = std::max(most, std::abs(p - z[i]));
    z[i] = p;
    if (!contact.sticks) continue;
    const Vector2d t = on_disc(trial(c, z, at(contact, z)).s, contact.mu * p);
    most = std::max(most, (t - z.segment<2>(i + 1)).norm());
    z.segment<2>(i + 1) = t;
  }
  return most;
}

double size(const VectorXd& v) { return v.cwiseAbs().maxCoeff(); }

// Returns whether z solves the problem, projected then.
bool newton(const Problem& problem, double force, VectorXd& z) {
  VectorXd r = problem.residual(z);
  for (int step = 0; step < kNewtonSteps; ++step) {
    if (size(r) <= kTolerance * std::max(force, size(z))) {
      z -= r;
      return true;
    }
    const VectorXd dz = problem.derivative(z).partialPivLu().solve(r);
    if (!dz.allFinite()) return false;
    double share = 1;
    VectorXd to = z - dz, r_to = problem.residual(to);
    for (int half = 0; half < kHalvings && r_to.norm() > r.norm(); ++half) {
      share /= 2;
      to = z - share * dz;
      r_to = problem.residual(to);
    }
    z = to;
    r = r_to;
  }
  return false;
}

}  // namespace

bool slides(const CoulombContact& contact, const VectorXd& z) {
  constexpr double kRoundoff = 1e-9;
  const double p = z[contact.first];
  return contact.sticks && p > 0 &&
         z.segment<2>(contact.first + 1).norm() >= (1 - kRoundoff) * contact.mu * p;
}

std::optional<VectorXd> solve_coulomb(const MatrixXd& C, const VectorXd& q,
                                      const std::vector<CoulombContact>& contacts, VectorXd z) {
  if (q.size() == 0) return VectorXd();
  const Problem problem(C, q, contacts);
  const double force = size(q.cwiseQuotient(C.diagonal()));
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (attempt > 0) {
      double change = force;
      for (int sweep = 0; sweep < kSweeps && change > kTolerance * force; ++sweep) change = problem.sweep(z);
    }
    VectorXd solution = z;
    if (newton(problem, force, solution)) return solution;
  }
  return {};
}

}  // namespace elastogear::dynamics
