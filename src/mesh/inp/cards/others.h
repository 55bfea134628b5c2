#pragma once
// Elements of an Abaqus input file that are no solids: point masses are read, faces of solids make face sets,
// and shells, beams and the like are left out.

#include <map>
#include <string>
#include <vector>

#include "elastogear/mesh/read_report.h"
#include "mesh/inp/lines/inp_notes.h"
#include "mesh/inp/lines/inp_sets.h"

namespace elastogear::mesh {

struct OtherElement {
  std::vector<Tag> nodes;
  int group = 0;  // of OtherElements::groups
};

struct MassCard {
  std::string members;  // element set
  double mass = 0;      // of each element, unit of the file
  int line = 0;
};

struct OtherElements {
  struct Group {
    std::string type;  // in capitals
    int line = 0;      // of its *ELEMENT
  };
  std::vector<Tag> number;
  std::vector<OtherElement> element;
  std::vector<Group> groups;  // one for each *ELEMENT
  std::vector<MassCard> masses;
};

/// Reads the data lines of an *ELEMENT of any type that is no solid, and returns the numbers.
std::vector<Tag> read_other_elements(InpLines& in, const Keyword& key, OtherElements& others);

/// *MASS
void read_mass(InpLines& in, const Keyword& key, OtherElements& others);

/// Which other elements the element sets hold, by the set's first spelling.
using OtherSets = std::map<std::string, std::vector<int>>;

/// Makes a face set of each element set whose plane elements are all faces of cells, and notes what is left
/// out.
void add_faces(const InpLines& in, const OtherElements& others, const TagTable& numbers,
               const OtherSets& sets, const TagTable& nodes, Mesh& mesh, InpNotes& notes);

/// Makes a node set for each amount of mass that nodes have, and reports them in kg. Error for unknown sets.
void add_masses(const InpLines& in, const OtherElements& others, const TagTable& numbers,
                const InpSets& cell_sets, const OtherSets& sets, const TagTable& nodes, double unit_in_m,
                Mesh& mesh, ReadReport& report);

}  // namespace elastogear::mesh
