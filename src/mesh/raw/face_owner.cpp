#include "mesh/raw/face_owner.h"

namespace elastogear::mesh {

std::size_t FaceOwners::Hash::operator()(const Face& face) const {
  std::size_t h = 0;
  for (int i : face) h = h * 1000003u + static_cast<std::size_t>(i);
  return h;
}

FaceOwners::FaceOwners(const Mesh& mesh) {
  for (const auto& [name, faces] : mesh.face_sets)
    for (const Face& face : faces) owners_.try_emplace(face_key(face));
  if (owners_.empty()) return;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto sides = cell_sides(mesh.cells.type[cell], mesh.cells[cell]);
    for (int side = 0; side < std::ssize(sides); ++side)
      for (const Face& face : sides[side]) {
        const auto found = owners_.find(face_key(face));
        if (found == owners_.end()) continue;
        auto& [first, second] = found->second;
        (first.cell < 0 ? first : second) = {cell, side, face};
      }
  }
}

std::optional<FaceOwner> FaceOwners::find(const Face& face) const {
  const auto found = owners_.find(face_key(face));
  if (found == owners_.end() || found->second[0].cell < 0) return std::nullopt;
  const auto& [first, second] = found->second;
  return second.cell >= 0 && same_direction(second.face, face) ? second : first;
}

void orient_faces(Mesh& mesh) {
  const FaceOwners owners(mesh);
  for (auto& [name, faces] : mesh.face_sets)
    for (Face& face : faces)
      if (const auto owner = owners.find(face); owner && !same_direction(owner->face, face))
        face = owner->face;
}

}  // namespace elastogear::mesh
