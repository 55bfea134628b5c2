#include "mesh/inp/lines/inp_notes.h"

#include <algorithm>

namespace elastogear::mesh {

void InpNotes::add(std::vector<Note>& notes, const Note& note) {
  const auto same = [&](const Note& other) { return other.what == note.what && other.text == note.text; };
  auto found = std::find_if(notes.begin(), notes.end(), same);
  if (found == notes.end()) found = notes.insert(notes.end(), note);
  ++found->count;
}

void InpNotes::ignore(const InpLines& in, const std::string& what, int line, const std::string& text) {
  add(ignored_, {what, in.place(line), text});
}

void InpNotes::lose(const InpLines& in, const std::string& what, int line, const std::string& text) {
  add(lost_, {what, in.place(line), text});
}

void InpNotes::read_as(const InpLines& in, const std::string& what, int line, const std::string& text) {
  add(read_as_, {what, in.place(line), text});
}

std::vector<std::string> InpNotes::texts(const std::vector<Note>& notes) {
  std::vector<std::string> result;
  for (const Note& note : notes)
    result.push_back(note.what + " (" + note.place +
                     (note.count > 1 ? " and " + std::to_string(note.count - 1) + " more)" : ")") +
                     (note.text.empty() ? "" : ": " + note.text));
  return result;
}

}  // namespace elastogear::mesh
