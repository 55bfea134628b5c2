#include "inp_lines.h"

#include <algorithm>
#include <cctype>

namespace elastogear::mesh {
namespace {

constexpr std::string_view kBlank = " \t\r";

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string_view unquoted(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  while (!line.empty()) {
    const std::size_t comma = std::min(line.find(','), line.size());
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

bool InpLines::next() {
  while (position_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    line_ = trim(std::string_view(text_).substr(position_, end - position_));
    position_ = std::min(end + 1, text_.size());
    ++number_;
    if (!line_.empty() && !line_.starts_with("**")) return true;
  }
  line_ = {};
  return false;
}

bool InpLines::next_data() {
  const std::size_t position = position_;
  const int number = number_;
  const std::string_view line = line_;
  if (next() && !at_keyword()) return true;
  position_ = position;
  number_ = number;
  line_ = line;
  return false;
}

void InpLines::add_parameter(Keyword& keyword, std::string_view text) const {
  if (text.empty()) return;
  const std::size_t equal = text.find('=');
  const std::string name = upper(trim(text.substr(0, equal)));
  const std::string_view value =
      equal == std::string_view::npos ? std::string_view() : unquoted(trim(text.substr(equal + 1)));
  if (!keyword.parameters.emplace(name, value).second) fail_here("parameter ", name, " is given twice");
}

Keyword InpLines::keyword() {
  Keyword result;
  result.line = number_;
  split(line_.substr(1), fields_);
  result.name = fields_.empty() ? "" : upper(fields_[0]);
  for (std::size_t i = 1; i < fields_.size(); ++i) add_parameter(result, fields_[i]);
  while (continues() && next()) {
    if (at_keyword()) fail_here("a keyword line ends with a comma but does not continue");
    split(line_, fields_);
    for (std::string_view field : fields_) add_parameter(result, field);
  }
  return result;
}

const std::vector<std::string_view>& InpLines::fields() {
  split(line_, fields_);
  return fields_;
}

}  // namespace elastogear::mesh
