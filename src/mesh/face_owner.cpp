#include "face_owner.h"

#include <algorithm>

namespace elastogear::mesh {
namespace {

Face sorted(Face face) {
  std::sort(face.begin(), face.end());
  return face;
}

// The same nodes in the same cyclic order.
bool same_direction(const Face& a, Face b) {
  for (int turn = 0; turn < 4; ++turn) {
    if (a == b) return true;
    std::rotate(b.begin(), b.begin() + 1, b.end());
  }
  return false;
}

}  // namespace

std::size_t FaceOwners::Hash::operator()(const Face& face) const {
  std::size_t h = 0;
  for (int i : face) h = h * 1000003u + static_cast<std::size_t>(i);
  return h;
}

FaceOwners::FaceOwners(const Mesh& mesh) {
  for (const auto& [name, faces] : mesh.face_sets)
    for (const Face& face : faces) owners_.try_emplace(sorted(face));
  if (owners_.empty()) return;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const auto faces = cell_faces(mesh.cells.type[cell], mesh.cells[cell]);
    for (int side = 0; side < static_cast<int>(faces.size()); ++side) {
      const auto found = owners_.find(sorted(faces[side]));
      if (found == owners_.end()) continue;
      auto& [first, second] = found->second;
      (first.cell < 0 ? first : second) = {cell, side, faces[side]};
    }
  }
}

std::optional<FaceOwner> FaceOwners::find(const Face& face) const {
  const auto found = owners_.find(sorted(face));
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
