#include <optional>
#include <utility>
#include <vector>

#include "elastogear/base/memory.h"
#include "elastogear/fem/material.h"
#include "elastogear/fem/restraint.h"
#include "elastogear/fem/sector_assembly.h"
#include "reduction/cyclic/condensed_sector.h"
#include "reduction/static_response/whole_body_solver.h"

namespace elastogear::reduction {
namespace {

// K_k, factorised.
class Factor {
 public:
  /// All are borrowed. condensed: nullptr where the harmonic is to have matrices of its own.
  Factor(const io::BodySource& source, const fem::Sector& sector, CondensedSector* condensed,
         const fem::Harmonic& harmonic) {
    if (condensed != nullptr) {
      factor_ = std::make_unique<HarmonicFactor>(*condensed, harmonic);
    } else {
      matrices_ = fem::assemble(PETSC_COMM_SELF, sector, harmonic, source.regions,
                                {source.element, source.element_mass});
      factor_ = std::make_unique<ShiftedFactor>(matrices_.K, nullptr);
    }
    factor_->factorise(0);
  }

  void solve(Eigen::Ref<Eigen::MatrixXd> z) const { factor_->solve(z); }

 private:
  fem::Matrices matrices_;
  std::unique_ptr<ShiftedSolver> factor_;
};

class HarmonicFactors final : public WholeBodySolver {
 public:
  HarmonicFactors(const io::BodySource& source, const mesh::Repetition& repetition)
      : source_(source),
        node_orbits_(fem::free_node_orbits(
            repetition, fem::free_nodes(fem::held_directions(source.free_dof, source.mesh.n_nodes())))),
        sector_(fem::make_sector(source.mesh, repetition, fem::cell_regions(source.mesh, source.regions),
                                 node_orbits_)) {}

  void visit_parts(const std::function<void(const Solve&)>& visit) override {
    std::optional<CondensedSector> condensed;
    if (condensing_pays(sector_))
      condensed.emplace(sector_, source_.regions, model::Formulation{source_.element, source_.element_mass});
    for (int k = 0; 2 * k <= sector_.turn.n_sectors; ++k) {
      const fem::Harmonic harmonic = fem::make_harmonic(sector_, k);
      if (harmonic.size() == 0) continue;
      const Factor factor(source_, sector_, condensed ? &*condensed : nullptr, harmonic);
      visit([&](const Eigen::MatrixXd& f) { return solve(harmonic, factor, f); });
    }
    condensed.reset();
    give_back_memory();
  }

 private:
  Eigen::MatrixXd solve(const fem::Harmonic& harmonic, const Factor& factor, const Eigen::MatrixXd& f) const {
    Eigen::MatrixXd z(harmonic.size(), f.cols()), u(f.rows(), f.cols());
    for (Eigen::Index j = 0; j < f.cols(); ++j)
      z.col(j) = fem::project_forces(harmonic, node_orbits_, f.col(j));
    factor.solve(z);
    for (Eigen::Index j = 0; j < f.cols(); ++j) u.col(j) = fem::unfold(harmonic, node_orbits_, z.col(j));
    return u;
  }

  const io::BodySource& source_;
  fem::NodeOrbits node_orbits_;
  fem::Sector sector_;
};

}  // namespace

std::unique_ptr<WholeBodySolver> factorise_harmonics(const io::BodySource& source,
                                                     const mesh::Repetition& repetition) {
  return std::make_unique<HarmonicFactors>(source, repetition);
}

}  // namespace elastogear::reduction
