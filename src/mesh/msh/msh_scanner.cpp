#include "mesh/msh/msh_scanner.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elastogear::mesh {
namespace {

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

}  // namespace

bool MshScanner::at_end() {
  while (position_ < text_.size() && is_space(text_[position_])) ++position_;
  return position_ == text_.size();
}

std::string_view MshScanner::word(const char* what) {
  if (at_end()) fail_here("the file ends where ", what, " is expected");
  const std::size_t start = position_;
  while (position_ < text_.size() && !is_space(text_[position_])) ++position_;
  return std::string_view(text_).substr(start, position_ - start);
}

std::string_view MshScanner::line() {
  const std::size_t start = position_;
  position_ = std::min(text_.find('\n', start), text_.size());
  std::string_view found = std::string_view(text_).substr(start, position_ - start);
  if (position_ < text_.size()) ++position_;
  if (found.ends_with('\r')) found.remove_suffix(1);
  return found;
}

void MshScanner::expect(std::string_view keyword) {
  if (at_end()) fail_here("the file ends where ", keyword, " is expected");
  if (std::string_view(text_).substr(position_, keyword.size()) != keyword)
    fail_here("expected ", keyword, " here: the counts of this section do not match its data");
  position_ += keyword.size();
}

void MshScanner::skip_past(const std::string& keyword) {
  const std::size_t found = text_.find(keyword, position_);
  if (found == std::string::npos) fail_here("the file ends before ", keyword);
  position_ = found + keyword.size();
}

double MshScanner::real(const char* what) {
  const auto value = number<double>(what);
  if (!std::isfinite(value)) fail_here(what, " is ", value, ", must be finite");
  return value;
}

std::int64_t MshScanner::tag(const char* what) {
  const auto value = number<std::uint64_t>(what);
  if (value == 0 || value > std::numeric_limits<std::int64_t>::max())
    fail_here(what, " is ", value, ", must be a positive number");
  return static_cast<std::int64_t>(value);
}

std::size_t MshScanner::count(const char* what, std::size_t bytes_each) {
  const auto value = number<std::uint64_t>(what);
  if (value > (text_.size() - position_) / bytes_each)
    fail_here(what, " is ", value, ", but only ", text_.size() - position_, " bytes follow");
  return value;
}

std::string MshScanner::place() const {
  if (binary_) return "byte " + std::to_string(position_);
  return "line " + std::to_string(1 + std::count(text_.begin(), text_.begin() + position_, '\n'));
}

}  // namespace elastogear::mesh
