// elastogear VERB [FILE ...] [-option value ...]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "app/console/blas_kernels.h"
#include "app/console/console.h"
#include "app/console/environment.h"
#include "app/console/lone_process.h"
#include "app/options/command_line.h"
#include "app/options/help_topics.h"
#include "app/options/petsc_names.h"
#include "app/verbs/registry.h"
#include "app/way_out.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/base/text.h"
#include "elastogear/base/version.h"

namespace elastogear::app {
namespace {

void print_usage(const std::vector<Verb>& verbs) {
  std::printf("elastogear %s (%s): stresses in gears by elastic multibody models\n\nusage:\n", version(),
              git_hash());
  for (const Verb& verb : verbs)
    std::printf("  elastogear %-52s %s\n", verb.usage.c_str(), verb.summary.c_str());
  std::printf(
      "\n'elastogear VERB -help' lists the options of first need with unit and default, '-help all' all of "
      "them,\n"
      "'-help WORD' those about a word. Options stand in YAML files (nested keys are joined by '_') and on "
      "the\n"
      "command line, which wins.\n");
}

int print_help(const Verb& verb, const std::string& about) {
  const std::string options = help_by_topic(verb.table, about);
  if (options.empty() && !about.empty()) {
    std::fprintf(stderr, "elastogear: error: %s has no option about '%s'; '%s -help all' lists all\n",
                 verb.name.c_str(), printable(about).c_str(), verb.name.c_str());
    return 1;
  }
  std::printf(
      "elastogear %s\n  %s\n\nOptions, on the command line or as keys of a YAML file, in SI units:\n\n%s",
      verb.usage.c_str(), verb.summary.c_str(), options.c_str());
  std::printf("PETSc's and SLEPc's options work beside these: %s-log_view.\n", verb.solvers);
  return 0;
}

void run(const Verb& verb, const std::vector<Verb>& verbs, const CommandLine& line, int argc, char** argv) {
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  require(verb.parallel || size == 1, "runs on one rank, not on ", size, ": call it without mpirun");
  if (size > 1) use_one_blas_thread();  // ranks share the cores of their machine
  OptionSources sources{.argc = argc, .argv = argv};
  if (verb.configured) sources.files = line.arguments;
  const Options options = load_options(verb, verbs, sources);
  set_verbose(options.flag("verbose"));
  verb.run(options, line.arguments);
}

// The words that PETSc is started with, or a complaint about the command line. With a complaint it is started
// without any, to report it once on all ranks.
struct PetscWords {
  std::vector<std::string> words;
  std::string problem = {};
};

PetscWords petsc_words(int argc, char** argv) {
  try {
    return {words_of_petsc(argv[0], given_options(argc, argv))};
  } catch (const std::exception& error) {
    return {{argv[0]}, failure_text(error)};
  }
}

// Runs the verb; returns what went wrong, or nothing.
std::string failure_of(const std::vector<Verb>& verbs, const CommandLine& line, const std::string& problem,
                       int argc, char** argv) {
  try {
    require(problem.empty(), problem);
    collectively(PETSC_COMM_WORLD, take_blas_memory);
    run(find_verb(verbs, line.verb), verbs, line, argc, argv);
    return "";
  } catch (const std::exception& error) {
    return failure_text(error);
  }
}

int main_in_session(const std::vector<Verb>& verbs, const CommandLine& line, const std::string& problem,
                    int argc, char** argv) {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  CommonEnd end;
  const std::string failure = failure_of(verbs, line, problem, argc, argv);
  if (rank == 0 && failure.empty())
    for (const std::string& name : unused_petsc_options())
      std::fprintf(stderr, "warning: nothing used the option -%s\n", name.c_str());
  if (rank == 0 && !failure.empty())
    std::fprintf(stderr, "elastogear %s: error: %s\n", printable(line.verb).c_str(),
                 printable(failure).c_str());
  end.wait(failure, rank == 0);
  return failure.empty() ? 0 : 1;
}

int main_with_solvers(const std::vector<Verb>& verbs, const CommandLine& line, int argc, char** argv) {
  PetscWords petsc = petsc_words(argc, argv);
  std::vector<char*> words;
  for (std::string& word : petsc.words) words.push_back(word.data());
  int n_words = static_cast<int>(words.size());
  words.push_back(nullptr);
  char** first_word = words.data();
  try {
    Session session(n_words, first_word);
    return main_in_session(verbs, line, petsc.problem, argc, argv);
  } catch (const std::exception& error) {  // on some ranks only, perhaps
    std::fprintf(stderr, "elastogear: error: %s\n", printable(failure_text(error)).c_str());
    MPI_Abort(MPI_COMM_WORLD, 1);
    return 1;
  }
}

}  // namespace
}  // namespace elastogear::app

int main(int argc, char** argv) {
  using namespace elastogear;
  const std::vector<app::Verb> verbs = app::all_verbs();
  const app::CommandLine line = app::parse_command_line(argc, argv);
  app::report_closed_pipes(line.verb);
  if (line.version) return std::printf("elastogear %s (%s)\n", version(), git_hash()), 0;
  if (line.verb.empty()) {
    app::print_usage(verbs);
    if (argc > 1 && !line.help)
      std::fprintf(stderr,
                   "\nelastogear: error: '%s' stands where the verb, or a drive file, must come first\n",
                   printable(argv[1]).c_str());
    return line.help ? 0 : 1;
  }
  if (line.help) {
    for (const app::Verb& verb : verbs)
      if (verb.name == line.verb) return app::print_help(verb, line.help_about);
    return app::print_usage(verbs), 1;
  }
  app::start_with_settings(line.verb, argv);
  const bool alone = app::start_alone();
  const int code = app::checked_output(app::main_with_solvers(verbs, line, argc, argv), line.verb);
  if (alone) std::_Exit(code);
  return code;
}
