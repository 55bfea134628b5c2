// Decks with several parts and instances, of which one is read.
#include "mesh/inp/inp_deck.h"
#include "mesh/inp/lines/inp_lines.h"

namespace elastogear::mesh {

bool ChosenInstance::leaves_out(std::string_view field) const {
  if (name.empty()) return false;
  const std::string text = upper(field);
  const std::size_t dot = text.find('.');
  return members.contains(text) || (dot != text.npos && others.contains(text.substr(0, dot)));
}

ChosenInstance choose_instance(const InpText& text) {
  ChosenInstance chosen;
  if (text.instance.empty()) return chosen;
  std::string all;
  InpLines in(text);
  while (in.next()) {
    if (!in.at_keyword()) continue;
    const Keyword key = in.keyword();
    if (key.name != "INSTANCE") continue;
    const std::string name = key.value("NAME");
    all += (all.empty() ? "" : ", ") + name;
    if (name == upper(text.instance)) {
      chosen.name = name;
      chosen.part = key.value("PART");
    } else {
      chosen.others.insert(name);
    }
  }
  require(!chosen.name.empty(), text.path, ": has no instance '", text.instance,
          "'; its instances are: ", all.empty() ? "none" : all);
  return chosen;
}

bool belongs_to_others(const Keyword& key, ChosenInstance& chosen) {
  if (chosen.name.empty()) return false;
  if (key.name == "PART") chosen.in_other_part = key.value("NAME") != chosen.part;
  if (key.name == "INSTANCE") chosen.in_other = key.value("NAME") != chosen.name;
  const bool others = chosen.in_other_part || chosen.in_other;
  if (key.name == "END PART") chosen.in_other_part = false;
  if (key.name == "END INSTANCE") chosen.in_other = false;
  if (others || !key.has("INSTANCE") || key.value("INSTANCE") == chosen.name) return others;
  chosen.members.insert(key.value(key.name == "SURFACE" ? "NAME" : key.name));
  return true;
}

}  // namespace elastogear::mesh
