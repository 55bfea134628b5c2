#pragma once
// The program's own options: one table per verb says name, unit, default and meaning. The table makes -help,
// finds misspelt keys and holds every default. All reads of our own keys go through `Options`.

#include <Eigen/Core>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "app/options/option_table.h"

namespace elastogear::app {

/// A text of YAML that a program gives in place of a file. Its name stands in messages about its form.
struct OptionText {
  std::string yaml, name;
};

/// Where options come from; later ones win.
struct OptionSources {
  std::vector<std::string> files = {};
  std::vector<OptionText> texts = {};  ///< read as files are
  int argc = 0;
  char** argv = nullptr;                ///< the command line
  std::vector<OptionText> chosen = {};  ///< options of the running verb that a program sets
};

/// The options in force: files given on the command line first, then the command line again, so that it wins.
class Options {
 public:
  /// `known`: tables of all verbs (a file may serve several verbs); `own`: the running verb's table.
  Options(std::string verb, OptionTable own, OptionTable known);

  /// Takes files and texts, promotes keys of the verb's own section ("recover_output" -> "output"), then
  /// takes the command line, then what is chosen. PETSc's options go to its database, too. Throws Error for
  /// missing or malformed files, naming the line. Collective.
  void load(const OptionSources& sources);

  /// The verb's options as YAML files have them, later ones first, apart from those of the run. Throws Error
  /// for missing or malformed files, naming the line.
  static Options of_files(std::string verb, const OptionTable& own, const std::vector<std::string>& files);

  /// Throws Error for the first key that neither a table nor PETSc knows, naming where it was given and the
  /// nearest known key. `values` restrict "<body>"-like names; placeholders without an entry stand for any
  /// word, "<gear>" for those of option gears, where there is a drive, and "<bearing>" for those of their
  /// options bearings.
  void reject_unknown(const PlaceholderValues& values = {}) const;

  bool given(const std::string& name) const;
  std::string text(const std::string& name) const;  ///< Error when neither given nor defaulted
  double number(const std::string& name) const;     ///< finite number
  double positive(const std::string& name) const;   ///< finite number > 0
  int count(const std::string& name, int smallest = 0) const;
  bool flag(const std::string& name) const;
  Eigen::Vector3d vector(const std::string& name) const;
  std::vector<double> numbers(const std::string& name) const;
  std::vector<std::string> list(const std::string& name) const;  ///< may be empty
  /// The list given, then what the files' value of this key has besides: names whose keys are in place
  /// although the command line leaves them out. Any verb's key; no default.
  std::vector<std::string> list_with_files(const std::string& name) const;
  /// The position of the value among `allowed`, else Error listing them.
  int choice(const std::string& name, const std::vector<std::string>& allowed) const;

  /// Was it written with a unit, "1500 rpm"?
  bool has_unit(const std::string& name) const { return with_unit_.contains(name); }

  /// Names given by the user that fit a pattern "material_<set>_E", with what the placeholder stands for.
  /// What is an option of another verb, letter by letter, is none, "stress_recovery" of "stress_<body>", but
  /// in the verb's own section.
  std::vector<std::string> placeholder_values(const std::string& pattern) const;

  /// The same with the keys of a section, "pinion_modes", in place of the verb's own ones, "modes", but for
  /// `excluded` ones.
  Options of_section(const std::string& section, const std::vector<std::string>& excluded) const;
  /// The same options as another verb reads them: of files its own sections ("reduce_modes") are its own.
  Options of_verb(const std::string& verb, const OptionTable& own) const;
  /// Takes this value, in the unit that the option has, whatever is given.
  void set(const std::string& name, const std::string& value);
  /// Takes this value where none is given.
  void set_default(const std::string& name, const std::string& value);

  /// Adds a word to the list that an option holds.
  void append(const std::string& name, const std::string& word);

  /// Everything in force, defaults included ("option_torque"), what files say of options that have another
  /// value ("in_files_torque", empty where they say nothing), which of these are of the command line
  /// ("command_line_torque"), and the versions of the program and its libraries.
  std::map<std::string, std::string> provenance() const;
  /// Is the value another one than that of the files, by the command line or a case of a sweep?
  bool overrides_files(const std::string& name) const;
  /// The default of one of the verb's own options; empty: none.
  std::string default_of(const std::string& name) const;
  /// The unit of an option of any verb; empty: it has none.
  std::string unit_of(const std::string& name) const;
  /// Is it one of the verb's own options?
  bool is_own(const std::string& name) const { return has(own_, name); }
  /// Has a verb this key, letter by letter, placeholders and all: "<body>_torque"?
  bool has_key(const std::string& pattern) const;
  /// Does a key of any verb begin with this word and an underscore, whatever words stand for placeholders?
  bool begins_key(const std::string& word) const;
  /// Is this key, `given` or not, one of another verb alone?
  bool is_of_other_verb(const std::string& name) const;
  const std::string& verb() const { return verb_; }
  /// "option -ts_dt", and the file and line that it comes from.
  std::string label(const std::string& name) const;
  /// Files that the options were read from.
  const std::vector<std::string>& files() const { return files_; }
  /// Values given for the verb's own options, by name.
  std::map<std::string, std::string> given_to_verb() const;

 private:
  const OptionSpec& spec(const std::string& name) const;
  enum class Source { file, text, chosen };
  void insert(const std::string& text, const std::string& name, Source source);
  void promote_own_section();
  void insert_command_line(const std::map<std::string, std::string>& of_environment, int argc, char** argv);
  void note_options_files(int argc, char** argv);
  void give_to_petsc() const;
  void convert_units();
  std::string in_own_unit(const std::string& name, const std::string& value) const;
  void note_overrides();
  void take(const std::string& own, const Options& from, const std::string& name, const std::string& value);

  std::string verb_;
  OptionTable own_, known_;
  std::map<std::string, std::string> given_, given_in_files_;
  std::set<std::string> bare_;                   // given by their names alone, as flags are
  std::set<std::string> promoted_;               // of given_, from the verb's own section
  std::set<std::string> with_unit_;              // of given_, written with a unit
  std::map<std::string, std::string> place_;     // of given_in_files_: "file.yaml, line 3"
  std::map<std::string, std::string> written_;   // by files and texts
  std::map<std::string, std::string> in_files_;  // of options whose value is another one; empty: none
  std::set<std::string> by_default_;             // of in_files_, those that set_default() has set
  std::set<std::string> on_command_line_;        // of in_files_ as options are loaded
  std::vector<std::string> files_;
};

}  // namespace elastogear::app
