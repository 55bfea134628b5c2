#include "app/options/yaml.h"

#include <yaml.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

constexpr int kDeepest = 50;        // nested maps: aliases can make endless ones
constexpr int kMostNodes = 100000;  // visited: aliases of aliases grow without bound

struct Parser {
  yaml_parser_t raw{};
  Parser() { require(yaml_parser_initialize(&raw) != 0, "libyaml: out of memory"); }
  ~Parser() { yaml_parser_delete(&raw); }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;
};

struct Document {
  yaml_document_t raw{};
  Document() = default;
  ~Document() { yaml_document_delete(&raw); }
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;
};

struct Reader {
  const std::string& file;
  yaml_document_t& document;
  std::vector<YamlEntry> entries = {};
  int n_visited = 0;

  yaml_node_t& node(int index) { return *yaml_document_get_node(&document, index); }
};

struct Place {
  std::string prefix = {};  // "a_b_"
  int depth = 0;
  bool merged = false;
};

int line_of(const yaml_node_t& node) { return static_cast<int>(node.start_mark.line) + 1; }

template <class... Parts>
[[noreturn]] void refuse(const Reader& reader, const yaml_node_t& node, const Parts&... parts) {
  fail(reader.file, ", line ", line_of(node), ": ", parts...);
}

std::string scalar(const yaml_node_t& node) {
  return {reinterpret_cast<const char*>(node.data.scalar.value), node.data.scalar.length};
}

void read_map(Reader& reader, const yaml_node_t& map, const Place& place);

std::string key_of(const Reader& reader, const yaml_node_t& key, const Place& place) {
  if (key.type != YAML_SCALAR_NODE) refuse(reader, key, "a key must be a word, not a list or a map");
  const std::string word = scalar(key);
  const auto fits = [](unsigned char c) { return std::isgraph(c) || c >= 0x80; };
  const std::string name = place.prefix + word;
  if (word.empty() || !std::all_of(word.begin(), word.end(), fits) ||
      !std::isalpha(static_cast<unsigned char>(name[0])))
    refuse(reader, key, "'", word, "' is no key: it must be one word that begins with a letter");
  return name;
}

// An item that is quoted is one item, whatever commas it has.
std::string item_text(const yaml_node_t& node) {
  const std::string text = scalar(node);
  const auto style = node.data.scalar.style;
  const bool quoted = style == YAML_SINGLE_QUOTED_SCALAR_STYLE || style == YAML_DOUBLE_QUOTED_SCALAR_STYLE;
  return quoted && text.find(',') != text.npos && text.find('"') == text.npos ? '"' + text + '"' : text;
}

// Maps in a list give their keys to the prefix, and their first key's name to the list.
std::string list_text(Reader& reader, const yaml_node_t& list, const Place& below) {
  std::string text;
  for (const auto* item = list.data.sequence.items.start; item < list.data.sequence.items.top; ++item) {
    const yaml_node_t& node = reader.node(*item);
    std::string part;
    if (node.type == YAML_SCALAR_NODE) {
      part = item_text(node);
    } else if (node.type == YAML_MAPPING_NODE &&
               node.data.mapping.pairs.top - node.data.mapping.pairs.start == 1) {
      part = scalar(reader.node(node.data.mapping.pairs.start->key));
      read_map(reader, node, below);
    } else {
      refuse(reader, node, "a list must hold words or numbers: [a, b]");
    }
    if (!part.empty()) text += (text.empty() ? "" : ",") + part;
  }
  return text;
}

void merge(Reader& reader, const yaml_node_t& value, Place place) {
  place.merged = true;
  ++place.depth;
  if (value.type == YAML_MAPPING_NODE) return read_map(reader, value, place);
  if (value.type != YAML_SEQUENCE_NODE) refuse(reader, value, "the merge key << must name a map");
  for (const auto* item = value.data.sequence.items.start; item < value.data.sequence.items.top; ++item)
    merge(reader, reader.node(*item), place);
}

void read_pair(Reader& reader, const yaml_node_t& key, const yaml_node_t& value, const Place& place) {
  if (key.type == YAML_SCALAR_NODE && scalar(key) == "<<") return merge(reader, value, place);
  if (key.type == YAML_SCALAR_NODE && scalar(key).starts_with("$$")) return;
  const std::string name = key_of(reader, key, place);
  const Place below{name + "_", place.depth + 1, place.merged};
  if (value.type == YAML_MAPPING_NODE) return read_map(reader, value, below);
  const std::string text = value.type == YAML_SCALAR_NODE ? scalar(value) : list_text(reader, value, below);
  reader.entries.push_back({name, text, line_of(key), place.merged});
}

