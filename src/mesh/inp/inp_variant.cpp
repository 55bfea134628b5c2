#include "mesh/inp/inp_variant.h"

#include "mesh/inp/inp_format.h"

namespace elastogear::mesh {
namespace {

struct Letter {
  char letter;
  const char* meaning;
};
constexpr Letter kLetters[] = {{'R', "reduced integration"},    {'M', "its modified formulation"},
                               {'H', "its hybrid formulation"}, {'T', "temperature"},
                               {'P', "pore pressure"},          {'E', "electric potential"}};

std::string meaning(char letter) {
  for (const Letter& known : kLetters)
    if (known.letter == letter) return known.meaning;
  return std::string("what its letter ") + letter + " stands for";
}

}  // namespace

std::string variant_note(std::string_view element, CellType type) {
  const std::string_view plain = inp_format::kElementTypes[static_cast<int>(type)],
                         variant = element.substr(plain.size());
  const bool hexahedron = type == CellType::hex8;
  if (hexahedron ? variant == "I" : variant.empty()) return {};
  std::string note;
  for (char letter : variant)
    if (!hexahedron || letter != 'I') note += (note.empty() ? "" : " and ") + meaning(letter);
  if (!note.empty()) note = "read as " + std::string(plain) + "; not reproduced: " + note;
  if (!hexahedron) return note;
  return note + (note.empty() ? "" : "; ") +
         "computed as the option element says: incompatible modes (C3D8I) unless it is given, plain for C3D8 "
         "of CalculiX, bbar near C3D8 of Abaqus";
}

}  // namespace elastogear::mesh
