#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "elastogear/fem/elimination.h"
#include "elastogear/fem/gather.h"
#include "elastogear/fem/material.h"
#include "elastogear/fem/restraint.h"
#include "reduction/eigensolver/factorisation.h"
#include "reduction/static_response/inertia_relief.h"
#include "reduction/static_response/whole_body_solver.h"

namespace elastogear::reduction {
namespace {

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

class WholeFactor final : public WholeBodySolver {
 public:
  WholeFactor(const io::BodySource& source, bool floating)
      : system_(assemble_serial(source)),
        relief_(floating ? std::make_optional<InertiaRelief>(system_.matrices.M,
                                                             rigid_fields(source.mesh.X, system_.dof))
                         : std::nullopt),
        grounded_(relief_ ? relief_->ground(system_.matrices.K) : UniqueMat()),
        factor_(relief_ ? grounded_.get() : system_.matrices.K.get(), system_.matrices.M) {
    factor_.factorise(0);
  }

  void visit_parts(const std::function<void(const Solve&)>& visit) override {
    visit([this](const Eigen::MatrixXd& f) { return solve(f); });
  }

 private:
  Eigen::MatrixXd solve(const Eigen::MatrixXd& f) {
    Eigen::MatrixXd x = f(system_.dof, Eigen::all), u = Eigen::MatrixXd::Zero(f.rows(), f.cols());
    if (relief_) relief_->balance(x);
    factor_.solve(x);
    if (relief_) relief_->release(x);
    u(system_.dof, Eigen::all) = x;
    return u;
  }

  System system_;
  std::optional<InertiaRelief> relief_;  // of a free body
  UniqueMat grounded_;
  ShiftedFactor factor_;
};

}  // namespace

std::unique_ptr<WholeBodySolver> factorise_whole(const io::BodySource& source, bool floating) {
  return std::make_unique<WholeFactor>(source, floating);
}

}  // namespace elastogear::reduction
