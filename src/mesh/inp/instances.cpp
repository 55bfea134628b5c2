// Decks with several parts and instances, of which one is read.
#include "mesh/inp/inp_deck.h"
#include "mesh/inp/lines/inp_lines.h"

namespace elastogear::mesh {

namespace {

// The set or surface that a keyword line makes.
InpSetName set_of(const Keyword& key) {
  return {key.name, key.value(key.name == "SURFACE" ? "NAME" : key.name)};
}

}  // namespace

bool ChosenInstance::leaves_out(const std::string& keyword, std::string_view field) const {
  if (name.empty()) return false;
  const std::string text = upper(field);
  const std::size_t dot = text.find('.');
  const InpSetName set{keyword, text};
  return (of_others.contains(set) && !own.contains(set)) ||
         (dot != text.npos && others.contains(text.substr(0, dot)));
}

ChosenInstance choose_instance(const InpText& text) {
  ChosenInstance chosen;
  if (text.instance.empty()) return chosen;
  std::string all;
  const std::string wanted = upper(text.instance);
  InpLines in(text);
  while (in.next()) {
    if (!in.at_keyword()) continue;
    const Keyword key = in.keyword();
    if (key.has("INSTANCE"))
      (key.value("INSTANCE") == wanted ? chosen.own : chosen.of_others).insert(set_of(key));
    if (key.name != "INSTANCE") continue;
    const std::string name = key.value("NAME");
    all += (all.empty() ? "" : ", ") + name;
    if (name == wanted) {
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
  return others || (key.has("INSTANCE") && key.value("INSTANCE") != chosen.name);
}

}  // namespace elastogear::mesh
