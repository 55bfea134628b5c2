// *NSET, *ELSET and *SURFACE of an Abaqus input file.
#include "mesh/inp/inp_deck.h"
#include "mesh/inp/inp_lines.h"

namespace elastogear::mesh {
namespace {

constexpr int kMaxSides = 6;

void read_range(InpLines& in, const std::string& name, InpSets& sets) {
  const auto& fields = in.fields();
  if (fields.size() < 2 || fields.size() > 3) in.fail_here("GENERATE needs first, last and step");
  const auto number = [&](int i) { return in.parse_field<Tag>(fields[i], "a number of a range"); };
  const Tag step = fields.size() == 3 ? number(2) : 1;
  if (step < 1) in.fail_here("the step of a range is ", step, ", must be positive");
  sets.add_range(name, number(0), number(1), step, in.number());
}

// In an assembly a set of the part's name is another set, which one mesh cannot have too.
void check_scope(const InpLines& in, const Keyword& key, InpDeck& deck, const InpSets& sets) {
  const std::string name = key.value(key.name);
  if (!deck.of_assembly()) return;
  if (sets.spelling(name) && !deck.assembly_sets.contains({key.name, name}))
    in.fail_here("set '", name, "' of the assembly has the name of a set of the part: rename one of them");
  deck.assembly_sets.insert({key.name, name});
}

}  // namespace

void read_set(InpLines& in, const Keyword& key, InpDeck& deck) {
  InpSets& sets = key.name == "NSET" ? deck.node_sets : deck.cell_sets;
  if (!key.has(key.name)) in.fail_here("*", key.name, " without ", key.name, "=name");
  if (key.name == "NSET" && key.has("ELSET")) in.fail_here("*NSET from an ELSET is not supported");
  check_scope(in, key, deck, sets);
  const std::string& name = key.parameters.at(key.name);
  sets.add(name, {}, key.line);
  while (in.next_data()) {
    if (key.has("GENERATE")) {
      read_range(in, name, sets);
      continue;
    }
    for (std::string_view field : in.fields()) {
      const std::string_view member = deck.member(field);
      if (const auto number = parse<Tag>(member)) {
        sets.add(name, {*number}, in.number());
      } else if (!member.empty()) {
        sets.add_set(name, std::string(member), in.number());
      }
    }
  }
}

void read_surface(InpLines& in, const Keyword& key, InpDeck& deck) {
  if (!key.has("NAME")) in.fail_here("*SURFACE without NAME=name");
  const std::string name = deck.surfaces.first_spelling(key.parameters.at("NAME"));
  while (in.next_data()) {
    const auto& fields = in.fields();
    const std::string label = fields.size() == 2 ? upper(fields[1]) : "";
    const bool known = label.size() == 2 && label[0] == 'S' && label[1] >= '1' && label[1] < '1' + kMaxSides;
    if (!known)
      in.fail_here("surface '", name, "' needs an element or element set and a face S1..S6, found '",
                   fields.size() > 1 ? fields[1] : "", "'");
    deck.surface_lines.push_back({name, std::string(deck.member(fields[0])), label[1] - '1', in.number()});
  }
}

void build_surfaces(const InpLines& in, const InpDeck& deck, const TagTable& cells, Mesh& mesh,
                    MemberBudget& budget) {
  for (const auto& [key, name] : deck.surfaces.spelling) mesh.face_sets[name];
  for (const SurfaceLine& line : deck.surface_lines) {
    auto& faces = mesh.face_sets[line.name];
    const auto add = [&](int cell) {
      const auto sides = cell_sides(mesh.cells.type[cell], mesh.cells[cell]);
      if (line.side >= std::ssize(sides))
        in.fail_at(line.line, "surface '", line.name, "' names side S", line.side + 1, " of a ",
                   name(mesh.cells.type[cell]), ", which has ", sides.size());
      budget.spend(sides[line.side].size());
      faces.insert(faces.end(), sides[line.side].begin(), sides[line.side].end());
    };
    if (const auto number = parse<Tag>(line.members)) {
      const int cell = cells.find(*number);
      if (cell < 0)
        in.fail_at(line.line, "surface '", line.name, "' names element ", *number,
                   ", which the file does not define");
      add(cell);
    } else {
      const std::string* set = deck.cell_sets.spelling(line.members);
      if (!set)
        in.fail_at(line.line, "surface '", line.name, "' names the unknown element set '", line.members, "'");
      for (int cell : mesh.cell_sets.at(*set)) add(cell);
    }
  }
}

}  // namespace elastogear::mesh
