#include "reduction/cyclic/body_repetition.h"

#include <Eigen/Geometry>

namespace elastogear::reduction {
namespace {

constexpr double kRounding = 1e-9;  // m and -: of an axis

// Returns whether the turn leaves the material's directions as they are.
bool repeats(const model::Material& material, const mesh::Turn& turn) {
  if (!material.orthotropic) return true;
  const model::Orientation& o = material.orthotropic->orientation;
  const Eigen::Vector3d axis = o.axis.normalized();
  return o.system == model::Orientation::System::cylindrical && axis.cross(turn.axis).norm() < kRounding &&
         axis.cross(o.origin - turn.point).norm() < kRounding;
}

}  // namespace

mesh::RepetitionSearch find_body_repetition(const mesh::Mesh& mesh,
                                            const std::vector<model::MaterialRegion>& regions,
                                            const mesh::Labels& labels) {
  auto search = mesh::find_repetition(mesh, labels);
  if (!search.found) return search;
  for (const model::MaterialRegion& region : regions)
    if (!repeats(region.material, search.found->turn))
      return {{}, "the directions of an orthotropic material do not turn with the mesh"};
  return search;
}

}  // namespace elastogear::reduction
