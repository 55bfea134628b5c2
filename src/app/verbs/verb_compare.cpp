// elastogear compare: how far a stress or result file is from a reference.

#include "app/compare/compare_moment.h"
#include "app/compare/compare_result.h"
#include "app/compare/compare_stress.h"
#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/verbs/verbs.h"
#include "elastogear/base/error.h"
#include "elastogear/io/describe.h"

namespace elastogear::app {
namespace {

// "stress_1.csv", "stress_2.csv", ...
std::string table_path(const Options& options, std::size_t i) {
  return options.text("output") + "_" + std::to_string(i + 1) + ".csv";
}

void protect_inputs(const Options& options, const std::vector<Table>& tables,
                    const std::vector<std::string>& files) {
  Outputs outputs{"output", {}};
  for (std::size_t i = 0; options.given("output") && i < tables.size(); ++i)
    outputs.files.push_back(table_path(options, i));
  protect_inputs(options, {outputs}, files);
}

void write_tables(const Options& options, const std::vector<Table>& tables) {
  if (!options.given("output")) return;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::string path = table_path(options, i);
    write_csv(path, tables[i]);
    print_item("written", path);
  }
}

void run(const Options& options, const std::vector<std::string>& files) {
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
  protect_inputs(options, tables, files);
  for (const Table& table : tables) print(table);
  write_tables(options, tables);
}

}  // namespace

Verb compare_verb() {
  return {.name = "compare",
          .usage = "compare FILE.h5 REFERENCE.h5 [-option value ...]",
          .summary = "tables of deviations between two result or stress files",
          .table = compare_table(),
          .run = run,
          .configured = false};
}

}  // namespace elastogear::app
