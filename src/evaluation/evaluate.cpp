#include "elastogear/evaluation/evaluate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"
#include "evaluation/losses.h"
#include "evaluation/sections.h"
#include "evaluation/signal.h"

namespace elastogear::evaluation {
namespace {

bool in_time(const PairOfRun& pair) { return pair.time.size() > 0; }

// Speed of the drive's first gear, rad/s, > 0 counter-clockwise: of a run in time its mean one, else 1 where
// none is known.
double speed_of(const PairOfRun& pair) {
  const Eigen::Index last = pair.roll.size() - 1;
  if (in_time(pair) && last > 0)
    return 2 * std::numbers::pi / pair.first_teeth * (pair.roll[last] - pair.roll[0]) /
           (pair.time[last] - pair.time[0]);
  return pair.turning * (pair.speed > 0 ? pair.speed : 1);
}

void add_spectrum(const std::string& path, const std::string& unit, const Spectrum& spectrum, Items& items) {
  items.curve(path + "/order", "1", "orders, per pitch: 1 is the mesh frequency", spectrum.order);
  items.curve(path + "/amplitude", unit, "amplitude of each order", spectrum.amplitude);
  items.curve(path + "/phase", "rad", "phase of each order against a cosine of the roll angle",
              spectrum.phase);
}

void add_error(const PairOfRun& pair, const Transmission& t, const Eigen::VectorXd& error, Items& items) {
  const std::string name = "transmission_error";
  items.number(name + "/radius", "m", "radius at which it is measured, of the second gear", t.radius);
  items.curve(name + "/loaded", "m", "by how much the second gear leads", error);
  items.number(name + "/mean", "m", "its mean", error.mean());
  if (error.size() > 1)
    items.number(name + "/peak_to_peak", "m", "largest less smallest", peak_to_peak(error));
  items.add(spectrum_items(pair, name, error, "m"));
}

void add_stiffness(const std::string& kind, const std::string& what, const Eigen::VectorXd& c, double width,
                   Items& items) {
  if (c.size() == 0 || !c.allFinite()) return;
  // Teeth of steel have 2e10 N/m^2. Rigid gears yield by the contact's penalty alone, which says nothing of
  // them.
  constexpr double kRigid = 2e12;  // N/m^2
  if (c.mean() > kRigid * width) return;
  items.curve("stiffness/" + kind, "N/m", what, c);
  items.number("stiffness/" + kind + "_mean", "N/m", "its mean", c.mean());
  if (c.size() > 1)
    items.number("stiffness/" + kind + "_peak_to_peak", "N/m", "largest less smallest", peak_to_peak(c));
  items.number("stiffness/" + kind + "_per_width", "N/m^2", "its mean over the common face width",
               c.mean() / width);
}

void add_losses(const PairOfRun& pair, const Losses& losses, Items& items) {
  items.curve("torque/first", "N m", "moment of contact on the first gear about its axis", losses.torque_1);
  items.curve("torque/second", "N m", "moment of contact on the second gear about its axis", losses.torque_2);
  items.number("torque/first_mean", "N m", "mean moment of contact on the first gear",
               losses.torque_1.mean());
  items.number("torque/second_mean", "N m", "mean moment of contact on the second gear",
               losses.torque_2.mean());
  const std::string of_speed =
      in_time(pair) || pair.speed > 0 ? "" : ", where the drive's first gear turns at 1 rad/s";
  items.number("losses/speed", "rad/s", "of the drive's first gear, for speeds and powers", losses.omega);
  items.curve("losses/sliding_speed", "m/s", "largest sliding speed" + of_speed, losses.sliding_speed);
  items.number("losses/largest_sliding_speed", "m/s", "its largest value" + of_speed,
               losses.sliding_speed.maxCoeff());
  items.curve("losses/pv", "W/m^2", "largest pressure times sliding speed" + of_speed, losses.pv);
  items.number("losses/largest_pv", "W/m^2", "its largest value" + of_speed, losses.pv.maxCoeff());
  items.curve("losses/friction_power", "W", "taken by friction" + of_speed, losses.friction);
  items.number("losses/mean_friction_power", "W", "its mean" + of_speed, losses.friction.mean());
  if (losses.friction.any())
    items.number("losses/efficiency", "1", "output over input of work", efficiency(losses));
  items.number("losses/friction_loss", "1", "share of the input that friction takes", friction_loss(losses));
  items.number("losses/loss_factor", "1", "loss over input per coefficient of friction", loss_factor(losses));
}

void add_dynamics(const PairOfRun& pair, Items& items) {
  const Eigen::VectorXd force = pair.force.colwise().norm().transpose();
  items.curve("force/value", "N", "size of the contact force", force);
  items.number("force/mean", "N", "its mean", force.mean());
  if (!in_time(pair)) return;
  items.number("force/largest", "N", "its largest value", force.maxCoeff());
  items.number("force/dynamic_factor", "1", "largest over mean contact force", dynamic_factor(force));
  items.add(spectrum_items(pair, "force", force, "N"));
}

void require_run(const PairOfRun& pair) {
  const auto n = static_cast<std::size_t>(pair.roll.size());
  const std::string name = pair.gear[0].name + ":" + pair.gear[1].name;
  require(n > 0, "pair ", name, ": the run holds no times");
  require(pair.contacts.size() == n && pair.gear[0].rotation.size() == n &&
              pair.gear[1].rotation.size() == n && pair.force.cols() == pair.roll.size() &&
              pair.torque.cols() == pair.roll.size(),
          "pair ", name, ": motion, contacts and forces must have ", n, " times each");
}

}  // namespace

Eigen::VectorXd transmission_error(const PairOfRun& pair) {
  Eigen::VectorXd phi[2];
  for (std::size_t g : {0, 1}) {
    const Gear& gear = pair.gear[g];
    phi[g] = in_time(pair) ? continuous_angles(gear, pair.first_teeth, pair.roll[0])
                           : angles(gear, nominal_angles(gear, pair.first_teeth, pair.roll));
    phi[g].array() -= gear.angle;
  }
  return transmission_error(transmission(pair.gear[0], pair.gear[1], pair.sense), phi[0], phi[1]);
}

Eigen::VectorXd roll_of_run(const Gear& first, double roll) {
  return (continuous_angles(first, first.toothing.z, roll).array() - first.angle) / pitch(first);
}

double common_width(const PairOfRun& pair) {
  constexpr double kParallel = 0.99;  // cosine of the angle between axes
  const Gear &a = pair.gear[0], &b = pair.gear[1];
  const double narrower = std::min(a.width, b.width);
  if (std::abs(a.R.col(2).dot(b.R.col(2))) < kParallel) return narrower;
  const double offset = std::abs((b.origin - a.origin).dot(a.R.col(2)));
  return std::min(narrower, (a.width + b.width) / 2 - offset);
}

std::vector<io::EvaluationItem> spectrum_items(const PairOfRun& pair, const std::string& path,
                                               const Eigen::VectorXd& signal, const std::string& unit) {
  Items items;
  if (in_time(pair) && rolls_on(pair.sense * pair.roll))
    add_spectrum(path, unit, windowed_orders(pair.sense * pair.roll, signal), items);
  else if (!in_time(pair) && even_positions(pair.roll))
    add_spectrum(path, unit, fourier_orders(pair.roll, signal), items);
  return items.take();
}

PairEvaluation evaluate(const PairOfRun& pair) {
  require_run(pair);
  const Transmission t = transmission(pair.gear[0], pair.gear[1], pair.sense);
  Losses losses = evaluation::losses(both(pair), pair.contacts, pair.force, pair.torque, speed_of(pair));
  if (pair.friction == 0) losses.friction.setZero();
  PairEvaluation evaluation{{}, transmission_error(pair), losses.torque_2 / t.radius};
  Items items;
  items.curve("roll", "pitches", "roll angle of the drive's first gear", pair.roll);
  items.curve("time", "s", "time", pair.time);
  add_error(pair, t, evaluation.error, items);
  if (pair.unloaded.size() > 0) items.add(unloaded_items(evaluation, pair.unloaded, common_width(pair)));
  add_teeth(pair, items);
  add_line_load(pair, items);
  add_pressure(pair, items);
  add_hertz(pair, items);
  add_losses(pair, losses, items);
  add_dynamics(pair, items);
  if (in_time(pair)) add_pitches(pair, evaluation.error, items);
  add_roots(pair, items);
  evaluation.items = items.take();
  return evaluation;
}

std::vector<io::EvaluationItem> unloaded_items(const PairEvaluation& pair, const Eigen::VectorXd& unloaded,
                                               double width) {
  Items items;
  items.curve("transmission_error/unloaded", "m", "without load", unloaded);
  if (unloaded.size() > 1)
    items.number("transmission_error/unloaded_peak_to_peak", "m", "largest less smallest without load",
                 peak_to_peak(unloaded));
  add_stiffness("secant", "force over the way from the unloaded transmission error",
                stiffness(pair.force, pair.error, unloaded), width, items);
  return items.take();
}

std::vector<io::EvaluationItem> tangent_stiffness(const PairEvaluation& pair, const PairEvaluation& other,
                                                  double width) {
  Items items;
  add_stiffness("tangent", "difference of forces between two loads over that of transmission errors",
                stiffness(pair.force - other.force, pair.error, other.error), width, items);
  return items.take();
}

const std::vector<double>& PairEvaluation::values(const std::string& path) const {
  for (const io::EvaluationItem& item : items)
    if (item.path == path) return item.value;
  fail("the evaluation of a pair has no '", path, "'");
}

}  // namespace elastogear::evaluation
