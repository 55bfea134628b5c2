#include "elastogear/io/csv.h"

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"

namespace elastogear::io {
void write_csv(const std::string& path, const std::vector<CsvColumn>& columns) {
  const Eigen::Index rows = columns.empty() ? 0 : columns[0].values.size();
  std::string out;
  for (const CsvColumn& column : columns) {
    const std::string title = column.name + " [" + column.unit + "]";
    require(title.find_first_of(",\"\r\n") == std::string::npos, path, ": column name '", title,
            "' holds a comma, quote or line end");
    require(column.values.size() == rows, path, ": column ", column.name, " has ", column.values.size(),
            " rows, the first has ", rows);
    out += (out.empty() ? "" : ",") + title;
  }
  out += '\n';
  for (Eigen::Index row = 0; row < rows; ++row)
    for (std::size_t i = 0; i < columns.size(); ++i) {
      print(out, columns[i].values[row]);
      out += i + 1 < columns.size() ? ',' : '\n';
    }
  write_file(path, out);
}

}  // namespace elastogear::io
