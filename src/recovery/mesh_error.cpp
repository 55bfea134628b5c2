#include "recovery/mesh_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "elastogear/recovery/patch_error.h"
#include "elastogear/recovery/stress.h"

namespace elastogear::recovery {
namespace {

using model::SparseRows;

constexpr Eigen::Index kTimesInMemory = 64;  // output times whose tensors are in memory
constexpr std::size_t kNearest = 8;          // nodes on free surfaces that tell the error of one off them
constexpr int kMostRings = 64;               // of faces around a set, until they meet a free surface

// Around n nodes: those of a set and, where none of these is on a free surface, others that are.
struct Patches {
  std::vector<int> node;                  // mesh numbers: those n nodes, then others around them
  std::vector<std::vector<int>> members;  // n, indices into `node`: of the patch, free or loaded as its node
  std::vector<int> order;                 // n, of the cells; of means none
  SparseRows difference;                  // at `node`: of free ones (1.16), of loaded ones (1.16a), else zero
  std::vector<char> free, loaded;         // marks at `node`

  Eigen::Index n() const { return static_cast<Eigen::Index>(members.size()); }
  bool is_free(std::size_t i) const { return free[i] != 0; }
  bool is_loaded(std::size_t i) const { return loaded[i] != 0; }
};

// A mark for each node that has rows.
std::vector<char> marks(const SparseRows& rows) {
  std::vector<char> result(static_cast<std::size_t>(rows.rows() / 6));
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = rows.middleRows(6 * static_cast<Eigen::Index>(i), 6).nonZeros() > 0 ? 1 : 0;
  return result;
}

// Means have no patch but their node.
Patches make_patches(const RecoveredBody& body, const model::ElasticBody& elastic,
                     const io::BodySource& source, const std::vector<int>& nodes) {
  Patches patches{nodes, {}, {}, {}, {}, {}};
  std::map<int, int> index;
  for (std::size_t i = 0; i < nodes.size(); ++i) index[nodes[i]] = static_cast<int>(i);
  const bool averaged = source.recovery.method == model::RecoveryMethod::average;
  SurfacePatches around;
  if (!averaged) around = body.finite_elements.surface_patches(source, nodes);
  patches.order = around.order;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    std::vector<int>& members = patches.members.emplace_back();
    for (int node : averaged ? std::vector<int>{nodes[i]} : around.node[i]) {
      const auto [at, is_new] = index.try_emplace(node, static_cast<int>(patches.node.size()));
      if (is_new) patches.node.push_back(node);
      members.push_back(at->second);
    }
  }
  const FiniteElements& elements = body.finite_elements;
  const SparseRows free = elements.recovery_difference(source, elastic.surface.node, patches.node),
                   loaded = elements.difference_within_surface(source, elastic.surface.node, patches.node);
  patches.free = marks(free);
  patches.loaded = marks(loaded);
  patches.difference = free + loaded;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::vector<char>& same = patches.is_free(i) ? patches.free : patches.loaded;
    std::erase_if(patches.members[i], [&](int j) { return same[static_cast<std::size_t>(j)] == 0; });
  }
  return patches;
}

// Nodes on free surfaces that share a face with nodes around the given ones, in as few rings of faces as it
// takes; none where no ring meets a free surface.
std::vector<int> free_nodes_beside(const FiniteElements& elements, const io::BodySource& source,
                                   const std::vector<int>& loaded, const std::vector<int>& nodes) {
  const std::set<int> is_loaded(loaded.begin(), loaded.end());
  std::set<int> inside(nodes.begin(), nodes.end());
  std::vector<int> edge = nodes;
  for (int ring = 0; ring < kMostRings && !edge.empty(); ++ring) {
    std::vector<int> beside, without_load;
    for (const std::vector<int>& around : elements.surface_patches(source, edge).node)
      for (int node : around) {
        if (!inside.insert(node).second) continue;
        beside.push_back(node);
        if (!is_loaded.contains(node)) without_load.push_back(node);
      }
    if (!without_load.empty()) {
      const std::vector<char> is_free = marks(elements.recovery_difference(source, loaded, without_load));
      std::vector<int> found;
      for (std::size_t i = 0; i < without_load.size(); ++i)
        if (is_free[i] != 0) found.push_back(without_load[i]);
      if (!found.empty()) return found;
    }
    edge = std::move(beside);
  }
  return {};
}

