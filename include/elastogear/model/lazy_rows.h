#pragma once
// Rows of a basis at the nodes of a surface that are read when they are first asked for, and what is known of
// them before: contact touches few of the nodes, and the rows of all may be gigabytes.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace elastogear::model {

/// Rows of a basis at selected nodes, blocks of 3 (Phi: x y z) or 6 (Psi: xx yy zz xy yz xz) per node.
using DenseRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What a run asks of the rows Phi_i of all nodes i of a surface. K_r and M_r are diagonal. docs/theory,
/// Eqs. (5.4) and (8.18).
struct RowBounds {
  Eigen::VectorXd compliance;             ///< n_s, m/N, largest eigenvalue of Phi_i K_r^-1 Phi_i'
  Eigen::VectorXd mobility;               ///< n_s, 1/kg, largest diagonal entry of Phi_i M_r^-1 Phi_i'
  Eigen::VectorXd square;                 ///< n_s, squared norm of Phi_i
  Eigen::VectorXd largest;                ///< n_q, largest size of an entry in each column
  double strain = 0;                      ///< 1/J, as compliance, of the watched edges over their length
  std::array<std::uint64_t, 4> digest{};  ///< block_digest of all rows
};

/// Copies share what has been read.
class LazyRows {
 public:
  /// Reads the rows of nodes first .. first + n - 1 to `rows`, 3 n x n_q. Throws Error where it cannot.
  using Read = std::function<void(Eigen::Index first, Eigen::Index n, double* rows)>;

  /// n_at_once: nodes that are read together.
  LazyRows(RowBounds bounds, Eigen::Index n_at_once, Read read);

  Eigen::Index rows() const { return 3 * state_->bounds.compliance.size(); }
  Eigen::Index cols() const { return state_->bounds.largest.size(); }
  const RowBounds& bounds() const { return state_->bounds; }
  /// The three rows of a node, one after the other.
  const double* node(Eigen::Index node) const {
    if (!state_->is_read[static_cast<std::size_t>(node / state_->n_at_once)])
      read(node / state_->n_at_once, node / state_->n_at_once + 1);
    return state_->rows.data() + 3 * node * cols();
  }
  /// Reads whatever has not been read.
  const DenseRows& all() const;

 private:
  struct State {
    RowBounds bounds;
    Eigen::Index n_at_once;
    Read read;
    DenseRows rows;
    std::vector<bool> is_read;  // by group of n_at_once nodes
  };
  void read(Eigen::Index group, Eigen::Index end) const;

  std::shared_ptr<State> state_;
};

}  // namespace elastogear::model
