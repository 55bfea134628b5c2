#include <algorithm>
#include <functional>

#include "elastogear/base/error.h"
#include "elastogear/fem/relaxing_stiffness.h"
#include "elastogear/fem/stress.h"
#include "reduction/reduce_job.h"
#include "reduction/waiting_modes.h"

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

bool is_alike(const fem::RelaxingModuli& a, const fem::RelaxingModuli& b) {
  return a.g == b.g && a.tau == b.tau;
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
  return all.size() == 1 && is_whole_body(job, all.front());
}

int creeping_part(const Job& job, const std::vector<int>& loaded) {
  const std::vector<fem::RelaxingModuli> all = fem::relaxing_moduli(job.regions);
  const std::vector<int> region = fem::stress_regions(job.mesh, job.regions);
  int part = -1;
  for (int node : loaded) {
    const int own = region[job.plan.body.surface.node[node]];
    const auto at =
        std::find_if(all.begin(), all.end(), [&](const auto& moduli) { return moduli.region == own; });
    if (at == all.end() || (part >= 0 && is_alike(*at, all[part]))) continue;
    require(
        part < 0, "basis modal_residual: contact forces act on the cell sets '",
        job.regions[all[part].region].cell_set, "' and '", job.regions[own].cell_set,
        "', whose materials relax differently; name the face sets of one of them by the option loaded, or "
        "give both the same series and temperature");
    part = static_cast<int>(at - all.begin());
  }
  return part < 0 && !all.empty() ? 0 : part;
}

void set_relaxing(Job& job, const WaitingModes& modes) {
  set_parts(job, [&](const model::SparseRows& K) -> Reduced { return project(modes, K).sparseView(); });
}

void set_relaxing_full(Job& job) {
  set_parts(job, [&](const model::SparseRows& K) { return free_entries(K, job.plan.free_dof); });
}

}  // namespace elastogear::reduction