// The patches around the nodes of a set and, where none of these is on a free surface, around nodes beside
// the set that are.
Patches patches_of_set(const RecoveredBody& body, const model::ElasticBody& elastic,
                       const io::BodySource& source, std::vector<int> nodes) {
  Patches patches = make_patches(body, elastic, source, nodes);
  if (std::any_of(patches.free.begin(), patches.free.begin() + patches.n(),
                  [](char mark) { return mark != 0; }))
    return patches;
  const std::vector<int> beside =
      free_nodes_beside(body.finite_elements, source, elastic.surface.node, nodes);
  if (beside.empty()) return patches;
  nodes.insert(nodes.end(), beside.begin(), beside.end());
  return make_patches(body, elastic, source, nodes);
}

// Applies rows to the displacements of a body at the times of coordinates.
class Rows {
 public:
  Rows(const SparseRows& S, const std::string& file, const model::ElasticBody& elastic)
      : S_(S), file_(file), modal_(elastic.basis == model::Basis::modal) {
    if (!modal_) return;
    of_modes_.resize(S_.rows(), elastic.n_q());
    io::visit_modes(file, elastic.n_q(),
                    [&](Eigen::Index k, const Eigen::VectorXd& phi) { of_modes_.col(k) = S_ * phi; });
  }

  // von Mises stresses, one row a node. q: n_q x n_t.
  Eigen::MatrixXd von_mises_of(const Eigen::MatrixXd& q) const {
    if (modal_) return von_mises(Eigen::MatrixXd(of_modes_ * q));
    Eigen::MatrixXd result(S_.rows(), q.cols());
    for (Eigen::Index t = 0; t < q.cols(); ++t) {
      const Eigen::Matrix3Xd u = io::read_displacement_field(file_, q.col(t));
      result.col(t) = S_ * u.reshaped();
    }
    return von_mises(result);
  }

 private:
  SparseRows S_;
  const std::string& file_;
  bool modal_;
  Eigen::MatrixXd of_modes_;
};

// Terms of the errors at the n nodes of patches at n_t times, Pa; sums over time are in Pa^2.
struct Parts {
  Eigen::MatrixXd
      error;  // n x n_t, of the modes' displacements, Eq. (1.17) or first factor of (1.18a); else 0
  Eigen::MatrixXd more;  // von Mises stress of what the set has beside the stress of the modes, a row a node
  Eigen::VectorXd sum_error, sum_stress, sum_largest;  // n: of squares of errors, stresses, patches' largest
  Eigen::VectorXd sum_mean;                            // n: of squares of errors of means
};

void add_errors(const Patches& patches, const Eigen::MatrixXd& difference, const Eigen::MatrixXd& stress,
                bool averaged, Eigen::Index begin, Parts& parts) {
  for (Eigen::Index i = 0; i < patches.n(); ++i) {
    const auto node = static_cast<std::size_t>(i);
    const std::vector<int>& members = patches.members[node];
    const bool is_free = patches.is_free(node);
    if (!is_free && !patches.is_loaded(node)) continue;
    const int order = averaged ? 1 : patches.order[node];
    for (Eigen::Index t = 0; t < stress.cols(); ++t) {
      PatchError e{difference(i, t), difference(i, t), stress(i, t)};
      if (!is_free)
        e.error = error_within_surface(difference(members, t), stress(members, t), order);
      else if (!averaged)
        e = patch_error(difference(members, t), stress(members, t), order);
      parts.error(i, begin + t) = e.error;
      parts.sum_error[i] += e.error * e.error;
      parts.sum_stress[i] += stress(i, t) * stress(i, t);
      parts.sum_largest[i] += e.largest * e.largest;
      parts.sum_mean[i] += e.of_mean * e.of_mean;
    }
  }
}

