#pragma once
// The text of a line of progress and the time at which one is due, as functions that know neither clock nor
// terminal.

#include <string>

namespace elastogear::app {

/// A stage of work as it stands.
struct StageProgress {
  std::string name;
  double fraction = 0;  ///< done, 0..1
  double first = 0;     ///< of its first report: what an earlier run had done before it was killed
  double elapsed = 0;   ///< s, since that report
  std::string detail;   ///< behind, its parts apart by ", "
};

/// "eigenmodes             45 %  remaining 12 s, ...", at most `width` columns: parts of the detail that do
/// not fit are left out. The time remaining follows from what this run has done itself.
std::string progress_line(const StageProgress& stage, int width);

/// The output that lines go to, and the time since the last one.
struct ProgressScreen {
  bool terminal = false;
  double since_line = 0;  ///< s
};
/// Is a line due? news: the stage reported; otherwise it works on in silence. Terminals show the last line
/// only; other files get the first line of a stage that goes on where an earlier run was, one every 10 to 30
/// s, and the last.
bool line_is_due(const StageProgress& stage, const ProgressScreen& screen, bool first_report, bool news);

}  // namespace elastogear::app