void require_different_keys(Reader& reader, const yaml_node_t& map) {
  std::map<std::string, int> lines;
  for (const auto* pair = map.data.mapping.pairs.start; pair < map.data.mapping.pairs.top; ++pair) {
    const yaml_node_t& key = reader.node(pair->key);
    if (key.type != YAML_SCALAR_NODE || scalar(key) == "<<") continue;
    const auto [at, is_new] = lines.emplace(scalar(key), line_of(key));
    if (!is_new) refuse(reader, key, "the key ", at->first, " is given twice, first in line ", at->second);
  }
}

void read_map(Reader& reader, const yaml_node_t& map, const Place& place) {
  if (map.type != YAML_MAPPING_NODE) refuse(reader, map, "must be keys and values, 'key: value'");
  if (place.depth > kDeepest) refuse(reader, map, "maps are nested more than ", kDeepest, " deep");
  require_different_keys(reader, map);
  for (const auto* pair = map.data.mapping.pairs.start; pair < map.data.mapping.pairs.top; ++pair) {
    if (++reader.n_visited > kMostNodes) refuse(reader, map, "holds more than ", kMostNodes, " keys");
    read_pair(reader, reader.node(pair->key), reader.node(pair->value), place);
  }
}

void set_input(Parser& parser, const std::string& text) {
  yaml_parser_set_input_string(&parser.raw, reinterpret_cast<const unsigned char*>(text.data()), text.size());
}

// Lists and maps in brackets, of which libyaml takes a time that grows with the square of their depth: too
// deep ones are refused before the rest of them is read. What is no YAML is left to load().
void require_shallow(const std::string& text, const std::string& file) {
  Parser parser;
  set_input(parser, text);
  int depth = 0;
  for (bool ended = false; !ended;) {
    yaml_event_t event;
    if (!yaml_parser_parse(&parser.raw, &event)) return;
    const std::size_t line = event.start_mark.line + 1;
    depth += (event.type == YAML_SEQUENCE_START_EVENT || event.type == YAML_MAPPING_START_EVENT) -
             (event.type == YAML_SEQUENCE_END_EVENT || event.type == YAML_MAPPING_END_EVENT);
    ended = event.type == YAML_STREAM_END_EVENT;
    yaml_event_delete(&event);
    require(depth <= 2 * kDeepest, file, ", line ", line, ": lists and maps are nested more than ",
            2 * kDeepest, " deep");
  }
}

void load(Parser& parser, Document& document, const std::string& file) {
  if (yaml_parser_load(&parser.raw, &document.raw)) return;
  const std::string problem = parser.raw.problem ? parser.raw.problem : "cannot be read";
  const std::string context = parser.raw.context ? std::string(parser.raw.context) + ": " : "";
  std::size_t line = parser.raw.problem_mark.line;
  if (parser.raw.context) line = std::max(line, parser.raw.context_mark.line);
  fail(file, ", line ", line + 1, ": is no valid YAML (", context, problem, ")");
}

// PETSc does not tell capitals from small letters in names of options.
std::string in_small_letters(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

// Keeps one entry for each name. Entries from merge keys give way to others; throws Error for names that are
// given twice otherwise.
std::vector<YamlEntry> each_once(const std::vector<YamlEntry>& all, const std::string& file) {
  std::map<std::string, const YamlEntry*> first;
  for (const YamlEntry& entry : all) {
    const YamlEntry*& at = first[in_small_letters(entry.name)];
    require(!at || at->merged || entry.merged, file, ", line ", entry.line, ": the key ", entry.name,
            " is given twice, first in line ", at ? at->line : 0);
    if (!at || at->merged) at = &entry;
  }
  std::vector<YamlEntry> entries;
  for (const YamlEntry& entry : all)
    if (first.at(in_small_letters(entry.name)) == &entry) entries.push_back(entry);
  return entries;
}

}  // namespace

std::vector<YamlEntry> parse_yaml(const std::string& text, const std::string& file) {
  require_shallow(text, file);
  Parser parser;
  set_input(parser, text);
  std::vector<YamlEntry> all;
  while (true) {
    Document document;
    load(parser, document, file);
    const yaml_node_t* root = yaml_document_get_root_node(&document.raw);
    if (!root) return each_once(all, file);
    if (root->type == YAML_SCALAR_NODE && scalar(*root).empty()) continue;
    Reader reader{file, document.raw};
    read_map(reader, *root, {});
    all.insert(all.end(), reader.entries.begin(), reader.entries.end());
  }
}

}  // namespace elastogear::app
