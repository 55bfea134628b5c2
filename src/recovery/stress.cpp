#include "elastogear/recovery/stress.h"

#include <algorithm>
#include <cmath>

#include "elastogear/base/dense_product.h"
#include "recovery/tensors/largest_principal.h"

namespace elastogear::recovery {
namespace {

using Coordinates = Eigen::Ref<const Eigen::MatrixXd>;

bool are_consecutive(const std::vector<int>& members) {
  return std::adjacent_find(members.begin(), members.end(), [](int a, int b) { return b != a + 1; }) ==
         members.end();
}

// rows * q; rows: of a matrix that is stored row by row.
void multiply_dense(const double* rows, const Coordinates& q, Eigen::Ref<Eigen::MatrixXd> sigma) {
  const Eigen::Map<const Eigen::MatrixXd> transposed(rows, q.rows(), sigma.rows());
  multiply(Op::transposed, Op::plain, 1., transposed, q, 0., sigma);
}

// The stresses of a reduced basis.
void multiply_rows(const model::DenseRows& Psi, const std::vector<int>& members, const Coordinates& q,
                   Eigen::MatrixXd& sigma) {
  if (members.empty()) return;
  if (are_consecutive(members))
    return multiply_dense(Psi.data() + 6 * members.front() * Psi.cols(), q, sigma);
  constexpr Eigen::Index kTogether = 256;  // nodes: fewer would pack q anew for each product
  const auto n = static_cast<Eigen::Index>(members.size());
  for (Eigen::Index first = 0; first < n; first += kTogether) {
    const Eigen::Index count = std::min(kTogether, n - first);
    model::DenseRows rows(6 * count, Psi.cols());
    for (Eigen::Index i = 0; i < count; ++i)
      rows.middleRows<6>(6 * i) = Psi.middleRows<6>(6 * members[static_cast<std::size_t>(first + i)]);
    multiply_dense(rows.data(), q, sigma.middleRows(6 * first, 6 * count));
  }
}

// The stresses of the full basis, whose rows touch the displacements of the cells around a node alone.
void multiply_rows(const model::SparseRows& Psi, const std::vector<int>& members, const Coordinates& q,
                   Eigen::MatrixXd& sigma) {
  for (std::size_t i = 0; i < members.size(); ++i)
    sigma.middleRows<6>(6 * static_cast<Eigen::Index>(i)) = Psi.middleRows(6 * members[i], 6) * q;
}

}  // namespace

double von_mises(const StressVector& s) {
  const double normal = std::pow(s[0] - s[1], 2) + std::pow(s[1] - s[2], 2) + std::pow(s[2] - s[0], 2);
  const double shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
  return std::sqrt(normal / 2 + 3 * shear);
}

double rankine(const StressVector& s) {
  double largest = 0;
  largest_principal(s.data(), 1, &largest);
  return largest;
}

Eigen::MatrixXd von_mises(const Eigen::MatrixXd& stress) {
  Eigen::MatrixXd result(stress.rows() / 6, stress.cols());
  for (Eigen::Index i = 0; i < result.size(); ++i)
    result.data()[i] = von_mises(StressVector(stress.data() + 6 * i));
  return result;
}

Eigen::MatrixXd rankine(const Eigen::MatrixXd& stress) {
  Eigen::MatrixXd result(stress.rows() / 6, stress.cols());
  largest_principal(stress.data(), result.size(), result.data());
  return result;
}

Eigen::MatrixXd modal_stress(const model::Stress& stress, const std::vector<int>& members,
                             const Coordinates& q) {
  const auto n = static_cast<Eigen::Index>(members.size());
  Eigen::MatrixXd sigma(6 * n, q.cols());
  model::with_rows(stress.Psi, [&](const auto& Psi) { multiply_rows(Psi, members, q, sigma); });
  return sigma;
}

Eigen::MatrixXd stress_of_part(Eigen::MatrixXd stress, model::ModulusPart part) {
  if (part == model::ModulusPart::both) return stress;
  for (Eigen::Index t = 0; t < stress.cols(); ++t)
    for (Eigen::Index i = 0; i < stress.rows(); i += 6) {
      auto normal = stress.col(t).segment<3>(i);
      const double mean = normal.mean();
      if (part == model::ModulusPart::shear) {
        normal.array() -= mean;
      } else {
        normal.setConstant(mean);
        stress.col(t).segment<3>(i + 3).setZero();
      }
    }
  return stress;
}

Eigen::MatrixXd relaxed_stress(const model::ElasticBody& body, const std::vector<int>& members,
                               const Coordinates& w) {
  Eigen::MatrixXd relaxed = Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(members.size()), w.cols());
  for (std::size_t p = 0; p < body.relaxing.size(); ++p) {
    const model::RelaxingPart& part = body.relaxing[p];
    std::vector<int> own, place;  // members of the part's region, and their places
    for (std::size_t i = 0; i < members.size(); ++i)
      if (std::binary_search(part.stress_node.begin(), part.stress_node.end(), members[i])) {
        own.push_back(members[i]);
        place.push_back(static_cast<int>(i));
      }
    const Eigen::MatrixXd of_part = stress_of_part(
        modal_stress(body.stress, own, w.middleRows(static_cast<Eigen::Index>(p) * body.n_q(), body.n_q())),
        part.part);
    for (std::size_t i = 0; i < place.size(); ++i)
      relaxed.middleRows<6>(6 * place[i]) += of_part.middleRows<6>(6 * static_cast<Eigen::Index>(i));
  }
  return relaxed;
}

StressHistory stress_history(const model::Stress& stress, const std::vector<int>& members,
                             const Eigen::MatrixXd& q, const Eigen::MatrixXd& sigma_static) {
  StressHistory history;
  for (int member : members) history.node.push_back(stress.node[member]);
  history.stress = modal_stress(stress, members, q);
  if (sigma_static.size() > 0) history.stress += sigma_static;
  history.von_mises = von_mises(history.stress);
  history.rankine = rankine(history.stress);
  return history;
}

}  // namespace elastogear::recovery
