// elastogear run: drive file -> bodies, a sweep over a pitch and what an engineer reads off, each as far as
// it is not there already.

#include <filesystem>
#include <functional>

#include "app/console/console.h"
#include "app/drive_input.h"
#include "app/evaluate/cases.h"
#include "app/evaluate/evaluate_options.h"
#include "app/gear/drive_options.h"
#include "app/verbs/verbs.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/io/result_file.h"
#include "elastogear/recovery/body_of_run.h"

namespace elastogear::app {
namespace {

// Why something has to be made; empty: it is there, of this input.
std::string why(const std::function<void()>& require_it) {
  try {
    require_it();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

void require_all_bodies(const Options& options, const Drive& drive) {
  const Silence silence;
  for (const DriveMember& member : drive.members) {
    const std::string file = body_file(options, member);
    require(std::filesystem::is_regular_file(file), file, ": is not there");
  }
  require_bodies(options, drive);
}

// The result of this input, with the bodies as they are.
void require_results(const Options& of_evaluate) {
  const std::string result = of_evaluate.text("result");
  require(std::filesystem::exists(result), result, ": is not there");
  for (const Case& of : read_cases(result)) {
    require(io::is_complete(of.file), of.file, ": is not complete");
    require_input(of_evaluate, of.file);
    for (const recovery::BodyOfRun& body : recovery::read_bodies_of_run(of.file))
      recovery::read_elastic_body(body);  // throws for another one
  }
}

// Decided on rank 0 for all.
std::string why_on_rank_0(const std::function<void()>& require_it) {
  int rank = 0, missing = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  std::string cause;
  if (rank == 0) cause = why(require_it), missing = !cause.empty();
  MPI_Bcast(&missing, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  return missing && cause.empty() ? "as rank 0 says" : cause;
}

void run_all(const Options& given, const std::vector<std::string>& arguments) {
  require(is_drive(given), "needs a drive file: elastogear run drive.yaml (docs/drives.md)");
  const Verb reduce = reduce_verb(), simulate = simulate_verb(), evaluate = evaluate_verb();
  const Options of_reduce = given.of_verb("reduce", reduce.table);
  Options of_simulate = given.of_verb("simulate", simulate.table),
          of_evaluate = given.of_verb("evaluate", evaluate.table);
  of_simulate.set_default("analysis", "sweep");
  const Drive drive = read_drive(with_gears(given));
  if (const std::string cause = why_on_rank_0([&] { require_all_bodies(of_reduce, drive); });
      !cause.empty()) {
    print_item("reduce", cause);
    reduce.run(of_reduce, arguments);
  } else {
    print_item("reduce", "the bodies are there");
  }
  const Options with_result = with_evaluation(with_gears(of_evaluate));
  if (const std::string cause = why_on_rank_0([&] { require_results(with_result); }); !cause.empty()) {
    print_item("simulate", cause);
    simulate.run(of_simulate, arguments);
  } else {
    print_item("simulate", "the result is there");
  }
  collectively(PETSC_COMM_WORLD, [&] {
    int rank = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank == 0) evaluate.run(of_evaluate, arguments);
  });
}

}  // namespace

Verb run_verb() {
  return {"run",
          "run drive.yaml [-option value ...]",
          "drive file -> bodies, sweep and evaluation, as far as they are not there; also 'elastogear "
          "drive.yaml'",
          whole_drive_table(),
          run_all,
          true};
}

}  // namespace elastogear::app
