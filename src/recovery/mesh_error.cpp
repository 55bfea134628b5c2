#include "recovery/mesh_error.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "elastogear/io/body_file.h"
#include "elastogear/recovery/stress.h"

namespace elastogear::recovery {
namespace {

using model::SparseRows;

// For each node of a set, with places X (3 x n, m), the nearest node whose stress is recovered on the free
// surface: a node itself if its own stress is; -1 where no node's is.
std::vector<int> nearest_on_surface(const SparseRows& difference, const Eigen::Matrix3Xd& X) {
  std::vector<int> on_surface;
  for (int i = 0; i < X.cols(); ++i)
    if (difference.middleRows(6 * i, 6).eval().nonZeros() > 0) on_surface.push_back(i);
  std::vector<int> nearest(static_cast<std::size_t>(X.cols()), -1);
  if (on_surface.empty()) return nearest;
  for (int i = 0; i < X.cols(); ++i) {
    const auto distance = [&](int j) { return (X.col(j) - X.col(i)).squaredNorm(); };
    nearest[i] = *std::min_element(on_surface.begin(), on_surface.end(),
                                   [&](int a, int b) { return distance(a) < distance(b); });
  }
  return nearest;
}

constexpr Eigen::Index kTimesInMemory = 64;  // output times whose tensors are in memory

// von Mises stresses, Pa, of the set's n nodes over n_t times.
struct Parts {
  Eigen::MatrixXd difference;  // n x n_t, of the two recoveries of the modes' displacements
  Eigen::MatrixXd more;        // n x n_t, of what the set has beside the stress of the modes
  Eigen::VectorXd share;       // n, eta of Eq. (1.17), at most 1
};

Parts find_parts(const RecoveredBody& body, const model::ElasticBody& elastic, const io::StressSet& set,
                 const SparseRows& difference) {
  const Eigen::MatrixXd& q = body.run.history.q;
  const bool modal = elastic.basis == model::Basis::modal;
  Eigen::MatrixXd of_modes(difference.rows(), modal ? q.rows() : 0);
  if (modal)
    io::visit_modes(body.run.file, q.rows(),
                    [&](Eigen::Index k, const Eigen::VectorXd& phi) { of_modes.col(k) = difference * phi; });
  const auto at = [&](const Eigen::MatrixXd& q_t) -> Eigen::MatrixXd {  // 6 n x n_t
    if (modal) return of_modes * q_t;
    Eigen::MatrixXd result(difference.rows(), q_t.cols());
    for (Eigen::Index t = 0; t < q_t.cols(); ++t) {
      const Eigen::Matrix3Xd u = io::read_displacement_field(body.run.file, q_t.col(t));
      result.col(t) = difference * u.reshaped();
    }
    return result;
  };
  const std::vector<int>& members = elastic.stress.sets.at(set.set);
  const Eigen::Index n = set.von_mises.rows(), n_t = q.cols();
  Parts parts{Eigen::MatrixXd(n, n_t), Eigen::MatrixXd(n, n_t), {}};
  Eigen::VectorXd square = Eigen::VectorXd::Zero(n);  // of the modes' stress, summed over time
  for (Eigen::Index begin = 0; begin < n_t; begin += kTimesInMemory) {
    const Eigen::Index count = std::min(kTimesInMemory, n_t - begin);
    const Eigen::MatrixXd q_t = q.middleCols(begin, count),
                          stress = modal_stress(elastic.stress, members, q_t);
    parts.difference.middleCols(begin, count) = von_mises(at(q_t));
    parts.more.middleCols(begin, count) =
        von_mises(Eigen::MatrixXd(set.stress.middleCols(begin, count) - stress));
    square += von_mises(stress).rowwise().squaredNorm();
  }
  // Recovered stresses vanish at corners of three free surfaces.
  const Eigen::ArrayXd off = parts.difference.rowwise().squaredNorm();
  parts.share = (off / square.array().max(off).max(1e-300)).sqrt();
  return parts;
}

}  // namespace

bool tells_mesh_error(const RecoveredBody& body, const model::ElasticBody& elastic) {
  return body.run.history.q.rows() == elastic.n_q() && !body.relaxes() &&
         !elastic.provenance.contains("option_stiffness");
}

Eigen::MatrixXd mesh_error(const RecoveredBody& body, const model::ElasticBody& elastic,
                           const io::StressSet& set) {
  const std::string& file = body.run.file;
  const bool modal = elastic.basis == model::Basis::modal;
  if (!tells_mesh_error(body, elastic) || set.node.empty() || set.von_mises.cols() == 0) return {};
  if (modal && !io::has_full_modes(file)) return {};
  const io::BodySource source = io::read_body_source(file);
  const SparseRows difference =
      body.finite_elements.recovery_difference(source, elastic.surface.node, set.node);
  const std::vector<int> near = nearest_on_surface(difference, source.mesh.X(Eigen::all, set.node));
  if (near.front() < 0) return {};
  const Parts parts = find_parts(body, elastic, set, difference);
  Eigen::MatrixXd error(set.von_mises.rows(), set.von_mises.cols());
  for (Eigen::Index i = 0; i < error.rows(); ++i) {
    const int j = near[static_cast<std::size_t>(i)];
    if (j == i)
      error.row(i) = parts.difference.row(i) + parts.share[i] * parts.more.row(i);
    else
      error.row(i) = parts.share[j] * set.von_mises.row(i);
  }
  return error;
}

}  // namespace elastogear::recovery
