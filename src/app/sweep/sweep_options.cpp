#include "app/sweep/sweep_options.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "app/gear/drive_options.h"
#include "app/options/rows.h"
#include "elastogear/base/error.h"
#include "elastogear/base/number.h"

namespace elastogear::app {
namespace {

using std::numbers::pi;

constexpr double kFadingSpeed = 1e-3;  // of the pitch-line speed, where none is given
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

double angular_pitch(const Drive& drive) { return 2 * pi / drive.members.front().toothing.z; }

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

// m/s, of friction, in a motion of one pitch a second.
double fading_speed(const Options& options, const Drive& drive, double given) {
  if (given <= 0) return kFadingSpeed * angular_pitch(drive) * drive.members.front().toothing.r;
  const double speed = std::abs(options.number("speed"));
  return speed > 0 ? given * angular_pitch(drive) / speed : given;
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

dynamics::SlowMotion slow_motion(const Options& options, const Drive& drive, const SystemSetup& setup) {
  dynamics::SlowMotion motion{setup.bodies, setup.pairs, setup.environment, setup.markers};
  const std::vector<DriveMember>& members = drive.members;
  const auto rate = [&](const std::string& name) {
    const auto member =
        std::find_if(members.begin(), members.end(), [&](const DriveMember& m) { return m.name == name; });
    return member == members.end() ? 0 : angular_pitch(drive) * member->ratio;
  };
  for (const dynamics::BodySetup& body : motion.bodies) motion.rate.push_back(rate(body.name));
  const std::vector<std::string> led = bearing_names(options, members.back());
  for (const dynamics::BushingSetup& bushing : motion.markers.bushings) {
    const bool turns = std::find(led.begin(), led.end(), bushing.name) != led.end();
    motion.bushing_rate.push_back(turns ? rate(members.back().name) : 0);
  }
  for (dynamics::PairSetup& pair : motion.pairs)
    if (contact::FrictionSettings& friction = pair.settings.friction; friction.mu > 0)
      friction.v_0 = fading_speed(options, drive, friction.v_0);
  return motion;
}

}  // namespace elastogear::app
