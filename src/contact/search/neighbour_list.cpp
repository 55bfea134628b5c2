#include "contact/search/neighbour_list.h"

#include <algorithm>

namespace elastogear::contact {
namespace {

// A set of numbers below n, for many insertions and one look.
class Marks {
 public:
  explicit Marks(Eigen::Index n) : is_set_(static_cast<std::size_t>(n), 0) {}
  void set(int i) {
    char& is_set = is_set_[static_cast<std::size_t>(i)];
    if (!is_set) numbers_.push_back(i);
    is_set = 1;
  }
  // A few are sorted; of many all marks are read in order.
  std::vector<int> ascending() {
    constexpr std::size_t kFew = 32;  // times fewer than there may be
    if (kFew * numbers_.size() < is_set_.size()) {
      std::sort(numbers_.begin(), numbers_.end());
      return std::move(numbers_);
    }
    numbers_.clear();
    for (std::size_t i = 0; i < is_set_.size(); ++i)
      if (is_set_[i]) numbers_.push_back(static_cast<int>(i));
    return std::move(numbers_);
  }

 private:
  std::vector<char> is_set_;
  std::vector<int> numbers_;
};

}  // namespace

Ball enclosing_ball(const Eigen::Matrix3Xd& X) {
  const Eigen::Vector3d centre = 0.5 * (X.rowwise().minCoeff() + X.rowwise().maxCoeff());
  return {centre, std::sqrt((X.colwise() - centre).colwise().squaredNorm().maxCoeff())};
}

RelativeMotion relative_motion(const SurfaceMotion& a, const SurfaceMotion& b) {
  return {b.R_WB.transpose() * a.R_WB, b.R_WB.transpose() * (a.r_WB - b.r_WB)};
}

double travel(const Ball& ball, const RelativeMotion& from, const RelativeMotion& to) {
  const Eigen::Matrix3d dR =
      to.R - from.R;  // its largest stretch is its Frobenius norm over the square root of 2
  return (dR * ball.centre + to.r - from.r).norm() + dR.norm() / std::sqrt(2.0) * ball.radius;
}

std::span<const int> Neighbours::faces(std::size_t i) const {
  const int begin = i == 0 ? 0 : end[i - 1];
  return std::span(face).subspan(begin, end[i] - begin);
}

std::span<const int> Neighbours::faces_around(std::size_t i) const {
  const int begin = i == 0 ? 0 : around_end[i - 1];
  return std::span(around).subspan(begin, around_end[i] - begin);
}

void Neighbours::add(int node, std::span<const int> faces, std::span<const int> beside) {
  slave.push_back(node);
  face.insert(face.end(), faces.begin(), faces.end());
  end.push_back(static_cast<int>(face.size()));
  around.insert(around.end(), beside.begin(), beside.end());
  around_end.push_back(static_cast<int>(around.size()));
}

Neighbours everything(const Candidates& candidates) {
  const int n = candidates.nodes().empty() ? 0 : candidates.nodes().back() + 1;
  return not_apart(candidates, std::vector<double>(n, 0), 0);
}

Neighbours not_apart(const Candidates& candidates, const std::vector<double>& apart_until, double path) {
  Neighbours near;
  for (int node : candidates.nodes())
    if (apart_until[node] <= path) near.add(node, candidates[node], {});
  return near;
}

Neighbours not_apart(const Neighbours& neighbours, const std::vector<double>& apart_until, double path) {
  Neighbours near;
  for (std::size_t i = 0; i < neighbours.slave.size(); ++i)
    if (apart_until[neighbours.slave[i]] <= path)
      near.add(neighbours.slave[i], neighbours.faces(i), neighbours.faces_around(i));
  return near;
}

std::vector<int> nodes_around(std::span<const int> faces, const Topology& topology,
                              const Eigen::Matrix4Xi& face) {
  Marks distinct(face.cols()), corners(topology.node_corners.size());
  for (int f : faces) distinct.set(f);
  for (int f : distinct.ascending())
    for (int node : face.col(f)) corners.set(node);
  return nodes_around_nodes(corners.ascending(), topology, face);
}

std::vector<int> nodes_around_nodes(const std::vector<int>& nodes, const Topology& topology,
                                    const Eigen::Matrix4Xi& face) {
  Marks around(topology.node_corners.size());
  for (int node : nodes) {
    around.set(node);
    for (int corner : topology.node_corners[node])
      for (int neighbour : face.col(corner / 4)) around.set(neighbour);
  }
  return around.ascending();
}

}  // namespace elastogear::contact
