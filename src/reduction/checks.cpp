#include "reduction/checks.h"

namespace elastogear::reduction {
namespace {

model::Check captured_mass(const SixDirections& sum, const SixDirections& mobile,
                           const SixDirections& whole) {
  model::Check check{
      "captured_mass", "1", "sums of effective_mass (x y z) and effective_inertia (about x y z)", {}, {}};
  check.value.resize(2, 6);
  check.value.row(0) = sum.cwiseQuotient(mobile);
  check.value.row(1) = sum.cwiseQuotient(whole);
  check.row = {"share of what all modes carry together", "share of the body's mass and inertia"};
  return check;
}

model::Check rigid_coupling(const SixDirections& largest, const SixDirections& whole) {
  return {"rigid_coupling",
          "1",
          "largest coupling of a mode to translations (x y z) and rotations about the centre of mass",
          largest.cwiseQuotient(whole).cwiseSqrt().transpose(),
          {"coupling / sqrt(mass or inertia)"}};
}

}  // namespace

std::vector<model::Check> mass_checks(bool floating, const model::ElasticBody& body,
                                      const std::function<SixDirections()>& mobile) {
  const auto masses = effective_masses(body.inertia);
  const SixDirections whole = body_masses(body.inertia);
  if (floating) {
    if (masses.rows() == 0) return {};
    return {rigid_coupling(masses.colwise().maxCoeff(), whole)};
  }
  return {{"effective_mass", "kg", "of each mode, directions x y z", masses.leftCols<3>()},
          {"effective_inertia", "kg m^2", "of each mode, about axes x y z through the centre of mass",
           masses.rightCols<3>()},
          captured_mass(masses.colwise().sum(), mobile(), whole)};
}

std::vector<model::Check> load_checks(const ElasticSystem& system, const model::ElasticBody& body,
                                      int n_nodes) {
  const Completeness completeness = static_completeness(system, body, n_nodes);
  if (completeness.load.empty()) return {};
  return {{"static_completeness", "1",
           "share of the static response to a load on the surface that the modes give", completeness.share,
           completeness.load}};
}

model::Check ritz_check(const Eigen::VectorXd& residual) {
  return {"ritz_residual",
          "1",
          "|K phi - omega^2 M phi| / |K phi| of each vector: Ritz vectors are no eigenmodes",
          residual,
          {}};
}

}  // namespace elastogear::reduction
