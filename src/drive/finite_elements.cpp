#include "elastogear/drive/finite_elements.h"

#include <memory>
#include <utility>

#include "elastogear/fem/stress.h"
#include "elastogear/mesh/surface_patches.h"
#include "elastogear/reduction/static_response.h"
#include "elastogear/reduction/stressed_body.h"

namespace elastogear::drive {
namespace {

recovery::UnreducedResponse unreduced_response(const io::BodySource& source, bool floating) {
  const auto factor = std::make_shared<reduction::StaticResponse>(source, floating);
  return {[factor](const std::vector<int>& loaded, const Eigen::MatrixXd& f) {
            return factor->displacement(loaded, f);
          },
          [factor](const std::vector<int>& loaded, const std::vector<int>& evaluated) {
            return factor->stress(loaded, evaluated);
          }};
}

recovery::NodalStresses nodal_stresses(const io::BodySource& source, const std::vector<int>& loaded) {
  fem::StressedBody body = reduction::stressed_body(source);
  if (body.recovery.method == model::RecoveryMethod::average)
    body.recovery = {model::RecoveryMethod::surface, loaded};
  const auto stresses = std::make_shared<fem::NodalStresses>(body);
  return {[stresses](const Eigen::MatrixXd& U) { return stresses->means(U); }, stresses->free(),
          stresses->of_free()};
}

std::vector<int> node_regions(const io::BodySource& source) {
  return fem::stress_regions(source.mesh, source.regions);
}

// Bodies whose stresses are means do not keep the nodes that are loaded.
model::SparseRows recovery_difference(const io::BodySource& source, const std::vector<int>& loaded,
                                      const std::vector<int>& nodes) {
  fem::StressedBody body = reduction::stressed_body(source);
  if (body.recovery.method == model::RecoveryMethod::average) body.recovery.loaded = loaded;
  return fem::recovery_difference(std::move(body), nodes);
}

model::SparseRows difference_within_surface(const io::BodySource& source, const std::vector<int>& loaded,
                                            const std::vector<int>& nodes) {
  fem::StressedBody body = reduction::stressed_body(source);
  if (body.recovery.method == model::RecoveryMethod::average) body.recovery.loaded = loaded;
  return fem::difference_within_surface(std::move(body), nodes);
}

model::SparseRows stress_operator(const io::BodySource& source, const std::vector<int>& nodes) {
  return fem::stress_operator(reduction::stressed_body(source), nodes);
}

recovery::SurfacePatches surface_patches(const io::BodySource& source, const std::vector<int>& nodes) {
  return {mesh::surface_patches(source.mesh, nodes), mesh::cell_orders(source.mesh, nodes)};
}

}  // namespace

recovery::FiniteElements finite_elements() {
  return {unreduced_response,        nodal_stresses,  node_regions,   recovery_difference,
          difference_within_surface, stress_operator, surface_patches};
}

}  // namespace elastogear::drive
