#include "dynamics/contact/response_newton.h"

#include <Eigen/LU>
#include <algorithm>

namespace elastogear::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Number of leading columns of a contact, which change its force at an unchanged closest point: the one along
// n, or three where the force has no potential. On an extension all columns change it.
Eigen::Index leading_columns(const contact::ContactPoint& point) {
  if (point.V_dot.cols() == 0) return 1;
  constexpr Eigen::Index kOnExtension = 15;
  return point.W.cols() == kOnExtension ? kOnExtension : std::min<Eigen::Index>(3, point.W.cols());
}

}  // namespace

ResponseNewton::ResponseNewton(const std::vector<PairContacts>& pairs) {
  Eigen::Index column = 0;
  for (const PairContacts& pair : pairs)
    for (const contact::ContactPoint& point : pair.points) {
      contacts_.push_back({&point, &pair, column, static_cast<Eigen::Index>(leading_.size())});
      for (Eigen::Index i = 0; i < leading_columns(point); ++i) leading_.push_back(column + i);
      column += point.W.cols();
    }
  right_ = VectorXd::Zero(column);
}

void ResponseNewton::add(const Compliant& compliant, const VectorXd& missing) {
  Body body{{}, &compliant.R};
  for (const Contact& contact : contacts_)
    for (int i = 0; i < contact.point->n_local(); ++i) {
      const LocalNode local = local_node(*contact.point, i);
      if (contact.pair->body[local.side] != static_cast<int>(compliant.body)) continue;
      const auto at = std::lower_bound(compliant.node.begin(), compliant.node.end(), local.node);
      const Eigen::Matrix3d R_BW = compliant.R_WB.transpose();
      body.touches.push_back({contact, 3 * (at - compliant.node.begin()),
                              R_BW * contact.point->W.middleRows<3>(3 * i),
                              R_BW * contact.point->displacement_columns().middleRows<3>(3 * i)});
    }
  for (const SlaveContact& t : body.touches)
    right_.segment(t.contact.column, t.V_B.cols()) += t.V_B.transpose() * missing.segment<3>(t.row);
  bodies_.push_back(std::move(body));
}

VectorXd ResponseNewton::multiply_k(const VectorXd& lambda) const {
  VectorXd y(lambda.size());
  for (const Contact& c : contacts_) {
    const Eigen::Index n = c.point->k.rows();
    y.segment(c.column, n) = c.point->k * lambda.segment(c.column, n);
  }
  return y;
}

VectorXd ResponseNewton::loads(const Body& body, const VectorXd& k_lambda) {
  VectorXd f = VectorXd::Zero(body.R->rows());
  for (const SlaveContact& t : body.touches)
    f.segment<3>(t.row) += t.W_B * k_lambda.segment(t.contact.column, t.W_B.cols());
  return f;
}

VectorXd ResponseNewton::multiply(const VectorXd& lambda) const {
  const VectorXd k_lambda = multiply_k(lambda);
  VectorXd y = lambda;
  for (const Body& body : bodies_) {
    const VectorXd w = *body.R * loads(body, k_lambda);
    for (const SlaveContact& t : body.touches)
      y.segment(t.contact.column, t.V_B.cols()) += t.V_B.transpose() * w.segment<3>(t.row);
  }
  return y;
}

void ResponseNewton::add_leading(const Body& body, MatrixXd& A) {
  MatrixXd w = MatrixXd::Zero(body.R->rows(), A.cols());
  for (const SlaveContact& t : body.touches)
    for (Eigen::Index j = 0; j < leading_columns(*t.contact.point); ++j) {
      const Eigen::Vector3d f = t.W_B * t.contact.point->k.col(j);
      w.col(t.contact.leading + j) += body.R->middleCols<3>(t.row) * f;
    }
  for (const SlaveContact& t : body.touches)
    for (Eigen::Index i = 0; i < leading_columns(*t.contact.point); ++i)
      A.row(t.contact.leading + i) += t.V_B.col(i).transpose() * w.middleRows<3>(t.row);
}

MatrixXd ResponseNewton::leading_block() const {
  const auto n = static_cast<Eigen::Index>(leading_.size());
  MatrixXd A = MatrixXd::Identity(n, n);
  for (const Body& body : bodies_) add_leading(body, A);
  return A;
}

// Solves by fixed-point iteration with the leading block. The other columns are of the order of the
// penetration over the radius of curvature, so that it converges fast.
VectorXd ResponseNewton::solve() const {
  constexpr int kMostRounds = 20;
  constexpr double kTolerance = 1e-8;
  const Eigen::PartialPivLU<MatrixXd> lu(leading_block());
  VectorXd lambda = VectorXd::Zero(right_.size()), rest = right_;
  for (int round = 0; round < kMostRounds && rest.norm() > kTolerance * right_.norm(); ++round) {
    const VectorXd leading = lu.solve(VectorXd(rest(leading_)));
    VectorXd change = rest;
    change(leading_) = leading;
    lambda += change;
    rest = right_ - multiply(lambda);
  }
  return lambda;
}

VectorXd ResponseNewton::force_change(std::size_t i, const VectorXd& lambda) const {
  return loads(bodies_[i], multiply_k(lambda));
}

}  // namespace elastogear::dynamics
