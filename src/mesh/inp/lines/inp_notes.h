#pragma once
// What a reader of an input file passes over: one line for each kind, with the place of the first.

#include <string>
#include <vector>

#include "mesh/inp/lines/inp_lines.h"

namespace elastogear::mesh {

class InpNotes {
 public:
  /// Passed over, and the body is the same without it. `what`: "*CLOAD". `text`: nothing, or an explanation.
  void ignore(const InpLines& in, const std::string& what, int line, const std::string& text = "");
  /// Passed over, and the body is another than the file's. `text`: what is lost.
  void lose(const InpLines& in, const std::string& what, int line, const std::string& text);

  /// Read, and computed otherwise than another program does. `what`: "C3D20R".
  void read_as(const InpLines& in, const std::string& what, int line, const std::string& text);

  /// "*CLOAD (line 12 and 3 more)", "*SPRING (line 12): springs ... are left out", in the order of the first.
  std::vector<std::string> ignored() const { return texts(ignored_); }
  std::vector<std::string> lost() const { return texts(lost_); }
  std::vector<std::string> read_as() const { return texts(read_as_); }

 private:
  struct Note {
    std::string what, place, text;
    int count = 0;
  };
  static void add(std::vector<Note>& notes, const Note& note);
  static std::vector<std::string> texts(const std::vector<Note>& notes);

  std::vector<Note> ignored_, lost_, read_as_;
};

}  // namespace elastogear::mesh
