#include "elastogear/body/relaxation.h"

#include <algorithm>
#include <cmath>

namespace elastogear::body {
namespace {

// 1 - (1 - exp(-h))/h without cancellation.
double following_share(double h) {
  constexpr double kSeries = 0.02;  // below it five terms are exact to 1e-13 of the first
  if (h < kSeries)
    return h * (1. / 2 - h * (1. / 6 - h * (1. / 24 - h * (1. / 120 - h * (1. / 720 - h / 5040)))));
  return 1 + std::expm1(-h) / h;
}

// sum over parts and terms of g_pi a_i.K_p b_i; a, b: n_q x n_z.
double weighted_products(const model::ElasticBody& body, const RelaxationLaw& law, const Eigen::MatrixXd& a,
                         const Eigen::MatrixXd& b) {
  double sum = 0;
  for (std::size_t p = 0; p < body.relaxing.size(); ++p) {
    const Eigen::MatrixXd K_b = body.relaxing[p].K * b;
    const Eigen::RowVectorXd products = a.cwiseProduct(K_b).colwise().sum();
    sum += law.g.row(static_cast<Eigen::Index>(p)).dot(products);
  }
  return sum;
}

}  // namespace

RelaxationLaw relaxation_law(const model::ElasticBody& body) {
  std::vector<double> tau;
  for (const model::RelaxingPart& part : body.relaxing)
    tau.insert(tau.end(), part.tau.begin(), part.tau.end());
  std::sort(tau.begin(), tau.end());
  tau.erase(std::unique(tau.begin(), tau.end()), tau.end());
  RelaxationLaw law{Eigen::VectorXd::Map(tau.data(), static_cast<Eigen::Index>(tau.size())), {}};
  law.g.setZero(static_cast<Eigen::Index>(body.relaxing.size()), law.n_z());
  for (std::size_t p = 0; p < body.relaxing.size(); ++p) {
    const model::RelaxingPart& part = body.relaxing[p];
    for (Eigen::Index i = 0; i < part.tau.size(); ++i) {
      const auto at = std::lower_bound(tau.begin(), tau.end(), part.tau[i]) - tau.begin();
      law.g(static_cast<Eigen::Index>(p), at) += part.g[i];
    }
  }
  return law;
}

Eigen::VectorXd following_shares(const RelaxationLaw& law, double dt) {
  return law.tau.unaryExpr([dt](double tau) { return following_share(dt / tau); });
}

Eigen::MatrixXd internal_variables(const RelaxationLaw& law, const InternalState& start, const StepPoint& at,
                                   const Eigen::VectorXd& q) {
  const Eigen::VectorXd c = following_shares(law, at.dt), change = q - start.q;
  Eigen::MatrixXd z = start.z;
  for (Eigen::Index i = 0; i < law.n_z(); ++i) {
    const double relaxed = -std::expm1(-at.dt / law.tau[i]);
    z.col(i) += at.alpha * relaxed * (start.q - start.z.col(i)) + c[i] * change;
  }
  return z;
}

Eigen::VectorXd relaxed_force(const model::ElasticBody& body, const Eigen::MatrixXd& w) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(body.n_q());
  for (std::size_t p = 0; p < body.relaxing.size(); ++p)
    force += body.relaxing[p].K * w.col(static_cast<Eigen::Index>(p));
  return force;
}

double relaxed_energy(const model::ElasticBody& body, const RelaxationLaw& law, const Eigen::VectorXd& q,
                      const Eigen::MatrixXd& z) {
  return weighted_products(body, law, 0.5 * z - q.replicate(1, law.n_z()), z);
}

double relaxation_loss(const model::ElasticBody& body, const RelaxationLaw& law, const InternalState& from,
                       const InternalState& to) {
  const Eigen::MatrixXd lag = 0.5 * ((from.q + to.q).replicate(1, law.n_z()) - from.z - to.z);
  return weighted_products(body, law, lag, to.z - from.z);
}

}  // namespace elastogear::body
