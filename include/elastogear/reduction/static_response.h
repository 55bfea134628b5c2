#pragma once
// Static response of the unreduced body: displacement K^-1 f and stress S K^-1 f (docs/theory, section
// 4.1).

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "elastogear/io/body_file.h"

namespace elastogear::reduction {

/// Factorises K of the whole body, once, on this process alone; of a held cyclically symmetric body
/// the stiffness of its harmonics, anew in each call and one after the other, which takes less memory
/// (docs/theory, section 4.1). Nodes are mesh numbers; forces on restrained nodes do nothing.
class StaticResponse {
 public:
  /// The source must outlive this. floating: nothing holds the body, whose loads are balanced by the inertia
  /// of its cells, and whose displacements are orthogonal to rigid motions. Throws Error when a body is
  /// neither held nor floating, or the factorisation fails.
  explicit StaticResponse(const io::BodySource& source, bool floating = false);
  ~StaticResponse();
  StaticResponse(const StaticResponse&) = delete;
  StaticResponse& operator=(const StaticResponse&) = delete;

  /// 3 n_nodes x n_t, m, node-major, for forces f (3 n x n_t, N) on the n nodes `loaded`. Throws Error for
  /// another number of rows.
  Eigen::MatrixXd displacement(const std::vector<int>& loaded, const Eigen::MatrixXd& f);
  /// Stress at `evaluated` for unit forces in x, y, z on each of `loaded`: 6 n_e x 3 n, Pa/N.
  Eigen::MatrixXd stress(const std::vector<int>& loaded, const std::vector<int>& evaluated);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace elastogear::reduction
