#include "app/options/command_line.h"

#include <cctype>
#include <cstdlib>

#include "app/options/options_file.h"
#include "app/options/petsc_names.h"
#include "elastogear/base/error.h"

namespace elastogear::app {

CommandLine parse_command_line(int argc, char** argv) {
  CommandLine line;
  const auto asks = [](const std::string& word, const char* name) {
    return word == std::string("-") + name || word == std::string("--") + name;
  };
  bool options_began = false;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (asks(word, "help") || word == "-h") {
      line.help = true;
      if (i + 1 < argc && !is_option(argv[i + 1])) line.help_about = argv[i + 1];
    }
    if (asks(word, "version") && i == 1) line.version = true;
    options_began = options_began || is_option(word) || word.starts_with("--");
    if (options_began) continue;
    if (line.verb.empty() && (word.ends_with(".yaml") || word.ends_with(".yml"))) line.verb = "run";
    if (line.verb.empty())
      line.verb = word;
    else
      line.arguments.push_back(word);
  }
  return line;
}

bool is_option(const std::string& word) {
  const std::size_t first = word.starts_with("--") ? 2 : 1;
  if (word.size() <= first || word[0] != '-' || !std::isalpha(static_cast<unsigned char>(word[first])))
    return false;
  char* end = nullptr;
  std::strtod(word.c_str() + first - 1, &end);  // -inf is a number, -inflow is not
  const bool number = end != word.c_str() + first - 1;
  return !number || *end == '_' || std::isalnum(static_cast<unsigned char>(*end));
}

std::vector<GivenOption> given_options(int argc, char** argv) {
  std::vector<GivenOption> words;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (!is_option(word)) {
      require(words.empty(), "'", word,
              "' belongs to no option: an option takes one value, a list is written a,b without blanks, and "
              "files stand before the options");
      continue;
    }
    const bool has_value = i + 1 < argc && !is_option(argv[i + 1]);
    words.push_back({word.substr(word.starts_with("--") ? 2 : 1), has_value ? argv[i + 1] : ""});
    if (has_value) ++i;
  }
  return expanded(words);
}

std::vector<std::string> words_of_petsc(const std::string& program, const std::vector<GivenOption>& options) {
  std::vector<std::string> words = {program};
  for (const GivenOption& option : options) {
    if (!is_petsc_name(option.name)) continue;
    words.push_back("-" + option.name);
    if (!option.value.empty()) words.push_back(option.value);
  }
  return words;
}

}  // namespace elastogear::app
