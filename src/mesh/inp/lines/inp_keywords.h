#pragma once
// What becomes of each keyword of an Abaqus or CalculiX input file: one table, with the parameters of those
// that are read.

#include <string>
#include <string_view>

namespace elastogear::mesh {

enum class KeywordKind {
  makes,     ///< makes or places nodes or elements, and is read: a parameter that is not known is an error
  read,      ///< is read: a parameter that is not known is a warning
  harmless,  ///< headings, output, loads, steps and their controls: passed over
  lost,      ///< changes the model and is not read: a warning of what is lost
  refused    ///< makes or moves nodes or elements and is not read: an error with the remedy
};

struct KeywordRow {
  std::string_view names;  ///< one or several, between commas
  KeywordKind kind;
  std::string_view text;  ///< makes, read: known parameters; lost: what is lost; refused: remedy
};

struct KnownKeyword {
  std::string name;  ///< as the table spells it
  const KeywordRow* row;
};

/// The keyword, in capitals, or null. Blanks within do not matter: "SOLID  SECTION", "ENDSTEP".
const KnownKeyword* find_keyword(std::string_view name);

/// Does the keyword know the parameter?
bool knows(const KeywordRow& row, std::string_view parameter);

/// The known parameter that begins with at least three letters like this and is the only one; else the same.
std::string whole_parameter(const KeywordRow& row, const std::string& parameter);

}  // namespace elastogear::mesh
