#include "elastogear/reduction/static_response.h"

#include <algorithm>
#include <optional>

#include "elastogear/base/error.h"
#include "elastogear/fem/material.h"
#include "elastogear/fem/restraint.h"
#include "elastogear/fem/stress.h"
#include "elastogear/reduction/stressed_body.h"
#include "reduction/cyclic/body_repetition.h"
#include "reduction/static_response/whole_body_solver.h"

namespace elastogear::reduction {
namespace {

constexpr Eigen::Index kSolvedTogether = 32;  // right-hand sides that go through the factor together

// Nothing for a body that does not repeat.
std::optional<mesh::Repetition> find_repetition(const io::BodySource& source) {
  const std::vector<mesh::Directions> held = fem::held_directions(source.free_dof, source.mesh.n_nodes());
  if (mesh::has_single_directions(held)) return {};
  const std::vector<int> region = fem::cell_regions(source.mesh, source.regions);
  const std::vector<bool> is_free = fem::free_nodes(held);
  return find_body_repetition(source.mesh, source.regions, {region, is_free}).found;
}

std::unique_ptr<WholeBodySolver> make_solver(const io::BodySource& source, bool floating) {
  if (floating) return factorise_whole(source, true);
  const std::optional<mesh::Repetition> repetition = find_repetition(source);
  return repetition ? factorise_harmonics(source, *repetition) : factorise_whole(source, false);
}

}  // namespace

struct StaticResponse::Data {
  const io::BodySource& source;
  std::unique_ptr<WholeBodySolver> solver;

  Eigen::MatrixXd no_forces(Eigen::Index n) const {
    return Eigen::MatrixXd::Zero(Eigen::Index{3} * source.mesh.n_nodes(), n);
  }
  // Unit forces in x, y, z on each of `loaded`, of which some.
  Eigen::MatrixXd unit_forces(const std::vector<int>& loaded, Eigen::Index begin, Eigen::Index count) const {
    Eigen::MatrixXd f = no_forces(count);
    for (Eigen::Index j = 0; j < count; ++j) {
      const Eigen::Index load = begin + j;
      f(3 * loaded[static_cast<std::size_t>(load / 3)] + load % 3, j) = 1;
    }
    return f;
  }
};

StaticResponse::StaticResponse(const io::BodySource& source, bool floating)
    : data_(new Data{source, make_solver(source, floating)}) {}
StaticResponse::~StaticResponse() = default;

Eigen::MatrixXd StaticResponse::displacement(const std::vector<int>& loaded, const Eigen::MatrixXd& f) {
  require(f.rows() == 3 * static_cast<Eigen::Index>(loaded.size()), "forces with ", f.rows(), " rows on ",
          loaded.size(), " nodes");
  Eigen::MatrixXd forces = data_->no_forces(f.cols()), u = forces;
  for (std::size_t i = 0; i < loaded.size(); ++i)
    forces.middleRows<3>(3 * loaded[i]) += f.middleRows<3>(3 * static_cast<Eigen::Index>(i));
  data_->solver->visit_parts([&](const Solve& part) { u += part(forces); });
  return u;
}

Eigen::MatrixXd StaticResponse::stress(const std::vector<int>& loaded, const std::vector<int>& evaluated) {
  const model::SparseRows S = fem::stress_operator(stressed_body(data_->source), evaluated);
  const auto n = 3 * static_cast<Eigen::Index>(loaded.size());
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(S.rows(), n);
  data_->solver->visit_parts([&](const Solve& part) {
    for (Eigen::Index begin = 0; begin < n; begin += kSolvedTogether) {
      const Eigen::Index count = std::min(kSolvedTogether, n - begin);
      G.middleCols(begin, count) += S * part(data_->unit_forces(loaded, begin, count));
    }
  });
  return G;
}

}  // namespace elastogear::reduction
