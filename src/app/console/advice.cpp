#include "app/console/advice.h"

#include <cmath>
#include <memory>
#include <utility>

#include "app/console/console.h"
#include "elastogear/dynamics/advice.h"

namespace elastogear::app {
namespace {

constexpr double kTooLongStep = 10, kTooShortStep = 0.01;  // dt over the step asked for
constexpr int kPaceSteps = 500;                            // over which the pace of a run is taken
constexpr double kManySteps = 10000;                       // left to the end

// How far a run comes in a number of steps; the first ones, which grow from a small one, do not count.
struct Pace {
  int step = -1;    // at which it is looked at next; negative: it has not been looked at
  double time = 0;  // s, at the last look
  bool said = false;
};

void print(const char* name, const char* whose, const dynamics::Vibration& vibration) {
  if (vibration.frequency > 0)
    print_item(name, with_unit(vibration.frequency, "Hz") + " (" + whose + " " + vibration.name +
                         ") asks for a step of " + with_unit(vibration.step(), "s"));
}

// Rigid bodies have no give: only the impulse of a blow is determinate, not its force.
void warn_of_rigid_blows(const dynamics::System& system) {
  const auto is_rigid = [&](int b) { return system.bodies()[static_cast<std::size_t>(b)].eq.n_q() == 0; };
  for (const dynamics::PairSetup& pair : system.pairs())
    if (pair.settings.law == contact::ContactLaw::augmented && is_rigid(pair.body[0]) &&
        is_rigid(pair.body[1]))
      print_item("warning", "contact " + pair.name +
                                ": rigid bodies without a penalty stop each other within one time step; the "
                                "force of such a blow is its impulse over the step, and not to be trusted");
}

void watch_pace(const dynamics::StepInfo& now, double end_time, Pace& pace) {
  const bool begins = pace.step < 0 || now.step < kPaceSteps;
  if (pace.said || (!begins && now.step < pace.step)) return;
  const double dt = (now.time - pace.time) / kPaceSteps, left = (end_time - now.time) / dt;
  pace.step = now.step + kPaceSteps;
  pace.time = now.time;
  if (begins || left <= kManySteps) return;
  pace.said = true;
  print_item("warning", "steps are " + with_unit(dt, "s") + " in the mean at t = " +
                            with_unit(now.time, "s") + ", so that " + with_unit(std::round(left), "more") +
                            " lead to the end: they follow a vibration. Where that is of no interest, give "
                            "bodies damping (-<body>_damping_alpha, or reduce -damping_ratio) or "
                            "-step_tolerance (m) some times its amplitude");
}

}  // namespace

void print_advice(const dynamics::System& system, double dt) {
  const dynamics::Advice advice = dynamics::advise(system);
  print("highest mode", "body", advice.mode);
  print("contact vibration", "pair", advice.contact);
  print_item("time step", dt > 0 ? with_unit(dt, "s") : "chosen by its error");
  const double share = dt / advice.step();
  if (share > kTooLongStep)
    print_item("warning", "the step is " + with_unit(share, "times") +
                              " what the fastest vibration asks for: it will not be resolved; take -ts_dt " +
                              short_number(advice.step()));
  if (share > 0 && share < kTooShortStep)
    print_item("warning", "the step is " + with_unit(share, "times") +
                              " what the fastest vibration asks for: a longer one would do; take -ts_dt " +
                              short_number(advice.step()));
  warn_of_rigid_blows(system);
}

dynamics::Observer guarded(const dynamics::System& system, dynamics::Observer observer, double dt) {
  auto guard = std::make_shared<dynamics::ValidityGuard>(system, dt);
  auto chatter = std::make_shared<dynamics::ChatterWatch>(system);
  return [guard, chatter, observer = std::move(observer)](const model::Snapshot& snapshot) {
    for (const std::string& warning : guard->warnings(snapshot)) print_item("warning", warning);
    for (const std::string& warning : chatter->warnings(snapshot)) print_item("warning", warning);
    observer(snapshot);
  };
}

std::function<void(const dynamics::StepInfo&)> paced(const dynamics::TimeSettings& settings,
                                                     std::function<void(const dynamics::StepInfo&)> monitor) {
  if (settings.dt > 0) return monitor;
  return [monitor = std::move(monitor), end_time = settings.end_time,
          pace = Pace{}](const dynamics::StepInfo& now) mutable {
    watch_pace(now, end_time, pace);
    monitor(now);
  };
}

}  // namespace elastogear::app
