#include "elastogear/io/matrix_text.h"

#include <algorithm>
#include <numeric>

#include "elastogear/base/error.h"
#include "elastogear/base/number.h"

namespace elastogear::io {
namespace {

constexpr std::string_view kBanner = "%%MatrixMarket";
constexpr std::string_view kComments = "#%";
constexpr std::size_t kLabelled = 5, kPlain = 3;  // fields of an entry

int direction(const DelimitedReader& lines, std::int64_t d) {
  if (d > 3)
    lines.fail_here("direction ", d,
                    ", allowed are the displacements 1, 2, 3: only matrices of solid elements ",
                    "can be read");
  return static_cast<int>(d);
}

// "12.3": node 12, direction 3.
MatrixLabel split_label(const DelimitedReader& lines, std::string_view field) {
  const std::size_t dot = field.find('.');
  const auto node = parse<std::int64_t>(field.substr(0, dot));
  const auto d = dot == std::string_view::npos ? std::nullopt : parse<std::int64_t>(field.substr(dot + 1));
  if (!node || !d || *node < 1 || *d < 1)
    lines.fail_here("'", field.substr(0, 40), "' is no displacement, must be node.direction");
  return {*node, direction(lines, *d)};
}

}  // namespace

std::string text(const MatrixLabel& label) {
  const std::string number = std::to_string(label.number);
  return label.direction == 0 ? "row " + number
                              : "node " + number + ", direction " + std::to_string(label.direction);
}

MatrixReader::MatrixReader(std::istream& in, std::string source, MatrixFormat format)
    : lines_(in, std::move(source)), format_(format) {}

void MatrixReader::read_banner() {
  banner_ = true;
  const auto& fields = lines_.fields();
  const bool good = fields.size() == 5 && fields[1] == "matrix" && fields[2] == "coordinate" &&
                    (fields[3] == "real" || fields[3] == "integer") &&
                    (fields[4] == "symmetric" || fields[4] == "general");
  if (!good || format_ == MatrixFormat::abaqus)
    lines_.fail_here("a Matrix Market file must be 'matrix coordinate real symmetric' or 'general'");
  if (!lines_.next(kComments)) lines_.fail_here("ends before the size of the matrix");
  read_size();
}

void MatrixReader::read_size() {
  if (lines_.fields().size() != kPlain) lines_.fail_here("must be rows, columns and number of entries");
  size_ = lines_.count(0);
  announced_ = lines_.count(2);
  if (lines_.count(1) != size_)
    lines_.fail_here("the matrix has ", size_, " rows and ", lines_.count(1), " columns");
}

// Abaqus' comments begin with two stars.
bool MatrixReader::next(std::string_view comment) {
  while (lines_.next(comment))
    if (!lines_.fields()[0].starts_with("**")) return true;
  return false;
}

// Moves to the first entry of the matrix.
bool MatrixReader::start() {
  first_ = false;
  if (!next("#")) return false;
  if (lines_.fields()[0] == kBanner) {
    read_banner();
    if (!lines_.next(kComments)) return false;
  }
  if (format_ == MatrixFormat::automatic)
    format_ = lines_.fields().size() == kLabelled ? MatrixFormat::abaqus : MatrixFormat::triplets;
  return true;
}

MatrixEntry MatrixReader::entry() const {
  const auto& fields = lines_.fields();
  const bool labelled = format_ == MatrixFormat::abaqus;
  if (fields[0].starts_with('*'))
    lines_.fail_here("keyword ", fields[0].substr(0, 40),
                     ": must be an entry of *MATRIX OUTPUT, FORMAT=MATRIX INPUT");
  if (fields.size() != (labelled ? kLabelled : kPlain))
    lines_.fail_here("has ", fields.size(), " fields, must have ",
                     labelled ? "5: node, direction, node, direction, value" : "3: row, column, value");
  MatrixEntry e;
  e.value = lines_.number(fields.size() - 1);
  if (labelled) {
    e.row = {lines_.count(0), direction(lines_, lines_.count(1))};
    e.column = {lines_.count(2), direction(lines_, lines_.count(3))};
  } else {
    e.row = {lines_.count(0), 0};
    e.column = {lines_.count(1), 0};
    const std::int64_t largest = std::max(e.row.number, e.column.number);
    if (banner_ && largest > size_)
      lines_.fail_here("row or column ", largest, " of a matrix of size ", size_);
  }
  return e;
}

std::vector<MatrixEntry> MatrixReader::read(std::size_t most) {
  std::vector<MatrixEntry> entries;
  while (entries.size() < most && (first_ ? start() : next(kComments))) entries.push_back(entry());
  found_ += static_cast<std::int64_t>(entries.size());
  const bool at_end = entries.size() < most;
  if (banner_ && at_end && found_ != announced_)
    lines_.fail_here("the file ends after ", found_, " of ", announced_, " entries");
  if (at_end && found_ == 0) lines_.fail_here("there are no entries");
  return entries;
}

NodeTable read_node_table(std::istream& in, const std::string& source) {
  DelimitedReader lines(in, source);
  std::vector<std::int64_t> number;
  std::vector<double> X;
  while (lines.next("#*%")) {
    if (lines.fields().size() != 4) lines.fail_here("must be a node's number and three coordinates");
    number.push_back(lines.count(0));
    for (std::size_t i = 1; i <= 3; ++i) X.push_back(lines.number(i));
  }
  require(!number.empty(), source, ": there are no nodes");
  std::vector<int> order(number.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) { return number[i] < number[j]; });
  NodeTable table{{},
                  Eigen::Map<const Eigen::Matrix3Xd>(X.data(), 3, static_cast<Eigen::Index>(X.size() / 3))(
                      Eigen::all, order)};
  for (int i : order) table.number.push_back(number[i]);
  const auto twice = std::adjacent_find(table.number.begin(), table.number.end());
  require(twice == table.number.end(), source, ": node ", twice == table.number.end() ? 0 : *twice,
          " is given twice");
  return table;
}

std::vector<MatrixLabel> read_dof_table(std::istream& in, const std::string& source) {
  DelimitedReader lines(in, source);
  std::vector<MatrixLabel> labels;
  while (lines.next(kComments)) {
    const auto& fields = lines.fields();
    if (fields.size() > 2) lines.fail_here("has ", fields.size(), " fields, must be node.direction");
    labels.push_back(fields.size() == 1 ? split_label(lines, fields[0])
                                        : MatrixLabel{lines.count(0), direction(lines, lines.count(1))});
  }
  require(!labels.empty(), source, ": there are no displacements");
  auto sorted = labels;
  const auto key = [](const MatrixLabel& l) { return std::pair(l.number, l.direction); };
  std::sort(sorted.begin(), sorted.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  require(twice == sorted.end(), source, ": ", twice == sorted.end() ? "" : text(*twice), " is given twice");
  return labels;
}

}  // namespace elastogear::io
