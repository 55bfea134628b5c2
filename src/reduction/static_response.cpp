#include "elastogear/reduction/static_response.h"

#include <algorithm>

#include "elastogear/base/error.h"
#include "elastogear/fem/assembly.h"
#include "elastogear/fem/material.h"
#include "elastogear/fem/stress.h"
#include "elastogear/reduction/factorisation.h"

namespace elastogear::reduction {
namespace {

constexpr Eigen::Index kBlock = 32;  // right-hand sides that go through the factor together

fem::RowNumbering number_free_nodes(const io::BodySource& source) {
  std::vector<bool> is_free(source.mesh.n_nodes(), false);
  for (int dof : source.free_dof) is_free[dof / 3] = true;
  const auto n_free = std::count(is_free.begin(), is_free.end(), true);
  require(3 * n_free == static_cast<std::ptrdiff_t>(source.free_dof.size()), "a static solution needs ",
          "nodes that are held in all three directions or in none; here ", n_free, " nodes have ",
          source.free_dof.size(), " free displacements");
  return fem::number_rows(source.mesh, is_free, std::vector<int>(source.mesh.cells.size(), 0), 1);
}

fem::Matrices assemble_serial(const io::BodySource& source, const fem::RowNumbering& rows) {
  const std::vector<int> region = fem::cell_regions(source.mesh, source.regions);
  const fem::Share share = fem::distribute(PETSC_COMM_SELF, source.mesh, region, rows);
  return fem::assemble(PETSC_COMM_SELF, share, source.regions, source.element);
}

}  // namespace

struct StaticResponse::Data {
  const io::BodySource& source;
  fem::RowNumbering rows;
  fem::Matrices matrices;
  ShiftedFactor factor;

  explicit Data(const io::BodySource& body)
      : source(body),
        rows(number_free_nodes(body)),
        matrices(assemble_serial(body, rows)),
        factor(matrices.K, matrices.M) {
    factor.factorise(0);
  }

  Eigen::Index n_rows() const { return 3 * static_cast<Eigen::Index>(rows.node.size()); }

  // Columns of S in the order of K's rows.
  model::SparseRows in_rows(const model::SparseRows& S) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < S.outerSize(); ++i)
      for (model::SparseRows::InnerIterator it(S, i); it; ++it) {
        const int row = rows.row[it.col() / 3];
        if (row >= 0) entries.emplace_back(i, static_cast<int>(3 * row + it.col() % 3), it.value());
      }
    model::SparseRows result(S.rows(), n_rows());
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }
};

StaticResponse::StaticResponse(const io::BodySource& source) : data_(new Data(source)) {}
StaticResponse::~StaticResponse() = default;

Eigen::VectorXd StaticResponse::displacement(const std::vector<int>& loaded, const Eigen::Matrix3Xd& f) {
  const auto& row = data_->rows.row;
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(data_->n_rows(), 1);
  for (std::size_t i = 0; i < loaded.size(); ++i)
    if (row[loaded[i]] >= 0) x.block<3, 1>(3 * row[loaded[i]], 0) += f.col(static_cast<Eigen::Index>(i));
  data_->factor.solve(x);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(row.size()));
  for (std::size_t node = 0; node < row.size(); ++node)
    if (row[node] >= 0) u.segment<3>(3 * static_cast<Eigen::Index>(node)) = x.block<3, 1>(3 * row[node], 0);
  return u;
}

Eigen::MatrixXd StaticResponse::stress(const std::vector<int>& loaded, const std::vector<int>& evaluated) {
  const io::BodySource& source = data_->source;
  const model::SparseRows S =
      data_->in_rows(fem::stress_operator(source.mesh, source.regions, source.element, evaluated));
  const auto n = 3 * static_cast<Eigen::Index>(loaded.size());
  Eigen::MatrixXd G(S.rows(), n);
  for (Eigen::Index begin = 0; begin < n; begin += kBlock) {
    const Eigen::Index count = std::min(kBlock, n - begin);
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(data_->n_rows(), count);
    for (Eigen::Index j = 0; j < count; ++j) {
      const int row = data_->rows.row[loaded[(begin + j) / 3]];
      if (row >= 0) x(3 * row + (begin + j) % 3, j) = 1;
    }
    data_->factor.solve(x);
    G.middleCols(begin, count) = S * x;
  }
  return G;
}

}  // namespace elastogear::reduction
