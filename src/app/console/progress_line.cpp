#include "app/console/progress_line.h"

#include <algorithm>
#include <cstdio>

#include "app/console/console.h"

namespace elastogear::app {
namespace {

std::string time_text(const StageProgress& stage) {
  if (stage.fraction >= 1) return duration(stage.elapsed);
  const double done = stage.fraction - stage.first;
  if (done > 0) return "remaining " + duration(stage.elapsed * (1 - stage.fraction) / done);
  constexpr double kNoticed = 0.01;  // s
  if (stage.elapsed < kNoticed) return stage.first > 0 ? "continued" : "begun";
  return (stage.first > 0 ? "continued, " : "") + duration(stage.elapsed) + " so far";
}

}  // namespace

std::string progress_line(const StageProgress& stage, int width) {
  char head[128];
  std::snprintf(head, sizeof head, "%-20.40s %3.0f %%  ", stage.name.c_str(), 100 * stage.fraction);
  std::string line = head + time_text(stage) + stage.detail;
  const auto columns = static_cast<std::size_t>(std::max(width, 1));
  while (line.size() > columns) {
    const auto comma = line.rfind(", ");
    line.resize(comma == std::string::npos || comma == 0 ? columns : comma);
  }
  return line;
}

bool line_is_due(const StageProgress& stage, const ProgressScreen& screen, bool first_report, bool news) {
  constexpr double kOften = 0.2, kSometimes = 10, kSilence = 20;  // s
  if (news && stage.fraction >= 1) return true;
  if (stage.fraction >= 1) return false;  // nothing is known to be under way
  if (screen.terminal) return screen.since_line > (news ? kOften : 1);
  if (first_report && stage.fraction > 0) return true;
  return screen.since_line > (news ? kSometimes : kSilence);
}

}  // namespace elastogear::app