Parts find_parts(const RecoveredBody& body, const model::ElasticBody& elastic, const io::StressSet& set,
                 const io::BodySource& source, const Patches& patches) {
  const Eigen::MatrixXd& q = body.run.history.q;
  const std::vector<int>& members = elastic.stress.sets.at(set.set);
  const std::vector<int> others(patches.node.begin() + std::ssize(set.node), patches.node.end());
  const Rows difference(patches.difference, body.run.file, elastic),
      stress_of_others(body.finite_elements.stress_operator(source, others), body.run.file, elastic);
  const Eigen::Index n = patches.n(), n_t = q.cols();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
  Parts parts{
      Eigen::MatrixXd::Zero(n, n_t), Eigen::MatrixXd(std::ssize(set.node), n_t), zero, zero, zero, zero};
  const bool averaged = source.recovery.method == model::RecoveryMethod::average;
  for (Eigen::Index begin = 0; begin < n_t; begin += kTimesInMemory) {
    const Eigen::Index count = std::min(kTimesInMemory, n_t - begin);
    const Eigen::MatrixXd q_t = q.middleCols(begin, count), own = modal_stress(elastic.stress, members, q_t);
    Eigen::MatrixXd stress(static_cast<Eigen::Index>(patches.node.size()), count);
    stress << von_mises(own), stress_of_others.von_mises_of(q_t);
    add_errors(patches, difference.von_mises_of(q_t), stress, averaged, begin, parts);
    parts.more.middleCols(begin, count) =
        von_mises(Eigen::MatrixXd(set.stress.middleCols(begin, count) - own));
  }
  return parts;
}

// Root of a ratio of sums of squares, at most 1. Recovered stresses vanish at corners of three free surfaces.
double share(double error, double stress) { return std::sqrt(error / std::max({stress, error, 1e-300})); }

// The share of errors in means near x, from the nodes of free surfaces nearest to it. docs/theory, Eq.
// (1.18a).
double share_nearby(const Parts& parts, const Eigen::Matrix3Xd& X, std::vector<int> free,
                    const Eigen::Vector3d& x) {
  const auto distance = [&](int j) { return (X.col(j) - x).squaredNorm(); };
  const auto end = free.begin() + static_cast<std::ptrdiff_t>(std::min(kNearest, free.size()));
  std::partial_sort(free.begin(), end, free.end(), [&](int a, int b) { return distance(a) < distance(b); });
  free.erase(end, free.end());
  return share(parts.sum_mean(free).sum(), parts.sum_largest(free).sum());
}

}  // namespace

bool tells_mesh_error(const RecoveredBody& body, const model::ElasticBody& elastic) {
  return elastic.n_q() > 0 && body.run.history.q.rows() == elastic.n_q() && !body.relaxes() &&
         elastic.assembled_K;
}

Eigen::MatrixXd mesh_error(const RecoveredBody& body, const model::ElasticBody& elastic,
                           const io::StressSet& set) {
  const std::string& file = body.run.file;
  const bool modal = elastic.basis == model::Basis::modal;
  if (!tells_mesh_error(body, elastic) || set.node.empty() || set.von_mises.cols() == 0) return {};
  if (modal && !io::has_full_modes(file)) return {};
  const io::BodySource source = io::read_body_source(file);
  const Patches patches = patches_of_set(body, elastic, source, set.node);
  std::vector<int> free;
  for (int i = 0; i < patches.n(); ++i)
    if (patches.is_free(static_cast<std::size_t>(i))) free.push_back(i);
  if (free.empty()) return {};
  const Parts parts = find_parts(body, elastic, set, source, patches);
  const Eigen::Matrix3Xd X = source.mesh.X(Eigen::all, patches.node);
  Eigen::MatrixXd error(set.von_mises.rows(), set.von_mises.cols());
  for (int i = 0; i < set.von_mises.rows(); ++i) {
    const auto node = static_cast<std::size_t>(i);
    error.row(i) = parts.error.row(i) + share(parts.sum_error[i], parts.sum_stress[i]) * parts.more.row(i);
    if (patches.is_free(node)) continue;
    const double near_by = share_nearby(parts, X, free, X.col(i));
    for (Eigen::Index t = 0; t < error.cols(); ++t)
      error(i, t) = patches.is_loaded(node) ? loaded_error(error(i, t), set.von_mises(i, t), near_by)
                                            : near_by * set.von_mises(i, t);
  }
  return error;
}

}  // namespace elastogear::recovery
