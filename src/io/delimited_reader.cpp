#include "elastogear/io/delimited_reader.h"

#include <algorithm>
#include <cmath>

#include "elastogear/base/number.h"

namespace elastogear::io {
namespace {

constexpr std::string_view kSeparators = " \t\r,";
constexpr std::size_t kShown = 40;  // characters of a field in an error

void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (std::size_t begin = 0;
       (begin = line.find_first_not_of(kSeparators, begin)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kSeparators, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = end;
  }
}

// "torque [kN m]" is one field.
void split_at_blanks(std::string_view line, std::vector<std::string_view>& fields) {
  constexpr std::string_view kBlanks = " \t\r";
  fields.clear();
  for (std::size_t begin = 0; (begin = line.find_first_not_of(kBlanks, begin)) != line.npos;) {
    std::size_t end = begin;
    for (int depth = 0; end < line.size() && (depth > 0 || kBlanks.find(line[end]) == kBlanks.npos); ++end)
      depth += (line[end] == '[') - (line[end] == ']');
    fields.push_back(line.substr(begin, end - begin));
    begin = end;
  }
}

// A comma at the end separates nothing.
void split_at_commas(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const auto first = line.find_first_not_of(" \t\r", begin);
    const auto last = line.find_last_not_of(" \t\r", end - 1);
    const bool blank = first >= end;
    if (!blank || end < line.size()) fields.push_back(blank ? "" : line.substr(first, last + 1 - first));
    begin = end + 1;
  }
}

}  // namespace

bool DelimitedReader::next(std::string_view comment) {
  while (in_->getline(buffer_, kBuffer)) {
    ++line_;
    const auto size =
        static_cast<std::size_t>(in_->gcount()) - (in_->eof() ? 0 : 1);  // without the line's end
    split({buffer_, size}, fields_);
    if (fields_.empty() || comment.find(fields_[0][0]) != std::string_view::npos) continue;
    if (separator_ == Separator::any) return true;
    const std::string_view line(buffer_, size);
    if (!by_commas_ && !by_blanks_) (line.find(',') != line.npos ? by_commas_ : by_blanks_) = true;
    by_commas_ ? split_at_commas(line, fields_) : split_at_blanks(line, fields_);
    return true;
  }
  ++line_;
  fields_.clear();
  if (in_->bad()) fail_here("cannot be read");
  if (!in_->eof()) fail_here("is longer than ", kBuffer - 1, " characters");
  return false;
}

double DelimitedReader::number(std::size_t field) const {
  char digits[64];
  const std::string_view given = fields_[field];
  const std::size_t size = std::min(given.size(), sizeof digits);
  std::transform(given.begin(), given.begin() + static_cast<std::ptrdiff_t>(size), digits,
                 [](char c) { return c == 'D' || c == 'd' ? 'e' : c; });
  const auto value = parse<double>({digits, size});
  if (size < given.size() || !value || !std::isfinite(*value))
    fail_here("'", given.substr(0, kShown), "' must be a finite number");
  return *value;
}

std::int64_t DelimitedReader::count(std::size_t field) const {
  const auto value = parse<std::int64_t>(fields_[field]);
  if (!value || *value < 1)
    fail_here("'", fields_[field].substr(0, kShown), "' must be a whole number of at least 1");
  return *value;
}

}  // namespace elastogear::io
