#pragma once
// Static responses where they are wanted, P K^-1 P', by nested dissection (docs/theory, Eq. (6.20a)).

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <functional>
#include <variant>
#include <vector>

#include "elastogear/base/petsc.h"
#include "elastogear/model/elastic_body.h"
#include "reduction/static_response/inertia_relief.h"
#include "reduction/static_response/nested/contribution.h"
#include "reduction/static_response/nested/elimination.h"

namespace elastogear::reduction {

/// Estimated flops of n_loads columns of P K^-1 P', right within a factor of about two for meshes in space.
struct ResponseFlops {
  double nested;  ///< part by part
  double whole;   ///< by a factor of all of K and a solution for each load
};
/// unknowns: rows of K; wanted: rows of P.
ResponseFlops response_flops(double unknowns, double wanted, double n_loads);

/// Parts of K are eliminated one after the other, from leaves to the root of the dissection. What is wanted
/// of a part is kept as a dense matrix over its border, so that nothing is solved for at rows that nobody
/// asks for. Parts are eliminated in double precision; what they add to
/// responses is in single precision, but for free bodies, where rigid motions cancel.
class NestedResponse {
 public:
  /// K: sequential, symmetric, positive definite; of a free body grounded (reduction::InertiaRelief), with
  /// its rigid motions: loads then are balanced by inertia, and displacements are without rigid motion. P:
  /// what is wanted of the displacements, a row each. loads: rows of P that are loads, too. progress: takes
  /// the share of the work that is done, by the constructor and by next(); may be empty. Throws Error when K
  /// is not positive definite.
  NestedResponse(Mat K, const model::SparseRows& P, const std::vector<int>& loads,
                 const RigidFields& rigid = {}, int largest_leaf = 0,
                 std::function<void(double)> progress = {});

  /// The same of a held body whose rows `kept`, ascending, stay where they are: to the responses then comes
  /// what their displacements add.
  NestedResponse(Mat K, const model::SparseRows& P, const std::vector<int>& loads,
                 const std::vector<int>& kept, KeptRows& left, std::function<void(double)> progress = {});

  /// The loads in groups that go through the parts together.
  const std::vector<std::vector<int>>& groups() const { return groups_; }
  /// P K^-1 P(loads, :)' of the next group, a column for each of its loads. Rows that were loads of earlier
  /// groups are left out, 0: they stand in the columns of these (fill_symmetric).
  Eigen::MatrixXf next();

 private:
  template <class T>
  Dense<T> plain(const std::vector<int>& loads) const;
  Eigen::MatrixXf balanced(const std::vector<int>& loads) const;
  std::function<void(double)> report_elimination();
  void group(std::vector<int> loads);
  void balance(const model::SparseRows& P, const RigidFields& rigid);

  Eigen::Index n_rows_;  // of P
  std::function<void(double)> progress_;
  double eliminated_ = 0;  // share of the work
  std::variant<Contributions<float>, Contributions<double>> contributions_;
  std::vector<std::vector<int>> groups_;
  std::size_t next_ = 0;
  Eigen::MatrixXd P_R_;    // of a free body: P R
  Eigen::MatrixXd drift_;  // and P K^-1 M R without the rigid motion in it
};

}  // namespace elastogear::reduction
