#include "mesh/inp/lines/inp_lines.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

namespace elastogear::mesh {
namespace {

constexpr std::string_view kBlank = " \t\r";
constexpr std::string_view kInclude = "INCLUDE";
constexpr std::size_t kMaxIncludes = 10;  // of files within files

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string_view unquoted(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

// Is the text UTF-8, as far as its leading and continuing bytes tell?
bool is_utf8(std::string_view text) {
  int continuing = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool continues = (byte & 0xC0) == 0x80;
    if (continues != (continuing > 0)) return false;
    if (continues)
      --continuing;
    else if (byte >= 0x80)
      continuing = byte >= 0xF0 ? 3 : byte >= 0xE0 ? 2 : 1;
    if (byte == 0xC0 || byte == 0xC1 || byte > 0xF4) return false;
  }
  return continuing == 0;
}

// In UTF-8, from that with or without its mark, or from Latin-1.
std::string utf8(std::string text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (text.starts_with(kMark)) text.erase(0, kMark.size());
  if (is_utf8(text)) return text;
  std::string converted;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      converted += c;
    } else {
      converted += static_cast<char>(0xC0 | byte >> 6);
      converted += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return converted;
}

// The next comma outside of double quotes, or the end.
std::size_t field_end(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == ',' && !quoted) return i;
  }
  return quoted ? std::min(line.find(','), line.size()) : line.size();
}

void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  while (!line.empty()) {
    const std::size_t comma = field_end(line);
    fields.push_back(unquoted(trim(line.substr(0, comma))));
    line.remove_prefix(std::min(comma + 1, line.size()));
  }
}

}  // namespace

std::string upper(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  return result;
}

std::string Keyword::value(const std::string& parameter) const {
  const auto found = parameters.find(parameter);
  return found == parameters.end() ? "" : upper(found->second);
}

InpLines::InpLines(InpText text) : open_file_(std::move(text.open)) {
  enter(files_.emplace_back(File{std::move(text.path), utf8(std::move(text.content))}));
}

void InpLines::enter(File& file) {
  open_.push_back(&file);
  segments_.push_back({number_ + 1, {&file, 1}});
}

std::size_t InpLines::total_size() const {
  std::size_t size = 0;
  for (const File& file : files_) size += file.text.size();
  return size;
}

InpLines::Location InpLines::locate(int number) const {
  const auto after = [](int n, const Segment& segment) { return n < segment.first; };
  const auto next = std::upper_bound(segments_.begin() + 1, segments_.end(), number, after);
  const Segment& segment = *(next - 1);
  return {segment.location.file, segment.location.line + number - segment.first};
}

std::string InpLines::place(int number) const {
  const auto [file, line] = locate(number);
  return (file == &files_.front() ? "" : file->path + ", ") + "line " + std::to_string(line);
}

// The next line with content of whatever file is being read.
bool InpLines::next_line() {
  while (!open_.empty()) {
    File& file = *open_.back();
    while (file.position < file.text.size()) {
      const std::size_t end = std::min(file.text.find('\n', file.position), file.text.size());
      line_ = trim(std::string_view(file.text).substr(file.position, end - file.position));
      file.position = std::min(end + 1, file.text.size());
      ++number_;
      ++file.lines;
      if (!line_.empty() && !line_.starts_with("**")) return true;
    }
    open_.pop_back();
    if (!open_.empty()) segments_.push_back({number_ + 1, {open_.back(), open_.back()->lines + 1}});
  }
  line_ = {};
  return false;
}

void InpLines::include_line() {
  if (continues()) fail_here("*INCLUDE must stand on one line");
  const Keyword key = keyword();
  if (!key.has("INPUT")) fail_here("*INCLUDE without INPUT=file");
  include(key);
}

void InpLines::include(const Keyword& key) {
  namespace fs = std::filesystem;
  const std::string star = "*" + key.name;
  // The lines behind such a one have been looked at, and their file may have ended.
  if (ahead_ || open_.empty()) fail_here(star, ", INPUT= ends with a comma: delete it");
  if (open_.size() > kMaxIncludes) fail_here("files include each other more than ", kMaxIncludes, " deep");
  const fs::path name = fs::path(open_.back()->path).parent_path() / key.parameters.at("INPUT");
  const std::string path = name.lexically_normal().string();
  for (const File& file : files_)
    if (fs::path(file.path).lexically_normal() == path)
      fail_here(star, " of ", path, ", which is read already");
  std::string content;
  try {
    content = open_file_(path);
  } catch (const Error& error) {
    fail_here(star, ": ", error.what());
  }
  enter(files_.emplace_back(File{path, utf8(std::move(content))}));
}

bool InpLines::next() {
  if (ahead_) {
    line_ = ahead_->text;
    number_ = ahead_->number;
    ahead_.reset();
    return true;
  }
  while (next_line()) {
    if (!at_keyword() || !upper(line_.substr(1, kInclude.size())).starts_with(kInclude)) return true;
    include_line();
  }
  return false;
}

bool InpLines::next_data() {
  const Line current{line_, number_};
  const bool found = next();
  if (found && !at_keyword()) return true;
  if (found) ahead_ = Line{line_, number_};
  return_to(current.text, current.number);
  return false;
}

void InpLines::return_to(std::string_view line, int number) {
  line_ = line;
  number_ = number;
}

void InpLines::add_parameter(Keyword& keyword, std::string_view text) const {
  if (text.empty()) return;
  const std::size_t equal = text.find('=');
  std::string name = upper(trim(text.substr(0, equal)));
  if (keyword.row) name = whole_parameter(*keyword.row, name);
  const std::string_view value =
      equal == std::string_view::npos ? std::string_view() : unquoted(trim(text.substr(equal + 1)));
  if (!keyword.parameters.emplace(name, value).second) fail_here("parameter ", name, " is given twice");
}

Keyword InpLines::keyword() {
  Keyword result;
  result.line = number_;
  split(line_.substr(1), fields_);
  if (!fields_.empty()) result.name = upper(fields_[0]);
  if (const KnownKeyword* known = find_keyword(result.name)) {
    result.name = known->name;
    result.row = known->row;
  }
  for (std::size_t i = 1; i < fields_.size(); ++i) add_parameter(result, fields_[i]);
  for (Line current{line_, number_}; continues() && next(); current = {line_, number_}) {
    if (at_keyword() || !holds_parameters(result)) {
      ahead_ = Line{line_, number_};
      return_to(current.text, current.number);
      break;
    }
    split(line_, fields_);
    for (std::string_view field : fields_) add_parameter(result, field);
  }
  return result;
}

// Data lines of keywords that are read hold no names of their parameters.
bool InpLines::holds_parameters(const Keyword& keyword) const {
  const std::string_view first = trim(line_.substr(0, line_.find_first_of(",=")));
  if (line_.substr(0, line_.find(',')).find('=') != line_.npos) return true;
  return keyword.row && knows(*keyword.row, upper(first));
}

const std::vector<std::string_view>& InpLines::fields() {
  split(line_, fields_);
  return fields_;
}

double InpLines::real(std::string_view field, const char* what) const {
  std::string text(field);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
  const double value = parse_field<double>(text, what);
  if (!std::isfinite(value)) fail_here(what, " is ", value, ", must be finite");
  return value;
}

std::vector<double> InpLines::reals(const char* what) {
  std::vector<double> values;
  for (std::string_view field : fields()) values.push_back(field.empty() ? 0 : real(field, what));
  return values;
}

}  // namespace elastogear::mesh
