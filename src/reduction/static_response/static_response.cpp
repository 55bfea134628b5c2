#include "elastogear/reduction/static_response.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "elastogear/fem/elimination.h"
#include "elastogear/fem/gather.h"
#include "elastogear/fem/material.h"
#include "elastogear/fem/restraint.h"
#include "elastogear/fem/stress.h"
#include "elastogear/reduction/stressed_body.h"
#include "reduction/eigensolver/factorisation.h"
#include "reduction/static_response/inertia_relief.h"

namespace elastogear::reduction {
namespace {

constexpr Eigen::Index kSolvedTogether = 32;  // right-hand sides that go through the factor together

struct System {
  fem::Matrices matrices;
  std::vector<int> dof;  // displacement of every row
};

System assemble_serial(const io::BodySource& source) {
  const std::vector<mesh::Directions> held = fem::held_directions(source.free_dof, source.mesh.n_nodes());
  const fem::RowNumbering rows =
      fem::number_rows(source.mesh, fem::free_nodes(held), std::vector<int>(source.mesh.cells.size(), 0), 1);
  const std::vector<int> region = fem::cell_regions(source.mesh, source.regions);
  const fem::MeshPart share = fem::distribute(PETSC_COMM_SELF, source.mesh, region, rows);
  System system{fem::assemble(PETSC_COMM_SELF, share, source.regions, {source.element, source.element_mass}),
                fem::row_dofs(rows)};
  if (mesh::has_single_directions(held)) fem::eliminate(held, system.matrices, system.dof);
  return system;
}

// Row of each displacement, -1: held.
std::vector<int> rows_of(const System& system, int n_dofs) {
  std::vector<int> row(static_cast<std::size_t>(n_dofs), -1);
  for (std::size_t i = 0; i < system.dof.size(); ++i) row[system.dof[i]] = static_cast<int>(i);
  return row;
}

// Rigid motions about the middle of the nodes, at all rows.
Eigen::MatrixXd rigid_fields(const Eigen::Matrix3Xd& X, const std::vector<int>& dof) {
  const Eigen::Vector3d middle = X.rowwise().mean();
  Eigen::MatrixXd R(static_cast<Eigen::Index>(dof.size()), 6);
  for (std::size_t i = 0; i < dof.size(); ++i) {
    const Eigen::Vector3d direction = Eigen::Vector3d::Unit(dof[i] % 3), x = X.col(dof[i] / 3) - middle;
    R.row(static_cast<Eigen::Index>(i)) << direction.transpose(), x.cross(direction).transpose();
  }
  return R;
}

}  // namespace

struct StaticResponse::Data {
  const io::BodySource& source;
  System system;
  std::vector<int> row;                 // of each displacement, -1: held
  std::optional<InertiaRelief> relief;  // of a free body
  UniqueMat grounded;
  ShiftedFactor factor;

  Data(const io::BodySource& body, bool floating)
      : source(body),
        system(assemble_serial(body)),
        row(rows_of(system, 3 * body.mesh.n_nodes())),
        relief(floating ? std::make_optional<InertiaRelief>(system.matrices.M,
                                                            rigid_fields(body.mesh.X, system.dof))
                        : std::nullopt),
        grounded(relief ? relief->ground(system.matrices.K) : UniqueMat()),
        factor(relief ? grounded.get() : system.matrices.K.get(), system.matrices.M) {
    factor.factorise(0);
  }

  void solve(Eigen::MatrixXd& x) {
    if (relief) relief->balance(x);
    factor.solve(x);
    if (relief) relief->release(x);
  }

  Eigen::Index n_rows() const { return static_cast<Eigen::Index>(system.dof.size()); }

  // Columns of S in the order of K's rows.
  model::SparseRows in_rows(const model::SparseRows& S) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < S.outerSize(); ++i)
      for (model::SparseRows::InnerIterator it(S, i); it; ++it) {
        const int j = row[static_cast<std::size_t>(it.col())];
        if (j >= 0) entries.emplace_back(i, j, it.value());
      }
    model::SparseRows result(S.rows(), n_rows());
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }
};

StaticResponse::StaticResponse(const io::BodySource& source, bool floating)
    : data_(new Data(source, floating)) {}
StaticResponse::~StaticResponse() = default;

Eigen::VectorXd StaticResponse::displacement(const std::vector<int>& loaded, const Eigen::Matrix3Xd& f) {
  const std::vector<int>& row = data_->row;
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(data_->n_rows(), 1);
  for (std::size_t i = 0; i < loaded.size(); ++i)
    for (int d = 0; d < 3; ++d)
      if (const int j = row[3 * loaded[i] + d]; j >= 0) x(j, 0) += f(d, static_cast<Eigen::Index>(i));
  data_->solve(x);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(row.size()));
  u(data_->system.dof) = x.col(0);
  return u;
}

Eigen::MatrixXd StaticResponse::stress(const std::vector<int>& loaded, const std::vector<int>& evaluated) {
  const io::BodySource& source = data_->source;
  const model::SparseRows S = data_->in_rows(fem::stress_operator(stressed_body(source), evaluated));
  const auto n = 3 * static_cast<Eigen::Index>(loaded.size());
  Eigen::MatrixXd G(S.rows(), n);
  for (Eigen::Index begin = 0; begin < n; begin += kSolvedTogether) {
    const Eigen::Index count = std::min(kSolvedTogether, n - begin);
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(data_->n_rows(), count);
    for (Eigen::Index j = 0; j < count; ++j) {
      const Eigen::Index load = begin + j;
      const int row = data_->row[static_cast<std::size_t>(3 * loaded[load / 3] + load % 3)];
      if (row >= 0) x(row, j) = 1;
    }
    data_->solve(x);
    G.middleCols(begin, count) = S * x;
  }
  return G;
}

}  // namespace elastogear::reduction
