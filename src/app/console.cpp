#include "app/console.h"

#include <mpi.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

namespace elastogear::app {
namespace {

using Clock = std::chrono::steady_clock;

int world_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

struct Stage {
  std::string name;
  Clock::time_point start, shown;
  double shown_fraction = 0;
};

double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

void show(const Stage& stage, double fraction, bool terminal, const std::string& detail) {
  const double elapsed = seconds_since(stage.start);
  const bool done = fraction >= 1;
  const std::string time = done ? duration(elapsed) : "remaining " + duration(elapsed * (1 / fraction - 1));
  std::fprintf(stderr, "%s%-28s %3.0f %%  %s%s%s", terminal ? "\r\033[K" : "", stage.name.c_str(),
               100 * fraction, time.c_str(), detail.c_str(), terminal && !done ? "" : "\n");
}

// Is a line due? Then the stage counts as shown.
bool is_due(Stage& stage, std::string_view name, double fraction, bool terminal) {
  if (name != stage.name) stage = {std::string(name), Clock::now(), Clock::now(), 0};
  const bool due = terminal ? seconds_since(stage.shown) > 0.2
                            : seconds_since(stage.shown) > 2 && fraction - stage.shown_fraction > 0.09;
  const bool done = fraction >= 1 && stage.shown_fraction < 1;
  if (fraction <= 0 || (!due && !done)) return false;
  stage.shown = Clock::now();
  stage.shown_fraction = fraction;
  return true;
}

}  // namespace

Progress console_progress(std::function<std::string()> detail) {
  if (world_rank() > 0) return {};
  const bool terminal = isatty(STDERR_FILENO);
  auto stage = std::make_shared<Stage>();
  return [=](std::string_view name, double fraction) {
    if (is_due(*stage, name, fraction, terminal)) show(*stage, fraction, terminal, detail ? detail() : "");
  };
}

void print_item(const std::string& name, const std::string& text) {
  if (world_rank() > 0) return;
  std::printf("  %-30s %s\n", name.c_str(), text.c_str());
  std::fflush(stdout);  // a killed run has said it
}

std::string with_unit(double value, const std::string& unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.6g %s", value, unit.c_str());
  return text;
}

std::string duration(double seconds) {
  char text[64];
  if (seconds < 90)
    std::snprintf(text, sizeof text, "%.3g s", seconds);
  else
    std::snprintf(text, sizeof text, "%.0f min %02.0f s", std::floor(seconds / 60), std::fmod(seconds, 60));
  return text;
}

std::string largest_memory() {
  constexpr double kKibibytePerMegabyte = 1024 * 1e-6;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return with_unit(std::round(kKibibytePerMegabyte * static_cast<double>(usage.ru_maxrss)), "MB");
}

}  // namespace elastogear::app
