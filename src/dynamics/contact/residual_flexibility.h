#pragma once
// Residual flexibility R = F - Phi_c Lambda^-1 Phi_c' of one modal body: what the modes leave out of its
// static response to contact forces (docs/theory.md, Eq. (6.20)).

#include <Eigen/Core>
#include <array>
#include <unordered_map>
#include <vector>

#include "elastogear/dynamics/contact_loads.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::dynamics {

/// Blocks of R are computed when they are first asked for, and kept. For nodes that the body's flexibility
/// does not provide for R = 0: forces there deform the modes alone. Nodes are those of the surface.
class ResidualFlexibility {
 public:
  /// The body must outlive this.
  explicit ResidualFlexibility(const model::ElasticBody& body);

  /// The forces that displacement, largest and change refer to; x_B is not read.
  void set_forces(const NodalForces& forces);
  const NodalForces& forces() const { return forces_; }
  Eigen::Vector3d displacement(int node);      ///< m, BRF: sum_b R(node, b) f_b
  double largest() const { return largest_; }  ///< m/N, bound of |R(b, b)|
  double bound(const NodalForces& forces);     ///< m, no node is displaced farther by these forces
  /// R among the given nodes: 3 n x 3 n, m/N, symmetric. The reference is valid until other nodes are asked
  /// for.
  const Eigen::MatrixXd& among(const std::vector<int>& node);

 private:
  using Columns = Eigen::Matrix<float, Eigen::Dynamic, 3>;
  struct Loaded {
    int position;      // in the flexibility
    const Columns* F;  // of its orbit
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> Phi_over_Lambda;
  };
  struct Row {                       // of one node a
    std::vector<Eigen::Matrix3d> R;  // R(a, b) by the number of b; not yet known: NaN
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> packed = {};  // of the nodes of forces_,
    long packed_at = -1;                                                    // when n_changes_ was this
  };

  int number(int node);
  const Eigen::Matrix3d& block(Row& row, int a, int number);
  void pack(Row& row, int a);
  Row& row(int node);

  const model::ElasticBody* body_;
  double largest_ = 0;  // m/N, of |F(b, b)|
  NodalForces forces_;
  std::vector<int> numbers_;                  // of the nodes of forces_
  long n_changes_ = 0;                        // of these nodes
  std::unordered_map<int, int> number_of_;    // node -> number among those that were loaded so far, -1: R = 0
  std::unordered_map<int, Columns> columns_;  // of F, by orbit: images share them
  std::vector<Loaded> loaded_;                // these
  std::vector<Row> rows_;                     // of each node of the surface, empty before it is asked for
  std::size_t n_rows_ = 0;
  struct Among {
    std::vector<int> node = {};
    Eigen::MatrixXd R = {};
  };
  std::array<Among, 2> among_;  // asked for last, and before
};

}  // namespace elastogear::dynamics
