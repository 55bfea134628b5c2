#include "app/run/report_page.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <vector>

namespace elastogear::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBesideProgram[] = {"../../../../scripts/report.py",           // in a clone
                                          "../share/elastogear/scripts/report.py"};  // where it is installed

fs::path script_beside(const fs::path& program) {
  for (const char* place : kBesideProgram)
    if (const fs::path script = program.parent_path() / place; fs::is_regular_file(script))
      return script.lexically_normal();
  return {};
}

// The environment but for what Open MPI tells the processes that it has started.
std::vector<char*> environment_of_one_process() {
  std::vector<char*> kept;
  for (char** variable = environ; *variable; ++variable)
    if (std::strncmp(*variable, "OMPI_COMM_", 10) != 0 && std::strncmp(*variable, "OMPI_UNIVERSE", 13) != 0 &&
        std::strncmp(*variable, "OMPI_MCA_ess", 12) != 0 &&
        std::strncmp(*variable, "OMPI_MCA_orte", 13) != 0 && std::strncmp(*variable, "PMIX_", 5) != 0)
      kept.push_back(*variable);
  kept.push_back(nullptr);
  return kept;
}

// Runs a program to its end; returns its exit code, -1 where it could not be started.
int run_to_end(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  std::vector<char*> environment = environment_of_one_process();
  pid_t process = 0;
  int status = 0;
  if (posix_spawn(&process, arguments[0], nullptr, nullptr, arguments.data(), environment.data()) != 0)
    return -1;
  while (waitpid(process, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

std::string make_page(const PageInputs& of, const std::string& page) {
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown), script = script_beside(program);
  if (script.empty()) return "scripts/report.py is not beside " + program.string();
  std::vector<std::string> words = {script.string(), of.drive,         "--result", of.result,
                                    "--evaluation",  of.evaluation,    "--out",    page,
                                    "--elastogear",  program.string(), "--keep"};
  if (!of.picture) words.emplace_back("--no-picture");
  const int code = run_to_end(words);
  if (code == 0) return "";
  return code < 0 ? script.string() + " could not be run"
                  : script.string() + " has failed, as it says above; " + script.string() + " " + of.drive +
                        " makes the page";
}

}  // namespace elastogear::app
