#pragma once
// Which cell a face of a face set belongs to, and on which of its sides.

#include <array>
#include <optional>
#include <unordered_map>

#include "elastogear/mesh/mesh.h"

namespace elastogear::mesh {

struct FaceOwner {
  int cell = -1;
  int side = 0;  ///< 0..5 for Abaqus' S1..S6
  Face face;     ///< outward, as cell_faces() gives it
};

/// Owners of all faces that are members of the mesh's face sets.
class FaceOwners {
 public:
  explicit FaceOwners(const Mesh& mesh);
  /// The cell from which the face points outward; else any cell that has it; else nothing.
  std::optional<FaceOwner> find(const Face& face) const;

 private:
  struct Hash {
    std::size_t operator()(const Face& face) const;
  };
  std::unordered_map<Face, std::array<FaceOwner, 2>, Hash> owners_;  // by face_key
};

/// Turns faces of the mesh's face sets that no cell has in this direction outward.
void orient_faces(Mesh& mesh);

}  // namespace elastogear::mesh
