#include "app/sweep/sweep_options.h"

#include <cmath>
#include <numeric>

#include "app/gear/drive_options.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"
#include "elastogear/base/number.h"

namespace elastogear::app {
namespace {

constexpr int kMostPositions = 10000000;
constexpr const char* kHunting = "hunting";

struct SweepChoices {
  int positions = 32;
  std::string pitches = "1";
};

const Rows<SweepChoices> kSweepRows = {
    {"sweep_positions", &SweepChoices::positions, "-",
     "sweep: number of roll angles, evenly spaced from that of roll on; the end is left out", kPositive},
    {"sweep_pitches", &SweepChoices::pitches, "-",
     "sweep: pitches of the first gear that the positions are spread over, or hunting: until the same teeth "
     "meet again"},
};

// Pitches until all gears stand as they did.
double hunting_cycle(const Drive& drive) {
  long long pitches = 1;
  for (const DriveMember& member : drive.members)
    pitches = std::lcm(pitches, static_cast<long long>(member.toothing.z));
  return static_cast<double>(pitches);
}

double pitches_of(const Options& options, const Drive& drive, const std::string& text) {
  if (text == kHunting) return hunting_cycle(drive);
  const std::optional<double> pitches = parse<double>(text);
  require(pitches && std::isfinite(*pitches) && *pitches > 0, options.label("sweep_pitches"), " = '", text,
          "': must be a number of pitches above 0, or ", kHunting);
  return *pitches;
}

}  // namespace

OptionTable sweep_table() { return table_of(kSweepRows); }

std::vector<double> sweep_positions(const Options& options, const Drive& drive) {
  SweepChoices choices;
  read_rows(options, kSweepRows, choices);
  require(choices.positions <= kMostPositions, options.label("sweep_positions"), " = ", choices.positions,
          ": must be at most ", kMostPositions);
  const double first = options.number("roll"), pitches = pitches_of(options, drive, choices.pitches);
  std::vector<double> positions;
  for (int i = 0; i < choices.positions; ++i) positions.push_back(first + i * pitches / choices.positions);
  return positions;
}

}  // namespace elastogear::app
