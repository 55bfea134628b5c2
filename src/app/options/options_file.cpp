#include "app/options/options_file.h"

#include <map>
#include <sstream>

#include "app/options/command_line.h"
#include "app/options/yaml.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"

namespace elastogear::app {
namespace {

constexpr const char* kYamlMark = ":yaml";
constexpr const char* kAlias = "alias";
constexpr const char* kText = "options_string_yaml";
constexpr int kMostFiles = 20;  // files that name files

bool is_yaml(const std::string& name, const std::string& text) {
  for (const char* end : {kYamlMark, ".yaml", ".yml", ".json"})
    if (name.ends_with(end)) return true;
  return text.starts_with("%YAML ") || text.starts_with("---");
}

std::string place_in(const std::string& file, int line) { return file + ", line " + std::to_string(line); }

std::vector<GivenOption> yaml_options(const std::string& text, const std::string& file) {
  std::vector<GivenOption> options;
  for (const YamlEntry& entry : parse_yaml(text, file))
    options.push_back({entry.name, entry.value, place_in(file, entry.line)});
  return options;
}

std::string without_dashes(const std::string& option) {
  return option.substr(option.starts_with("--") ? 2 : 1);
}

// "-name", "-name value" or "alias -name -other"; # begins a comment.
void add_line(const std::string& text, const std::string& where, std::vector<GivenOption>& options) {
  std::istringstream stream(text.substr(0, text.find('#')));
  std::vector<std::string> word;
  for (std::string next; stream >> next;) word.push_back(next);
  if (word.empty()) return;
  if (word[0] == kAlias) {
    require(word.size() == 3 && is_option(word[1]) && is_option(word[2]), where,
            ": an alias is written 'alias -new_name -old_name'");
    options.push_back({kAlias + (" " + without_dashes(word[1])), without_dashes(word[2]), where});
    return;
  }
  require(is_option(word[0]), where, ": '", word[0], "' is no option; each line is '-name value'");
  require(word.size() <= 2 && !(word.size() == 2 && is_option(word[1])), where, ": '", word.back(),
          "' is one word too many; each line is '-name value'");
  options.push_back({without_dashes(word[0]), word.size() > 1 ? word[1] : "", where});
}

// Prefixes and aliases in force, and files that are being read.
struct Expansion {
  std::vector<GivenOption> options = {};
  std::vector<std::string> prefixes = {""};
  std::map<std::string, std::string> aliases = {};
  int depth = 0;
};

std::vector<GivenOption> read_source(const GivenOption& option) {
  const bool text = option.name == kText;
  require(!option.value.empty(), "option -", option.name, " is given without ",
          text ? "a text" : "the name of a file");
  if (text) return yaml_options(option.value, "option -" + option.name);
  return read_options_file(option.name == "options_file" ? option.value
                                                         : path_of_options_file(option.value) + kYamlMark);
}

void expand_into(Expansion& all, const std::vector<GivenOption>& given) {
  require(++all.depth <= kMostFiles, given.empty() ? "" : given[0].place + ": ",
          "files of options name each other without end");
  for (GivenOption option : given) {
    if (option.name.starts_with(kAlias + std::string(" "))) {
      all.aliases[option.name.substr(std::string(kAlias).size() + 1)] = option.value;
    } else if (option.name == "prefix_push") {
      all.prefixes.push_back(all.prefixes.back() + option.value);
    } else if (option.name == "prefix_pop") {
      require(all.prefixes.size() > 1, "option -prefix_pop: no -prefix_push goes before it");
      all.prefixes.pop_back();
    } else if (option.name == kText || names_options_file(option)) {
      expand_into(all, read_source(option));
    } else {
      option.name = all.prefixes.back() + option.name;
      if (const auto alias = all.aliases.find(option.name); alias != all.aliases.end())
        option.name = alias->second;
      all.options.push_back(option);
    }
  }
  --all.depth;
}

}  // namespace

std::string path_of_options_file(const std::string& name) {
  return name.ends_with(kYamlMark) ? name.substr(0, name.size() - std::string(kYamlMark).size()) : name;
}

std::vector<GivenOption> read_options_file(const std::string& name) {
  const std::string path = path_of_options_file(name), text = read_file(path);
  if (is_yaml(name, text)) return yaml_options(text, path);
  std::vector<GivenOption> options;
  std::istringstream stream(text);
  int number = 0;
  for (std::string line; std::getline(stream, line);) add_line(line, place_in(path, ++number), options);
  return options;
}

bool names_options_file(const GivenOption& option) {
  return (option.name == "options_file" || option.name == "options_file_yaml") &&
         option.value.find("${") == option.value.npos;
}

std::vector<GivenOption> expanded(const std::vector<GivenOption>& words) {
  Expansion all;
  expand_into(all, words);
  return all.options;
}

}  // namespace elastogear::app
