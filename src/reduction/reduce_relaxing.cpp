#include <algorithm>
#include <functional>

#include "elastogear/base/error.h"
#include "elastogear/fem/relaxing_stiffness.h"
#include "elastogear/fem/stress.h"
#include "reduction/job/reduce_job.h"
#include "reduction/job/waiting_modes.h"

namespace elastogear::reduction {
namespace {

using Reduced = Eigen::SparseMatrix<double>;

// Does the stiffness of the part have the whole body's ratio to it everywhere?
bool is_whole_body(const Job& job, const fem::RelaxingModuli& moduli) {
  const std::vector<int>& region = job.plan.region;
  return moduli.part == model::ModulusPart::both &&
         std::all_of(region.begin(), region.end(), [&](int r) { return r == moduli.region; });
}

// Rows and columns of the free displacements.
Reduced free_entries(const model::SparseRows& K, const std::vector<int>& free_dof) {
  std::vector<int> coordinate(static_cast<std::size_t>(K.rows()), -1);
  for (std::size_t j = 0; j < free_dof.size(); ++j) coordinate[free_dof[j]] = static_cast<int>(j);
  std::vector<Eigen::Triplet<double>> entries;
  for (int dof : free_dof)
    for (model::SparseRows::InnerIterator it(K, dof); it; ++it)
      if (coordinate[it.col()] >= 0) entries.emplace_back(coordinate[dof], coordinate[it.col()], it.value());
  const auto n = static_cast<Eigen::Index>(free_dof.size());
  Reduced K_free(n, n);
  K_free.setFromTriplets(entries.begin(), entries.end());
  return K_free;
}

void set_parts(Job& job, const std::function<Reduced(const model::SparseRows&)>& reduced) {
  if (!relaxes(job.options)) return;
  model::ElasticBody& body = job.plan.body;
  const std::vector<int> node_region = fem::stress_regions(job.mesh, job.regions);
  for (const fem::RelaxingModuli& moduli : fem::relaxing_moduli(job.regions)) {
    model::RelaxingPart part{
        job.regions[moduli.region].cell_set, moduli.part,
        Eigen::VectorXd::Map(moduli.g.data(), static_cast<Eigen::Index>(moduli.g.size())),
        Eigen::VectorXd::Map(moduli.tau.data(), static_cast<Eigen::Index>(moduli.tau.size()))};
    part.K = is_whole_body(job, moduli)
                 ? body.K_r
                 : reduced(fem::relaxing_stiffness(job.mesh, job.regions, job.plan.region, moduli,
                                                   job.options.element));
    for (int e = 0; e < static_cast<int>(body.stress.node.size()); ++e)
      if (node_region[body.stress.node[e]] == moduli.region) part.stress_node.push_back(e);
    body.relaxing.push_back(std::move(part));
  }
}

bool relaxes_apart(const ReductionOptions& options) {
  return std::any_of(options.regions.begin(), options.regions.end(), [](const model::MaterialRegion& region) {
    return region.material.viscoelastic && !region.material.viscoelastic->has_constant_ratio();
  });
}

}  // namespace

bool relaxes(const ReductionOptions& options) {
  return std::any_of(options.regions.begin(), options.regions.end(), [](const model::MaterialRegion& region) {
    return region.material.viscoelastic.has_value();
  });
}

void validate_relaxing(const ReductionOptions& options) {
  require(options.relaxed_states >= 0 && options.relaxed_states <= kMostRelaxedStates,
          "relaxed_states = ", options.relaxed_states, ", must be at most ", kMostRelaxedStates);
  if (!relaxes(options)) return;
  require(
      options.stress_recovery != RecoveryChoice::surface || !relaxes_apart(options),
      "stress_recovery surface: holds the ratio of shear and bulk modulus for constant, which relax apart "
      "here (prony_g, prony_k); take -stress_recovery average");
  require(!options.imported,
          "viscoelastic materials need the stiffness of the mesh's own cells: leave option stiffness out");
}

model::RecoveryMethod recovery_method(const ReductionOptions& options) {
  const bool averages = options.stress_recovery == RecoveryChoice::average ||
                        (options.stress_recovery == RecoveryChoice::automatic && relaxes_apart(options));
  return averages ? model::RecoveryMethod::average : model::RecoveryMethod::surface;
}

bool relaxes_alike(const Job& job) {
  const std::vector<fem::RelaxingModuli> all = fem::relaxing_moduli(job.regions);
  std::vector<bool> alike(job.regions.size(), false);
  for (const fem::RelaxingModuli& moduli : all)
    alike[moduli.region] =
        moduli.part == model::ModulusPart::both && moduli.g == all.front().g && moduli.tau == all.front().tau;
  const std::vector<int>& region = job.plan.region;
  return std::all_of(region.begin(), region.end(), [&](int r) { return alike[r]; });
}

RelaxedStates relaxed_states(const Job& job) {
  return choose_relaxed_states(fem::relaxing_moduli(job.regions), job.options.relaxed_states);
}

void set_relaxed(std::vector<model::MaterialRegion>& regions, const Eigen::VectorXd& share) {
  const std::vector<fem::RelaxingModuli> parts = fem::relaxing_moduli(regions);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    model::ModuliShares& relaxed = regions[parts[p].region].material.relaxed;
    if (parts[p].part != model::ModulusPart::bulk) relaxed.shear = share[static_cast<Eigen::Index>(p)];
    if (parts[p].part != model::ModulusPart::shear) relaxed.bulk = share[static_cast<Eigen::Index>(p)];
  }
}

void relax_stresses(const Job& job, const std::vector<int>& nodes, Eigen::MatrixXf& G) {
  const std::vector<int> region = fem::stress_regions(job.mesh, job.regions);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto [shear, bulk] = job.regions[region[nodes[i]]].material.relaxed;
    auto stress = G.middleRows<6>(6 * static_cast<Eigen::Index>(i));
    const Eigen::RowVectorXf mean = stress.topRows<3>().colwise().mean();
    stress *= static_cast<float>(1 - shear);
    stress.topRows<3>().rowwise() += static_cast<float>(shear - bulk) * mean;
  }
}

void set_relaxing(Job& job, const WaitingModes& modes) {
  set_parts(job, [&](const model::SparseRows& K) -> Reduced { return project(modes, K).sparseView(); });
}

void set_relaxing_full(Job& job) {
  set_parts(job, [&](const model::SparseRows& K) { return free_entries(K, job.plan.free_dof); });
}

}  // namespace elastogear::reduction
