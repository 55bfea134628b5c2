#include "app/way_out.h"

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <thread>

#include "elastogear/base/text.h"

namespace elastogear::app {
namespace {

constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::milliseconds kLookEvery{5};

char closed_pipe[256];  // what the handler writes
std::size_t closed_pipe_length = 0;

void end_of_pipe(int signal) {
  std::signal(signal, SIG_DFL);
  [[maybe_unused]] const auto written = write(STDERR_FILENO, closed_pipe, closed_pipe_length);
  raise(signal);
}

}  // namespace

void report_closed_pipes(const std::string& verb) {
  const int length =
      std::snprintf(closed_pipe, sizeof closed_pipe,
                    "elastogear %.100s: error: what reads the output has gone\n", printable(verb).c_str());
  closed_pipe_length = static_cast<std::size_t>(length);
  std::signal(SIGPIPE, end_of_pipe);
}

CommonEnd::CommonEnd() {
  MPI_Comm_dup(MPI_COMM_WORLD, &comm_);
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
}

void CommonEnd::wait(const std::string& failure, bool said) {
  MPI_Request request = MPI_REQUEST_NULL;
  int all = 0;
  MPI_Ibarrier(comm_, &request);
  const auto begin = std::chrono::steady_clock::now();
  while (MPI_Test(&request, &all, MPI_STATUS_IGNORE), !all) {
    const bool patient = failure.empty() || std::chrono::steady_clock::now() - begin < kPatience;
    if (patient) {
      std::this_thread::sleep_for(kLookEvery);
      continue;
    }
    std::fprintf(stderr, "elastogear: error: rank %d of %d fails alone%s%s\n", rank_, size_, said ? "" : ": ",
                 said ? "" : printable(failure).c_str());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Comm_free(&comm_);
}

int checked_output(int code, const std::string& verb) {
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
  std::fprintf(stderr, "elastogear %s: error: standard output: %s\n", printable(verb).c_str(),
               std::strerror(errno));
  return 1;
}

}  // namespace elastogear::app
