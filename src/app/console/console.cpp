#include "app/console/console.h"

#include <mpi.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

#include "app/console/embedding.h"
#include "app/console/progress_line.h"
#include "elastogear/base/text.h"

namespace elastogear::app {
namespace {

using Clock = std::chrono::steady_clock;

int world_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

// A line of progress stands on the terminal, without an end.
std::atomic<bool> line_is_open = false;

bool is_silent = false, shows_details = false;

// Clears a line of progress that is still open, so that the next text begins a line.
void clear_line() {
  if (line_is_open.exchange(false)) std::fputs("\r\033[K", stderr);
}

// Shows the stage that reported last. A thread of its own speaks while the work is silent.
class ProgressConsole {
 public:
  explicit ProgressConsole(std::function<std::string()> detail)
      : detail_(std::move(detail)), ticker_([this](const std::stop_token& stop) { tick(stop); }) {}

  ~ProgressConsole() {
    ticker_.request_stop();
    ticker_.join();
    clear_line();
  }

  void report(std::string_view name, double fraction) {
    const std::lock_guard lock(mutex_);
    const bool first = name != stage_.name || (stage_.fraction >= 1 && fraction < 1);
    if (!first && stage_.fraction >= 1) return;
    if (first) {
      stage_ = {std::string(name), fraction, fraction >= 1 ? 0 : fraction, 0, ""};
      start_ = Clock::now();
    }
    stage_.fraction = fraction;
    if (!is_due(first, true)) return;
    stage_.detail = detail_ ? detail_() : "";
    show();
  }

 private:
  static constexpr int kColumns = 80;

  bool is_due(bool first, bool news) const {
    return line_is_due(stage_, {terminal_, seconds_since(line_)}, first, news);
  }

  static int columns(bool terminal) {
    winsize size{};
    const bool known = terminal && ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col - 1 : kColumns;
  }

  void show() {
    stage_.elapsed = seconds_since(start_);
    line_is_open = terminal_ && stage_.fraction < 1;
    std::fprintf(stderr, "%s%s%s", terminal_ ? "\r\033[K" : "",
                 progress_line(stage_, columns(terminal_)).c_str(), line_is_open ? "" : "\n");
    line_ = Clock::now();
  }

  void tick(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, stop, std::chrono::seconds(1), [&] { return stop.stop_requested(); }))
      if (!stage_.name.empty() && is_due(false, false)) show();
  }

  std::function<std::string()> detail_;
  bool terminal_ = isatty(STDERR_FILENO);
  StageProgress stage_;
  Clock::time_point start_ = Clock::now(), line_ = start_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread ticker_;  // last: it uses all above
};

}  // namespace

Progress console_progress(std::function<std::string()> detail) {
  if (const Embedding* in = embedding())
    return [in](std::string_view name, double fraction) { in->progress(name, fraction); };
  if (world_rank() > 0) return {};
  auto console = std::make_shared<ProgressConsole>(std::move(detail));
  return [console](std::string_view name, double fraction) { console->report(name, fraction); };
}

void print_item(const std::string& name, const std::string& text) {
  if (is_silent) return;
  if (const Embedding* in = embedding()) return in->item(name, text);
  if (world_rank() > 0) return;
  clear_line();
  std::printf("  %-30s %s\n", printable(name).c_str(), printable(text).c_str());
  std::fflush(stdout);  // a killed run has said it
}

void print_detail(const std::string& name, const std::string& text) {
  if (is_verbose()) print_item(name, text);
}

void set_verbose(bool verbose) { shows_details = verbose; }
bool is_verbose() { return shows_details || embedding(); }

Silence::Silence(bool silent) : before_(is_silent) { is_silent = is_silent || silent; }
bool is_silenced() { return is_silent; }

Silence::~Silence() { is_silent = before_; }

std::string with_unit(double value, const std::string& unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.6g %s", value, unit.c_str());
  return text;
}

std::string short_number(double value) {
  char text[64];
  std::snprintf(text, sizeof text, std::abs(value) < 999.5 ? "%.3g" : "%.0f", value);
  return text;
}

std::string rounded_to(double error, double value) {
  constexpr int kMost = 9;  // decimals
  char text[64];
  std::snprintf(text, sizeof text, "%.*f",
                std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, kMost), value);
  return text;
}

std::string with_error(double value, double error, const std::string& unit) {
  constexpr double kFixed = 1e-6;  // below which errors are written with an exponent
  if (!(error > 0)) return with_unit(value, unit);
  if (error >= kFixed) return rounded_to(error, value) + " +- " + rounded_to(error, error) + " " + unit;
  char text[96];
  std::snprintf(text, sizeof text, "%.4g +- %.2g ", value, error);
  return text + unit;
}

std::string percent(double share) {
  char text[32];
  constexpr double kTwoDigits = 0.0995;  // from which on whole percents have two digits or more
  std::snprintf(text, sizeof text, std::abs(share) < kTwoDigits ? "%.2g %%" : "%.0f %%", 100 * share);
  return text;
}

std::string in_mm(double length) { return with_unit(1e3 * length, "mm"); }

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
