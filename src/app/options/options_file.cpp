#include "app/options/options_file.h"

#include <sstream>

#include "app/options/command_line.h"
#include "app/options/yaml.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"

namespace elastogear::app {
namespace {

constexpr const char* kYamlMark = ":yaml";

bool is_yaml(const std::string& name, const std::string& text) {
  for (const char* end : {kYamlMark, ".yaml", ".yml", ".json"})
    if (name.ends_with(end)) return true;
  return text.starts_with("%YAML ") || text.starts_with("---");
}

std::vector<OptionLine> yaml_lines(const std::string& text, const std::string& file) {
  std::vector<OptionLine> lines;
  for (const YamlEntry& entry : parse_yaml(text, file)) lines.push_back({entry.name, entry.line});
  return lines;
}

// "-name", "-name value" or "alias -name -other"; # begins a comment.
void add_line(const std::string& text, const std::string& where, int line, std::vector<OptionLine>& lines) {
  std::istringstream stream(text.substr(0, text.find('#')));
  std::vector<std::string> word;
  for (std::string next; stream >> next;) word.push_back(next);
  if (word.empty()) return;
  if (word[0] == "alias") {
    require(word.size() == 3 && is_option(word[1]) && is_option(word[2]), where,
            ": an alias is written 'alias -new_name -old_name'");
    return lines.push_back({word[1].substr(1), line});
  }
  require(is_option(word[0]), where, ": '", word[0], "' is no option; each line is '-name value'");
  require(word.size() <= 2 && !(word.size() == 2 && is_option(word[1])), where, ": '", word.back(),
          "' is one word too many; each line is '-name value'");
  lines.push_back({word[0].substr(1), line});
}

}  // namespace

std::string path_of_options_file(const std::string& name) {
  return name.ends_with(kYamlMark) ? name.substr(0, name.size() - std::string(kYamlMark).size()) : name;
}

std::vector<OptionLine> read_options_file(const std::string& name) {
  const std::string path = path_of_options_file(name), text = read_file(path);
  if (is_yaml(name, text)) return yaml_lines(text, path);
  std::vector<OptionLine> lines;
  std::istringstream stream(text);
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    add_line(line, path + ", line " + std::to_string(number), number, lines);
  }
  return lines;
}

bool names_options_file(const std::string& option) {
  return option == "-options_file" || option == "-options_file_yaml";
}

void check_options_source(const std::string& option, const std::string& value) {
  const bool text = option == "-options_string_yaml";
  if (!text && !names_options_file(option)) return;
  require(!value.empty(), "option ", option, " is given without ", text ? "a text" : "the name of a file");
  if (text) {
    parse_yaml(value, "option " + option);
  } else if (value.find("${") == value.npos) {  // PETSc fills in variables of the environment
    read_options_file(option == "-options_file" ? value : path_of_options_file(value) + kYamlMark);
  }
}

}  // namespace elastogear::app
