#include "elastogear/io/csv.h"

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"

namespace elastogear::io {
namespace {

void require_plain(const std::string& path, const std::string& text) {
  require(text.find_first_of(",\"\r\n") == std::string::npos, path, ": '", text,
          "' holds a comma, quote or line end");
}

Eigen::Index size(const CsvColumn& column) {
  return column.words.empty() ? column.values.size() : static_cast<Eigen::Index>(column.words.size());
}

}  // namespace

void write_csv(const std::string& path, const std::vector<CsvColumn>& columns) {
  const Eigen::Index rows = columns.empty() ? 0 : size(columns[0]);
  std::string out;
  for (const CsvColumn& column : columns) {
    const std::string title = column.words.empty() ? column.name + " [" + column.unit + "]" : column.name;
    require_plain(path, title);
    for (const std::string& word : column.words) require_plain(path, word);
    require(size(column) == rows, path, ": column ", column.name, " has ", size(column),
            " rows, the first has ", rows);
    out += (out.empty() ? "" : ",") + title;
  }
  out += '\n';
  for (Eigen::Index row = 0; row < rows; ++row)
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].words.empty())
        print(out, columns[i].values[row]);
      else
        out += columns[i].words[static_cast<std::size_t>(row)];
      out += i + 1 < columns.size() ? ',' : '\n';
    }
  write_file(path, out);
}

}  // namespace elastogear::io
