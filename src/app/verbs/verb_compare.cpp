// elastogear compare: how far a stress or result file is from a reference.

#include <optional>

#include "app/compare/compare_options.h"
#include "app/compare/compare_result.h"
#include "app/compare/compare_stress.h"
#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/options/verbs.h"
#include "elastogear/base/error.h"
#include "elastogear/io/describe.h"

namespace elastogear::app {
namespace {

// "stress_1.csv", "stress_2.csv", ... of n tables; none where no output is asked for.
std::vector<std::string> table_paths(const std::string& output, std::size_t n) {
  std::vector<std::string> paths;
  for (std::size_t i = 0; !output.empty() && i < n; ++i)
    paths.push_back(output + "_" + std::to_string(i + 1) + ".csv");
  return paths;
}

void run_compare(const Options& options, const std::vector<std::string>& files) {
  require(files.size() == 2, "compares two files, not ", files.size(),
          ": elastogear compare FILE.h5 REFERENCE.h5");
  const std::string format = io::file_format(files[0]), reference = io::file_format(files[1]);
  require(format == reference, files[0], " holds an ", format, ", ", files[1], " an ", reference,
          ": both must be result files, or both stress files");
  const bool stresses = format == "elastogear stress";
  require(stresses || format == "elastogear result", files[0], ": holds an ", format,
          "; result and stress files can be compared");
  const std::vector<Table> tables =
      stresses ? compare_stresses(options, files[0], files[1]) : compare_results(options, files[0], files[1]);
  const std::vector<std::string> paths = table_paths(compare_settings(options).output, tables.size());
  protect_inputs(options, {{"output", paths}}, files);
  std::optional<OutputLock> lock;
  if (!paths.empty()) lock.emplace(paths.front());
  for (const Table& table : tables) print(table);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    write_csv(paths[i], tables[i]);
    print_item("written", paths[i]);
  }
}

}  // namespace

Verb compare_verb() {
  return {.name = "compare",
          .usage = "compare FILE.h5 REFERENCE.h5 [-option value ...]",
          .summary = "tables of deviations between two result or stress files",
          .table = compare_table(),
          .run = run_compare,
          .configured = false};
}

}  // namespace elastogear::app
