#include "app/run/run_on_mesh.h"

#include <filesystem>
#include <functional>
#include <sstream>

#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/evaluate/cases.h"
#include "app/evaluate/evaluate_options.h"
#include "app/options/verbs.h"
#include "app/setup/drive_input.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/text.h"
#include "elastogear/io/describe.h"
#include "elastogear/io/result_file.h"
#include "elastogear/recovery/body_of_run.h"

namespace elastogear::app {
namespace {

namespace fs = std::filesystem;

// Why something has to be made; empty: it is there, of this input.
std::string why(const std::function<void()>& require_it) {
  try {
    require_it();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

// A body without modes is no body for motions.
void require_modes(const std::string& file, const Options& of_reduce) {
  const auto provenance = io::read_provenance(file);
  const auto modes = provenance.find("option_modes");
  require(modes == provenance.end() || modes->second != "0" || of_reduce.text("modes") == "0", file,
          ": has no modes");
}

void require_all_bodies(const Options& options, const Drive& drive) {
  const Silence silence;
  for (const DriveMember& member : drive.members) {
    const std::string file = body_file(options, member);
    require(fs::is_regular_file(file), file, ": is not there");
    require_modes(file, options);
  }
  require_bodies(options, drive, CommandLines::present);
}

Options evaluate_with_files(const RunOnMesh& of) {
  return with_evaluation(with_gears(of.evaluate), of.folder);
}

// The result of this input, on which no command line has left a mark that this one does not leave.
std::vector<Case> require_cases(const RunOnMesh& of) {
  const std::string result = evaluate_with_files(of).text("result");
  const Options of_simulate = with_gears(of.simulate);
  require(fs::exists(result), result, ": is not there");
  std::vector<Case> cases = read_cases(result);
  for (const Case& one : cases) {
    require(io::is_complete(one.file), one.file, ": is not complete");
    require(io::read_run_input(one.file).has_value(), one.file, ": does not say what its run was asked for");
    require_input(of_simulate, one.file, CommandLines::present);
  }
  return cases;
}

// The same, with the bodies as they are.
void require_results(const RunOnMesh& of) {
  for (const Case& one : require_cases(of))
    for (const recovery::BodyOfRun& body : recovery::read_bodies_of_run(one.file))
      recovery::read_elastic_body(body);  // throws for another one
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

std::string text_of(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::string in_folder(const std::string& folder, const std::string& file) {
  return (fs::path(folder) / fs::path(file).filename()).string();
}

}  // namespace

RunOnMesh run_options(const Options& given) {
  RunOnMesh of{given.of_verb("reduce", reduce_verb().table), given.of_verb("simulate", simulate_verb().table),
               given.of_verb("evaluate", evaluate_verb().table)};
  of.simulate.set_default("analysis", "sweep");
  of.simulate.set_default("resume", "replace");
  return of;
}

RunOnMesh on_mesh(RunOnMesh of, const Drive& drive, double refinement, const std::string& folder) {
  of.folder = folder;
  for (Options* options : {&of.reduce, &of.simulate, &of.evaluate}) {
    options->set("refinement", text_of(refinement));
    for (const char* mesh : {"size", "element_order"}) options->set(mesh, options->text(mesh));
    if (folder.empty()) continue;
    for (const DriveMember& member : drive.members)
      options->set(member.name + "_file", in_folder(folder, body_file(of.reduce, member)));
  }
  if (!folder.empty()) of.simulate.set("output", in_folder(folder, drive_stem(of.simulate) + "_result.h5"));
  return of;
}

bool has_bodies(const RunOnMesh& of, const Drive& drive) {
  return why_on_rank_0([&] { require_all_bodies(of.reduce, drive); }).empty();
}

bool has_evaluation(const RunOnMesh& of) {
  return why_on_rank_0([&] {
           const Silence silence;
           const Options options = evaluate_with_files(of);
           const std::string file = options.text("output");
           require(fs::exists(file), file, ": is not there");
           require_cases(of);
           require_input(options, file, CommandLines::present);
         })
      .empty();
}

std::string evaluation_file(const RunOnMesh& of) { return evaluate_with_files(of).text("output"); }

std::string result_file(const RunOnMesh& of) { return evaluate_with_files(of).text("result"); }

void require_places(const RunOnMesh& of, const Drive& drive) {
  const std::string evaluation = evaluation_file(of), result = result_file(of);
  std::vector<std::string> files = {evaluation, fs::path(evaluation).replace_extension(".json").string()};
  if (fs::path(result).extension() == ".h5") files.push_back(result);  // else it is a folder of cases
  for (const std::string& file : files) place_of_output(file);
  std::vector<Outputs> outputs = {{"output", files}};
  for (const DriveMember& member : drive.members)
    outputs.push_back({member.name + "_file", {body_file(of.reduce, member)}});
  require_different(of.reduce, outputs);
}

void make(const RunOnMesh& of, const Drive& drive, const std::vector<std::string>& coarser) {
  if (!of.folder.empty()) collectively(PETSC_COMM_WORLD, [&] { fs::create_directories(of.folder); });
  if (const std::string cause = why_on_rank_0([&] { require_all_bodies(of.reduce, drive); });
      !cause.empty()) {
    print_item("reduce", cause);
    reduce_verb().run(of.reduce, {});
  } else {
    print_item("reduce", "the bodies are there");
  }
  const auto require_them = [&] { require_results(of); };
  if (const std::string cause = why_on_rank_0(require_them); !cause.empty()) {
    print_item("simulate", cause);
    simulate_verb().run(of.simulate, {});
  } else {
    print_item("simulate", "the result is there");
  }
  collectively(PETSC_COMM_WORLD, [&] {
    int rank = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank != 0) return;
    const Silence silence(!of.folder.empty());
    Options options = evaluate_with_files(of);
    if (!coarser.empty()) options.set("coarser", join(coarser, ","));
    evaluate_verb().run(options, {});
  });
}

void move_files(const RunOnMesh& from, const RunOnMesh& to, const Drive& drive) {
  fs::create_directories(to.folder);
  for (const DriveMember& member : drive.members)
    put_in_place(body_file(from.reduce, member), body_file(to.reduce, member));
  const Options of = evaluate_with_files(from);
  for (const std::string& file : {of.text("result"), of.text("output")})
    put_in_place(file, in_folder(to.folder, file));
}

}  // namespace elastogear::app
