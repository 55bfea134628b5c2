#include "elastogear/dynamics/axis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elastogear/base/error.h"

namespace elastogear::dynamics {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

void require_table(const std::vector<double>& time, const std::vector<double>& value) {
  require(time.size() == value.size(), "a table has ", time.size(), " times and ", value.size(), " values");
  require(time.size() >= 2, "a table has ", time.size(), " rows, must have at least two");
  for (std::size_t i = 0; i < time.size(); ++i)
    require(std::isfinite(time[i]) && std::isfinite(value[i]), "table row ", i + 1, " (", time[i], ", ",
            value[i], ") is not finite");
  for (std::size_t i = 1; i < time.size(); ++i)
    require(time[i] > time[i - 1], "table row ", i + 1, ": time ", time[i], " s does not come after ",
            time[i - 1], " s");
}

// Number of the interval that holds t; the outer ones reach beyond their ends.
std::size_t interval(const std::vector<double>& time, double t) {
  const auto after = std::upper_bound(time.begin() + 1, time.end() - 1, t);
  return static_cast<std::size_t>(after - time.begin()) - 1;
}

// Second derivatives of the natural cubic spline at its nodes: a tridiagonal system.
std::vector<double> spline_curvature(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> curvature(n, 0), upper(n, 0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = x[i] - x[i - 1], right = x[i + 1] - x[i];
    const double bend = 6 * ((y[i + 1] - y[i]) / right - (y[i] - y[i - 1]) / left);
    const double pivot = 2 * (left + right) - left * upper[i - 1];
    upper[i] = right / pivot;
    curvature[i] = (bend - left * curvature[i - 1]) / pivot;
  }
  for (std::size_t i = n - 2; i > 0; --i) curvature[i] -= upper[i] * curvature[i + 1];
  return curvature;
}

Prescribed on_spline(const Drive& d, double t) {
  const std::size_t i = interval(d.time, t);
  const double h = d.time[i + 1] - d.time[i], b = (t - d.time[i]) / h, a = 1 - b;
  const double A = d.curvature[i], B = d.curvature[i + 1], slope = (d.value[i + 1] - d.value[i]) / h;
  return {a * d.value[i] + b * d.value[i + 1] + h * h / 6 * ((a * a * a - a) * A + (b * b * b - b) * B),
          slope + h / 6 * ((3 * b * b - 1) * B - (3 * a * a - 1) * A), a * A + b * B};
}

Prescribed spinning_up(const Drive& d, double t) {
  const double T = d.duration, x = t / T;
  if (x >= 1) return {d.s_0 + d.v * (t - T / 2), d.v, 0};
  const double c = std::cos(kTwoPi * x);
  return {d.s_0 + d.v * T * (x * x / 2 + (c - 1) / (kTwoPi * kTwoPi)),
          d.v * (x - std::sin(kTwoPi * x) / kTwoPi), d.v / T * (1 - c)};
}

void require_span(const std::vector<double>& time, double end_time, const std::string& who) {
  require(time.front() <= 0 && time.back() >= end_time, who, "the table covers ", time.front(), " .. ",
          time.back(), " s, the run needs 0 .. ", end_time, " s");
}

}  // namespace

Signal constant_signal(double value) { return {{0}, {value}}; }

Signal ramp_signal(double value, double duration) {
  require(std::isfinite(duration) && duration > 0, "duration of a ramp ", duration, " s must be positive");
  return {{0, duration}, {0, value}};
}

Signal table_signal(std::vector<double> time, std::vector<double> value) {
  require_table(time, value);
  return {std::move(time), std::move(value), true};
}

double at(const Signal& signal, double t) {
  if (signal.time.empty()) return 0;
  if (t <= signal.time.front()) return signal.value.front();
  if (t >= signal.time.back()) return signal.value.back();
  const std::size_t i = interval(signal.time, t);
  const double b = (t - signal.time[i]) / (signal.time[i + 1] - signal.time[i]);
  return (1 - b) * signal.value[i] + b * signal.value[i + 1];
}

Drive speed_drive(double s_0, double v) {
  require(std::isfinite(s_0) && std::isfinite(v), "prescribed start ", s_0, " and speed ", v,
          " must be finite");
  return {Drive::Type::speed, s_0, v, 0, {}, {}, {}};
}

Drive still_drive(double s_0, double v, double start) {
  return {Drive::Type::still, s_0, v, start, {}, {}, {}};
}

Drive spin_up_drive(double s_0, double v, double duration) {
  require(std::isfinite(s_0) && std::isfinite(v), "prescribed start ", s_0, " and speed ", v,
          " must be finite");
  require(std::isfinite(duration) && duration > 0, "duration of a spin-up ", duration, " s must be positive");
  return {Drive::Type::spin_up, s_0, v, duration, {}, {}, {}};
}

Drive table_drive(std::vector<double> time, std::vector<double> value) {
  require_table(time, value);
  std::vector<double> curvature = spline_curvature(time, value);
  return {Drive::Type::table, 0, 0, 0, std::move(time), std::move(value), std::move(curvature)};
}

Prescribed at(const Drive& drive, double t) {
  switch (drive.type) {
    case Drive::Type::speed:
      return {drive.s_0 + drive.v * t, drive.v, 0};
    case Drive::Type::spin_up:
      return spinning_up(drive, t);
    case Drive::Type::table:
      return on_spline(drive, t);
    case Drive::Type::still:
      return {drive.s_0 + drive.v * std::max(0.0, t - drive.duration), 0, 0};
  }
  fail("unknown type of drive");
}

double resistance(const Axis& axis, double s_dot) {
  double force = axis.damping * s_dot;
  if (axis.friction > 0) force += axis.friction * std::tanh(s_dot / axis.friction_rate);
  return force;
}

double resistance_rate(const Axis& axis, double s_dot) {
  double rate = axis.damping;
  if (axis.friction > 0) {
    const double c = std::cosh(s_dot / axis.friction_rate);
    rate += axis.friction / (axis.friction_rate * c * c);
  }
  return rate;
}

double law_force(const Axis& axis, double t, double s, double s_dot) {
  if (!axis.law) return 0;
  const double force = axis.law(t, s, s_dot);
  require(std::isfinite(force), "a force law gives ", force, " at t = ", t, " s, coordinate ", s,
          " and rate ", s_dot, ": must be finite");
  return force;
}

LawRates law_rates(const Axis& axis, double t, double s, double s_dot) {
  if (!axis.law) return {};
  constexpr double kStep = 1e-6;  // relative, of coordinates and rates above 1
  const double h = kStep * std::max(1.0, std::abs(s)), h_dot = kStep * std::max(1.0, std::abs(s_dot));
  return {(law_force(axis, t, s + h, s_dot) - law_force(axis, t, s - h, s_dot)) / (2 * h),
          (law_force(axis, t, s, s_dot + h_dot) - law_force(axis, t, s, s_dot - h_dot)) / (2 * h_dot)};
}

void validate(const Axis& axis, const std::string& who) {
  require(std::isfinite(axis.s_0) && std::isfinite(axis.s_dot_0), who, "initial coordinate ", axis.s_0,
          " and rate ", axis.s_dot_0, " must be finite");
  for (double value : axis.load.value) require(std::isfinite(value), who, "load ", value, " must be finite");
  require(std::isfinite(axis.damping) && axis.damping >= 0, who, "damping ", axis.damping,
          " must not be negative");
  require(std::isfinite(axis.friction) && axis.friction >= 0, who, "friction ", axis.friction,
          " must not be negative");
  require(axis.friction == 0 || (std::isfinite(axis.friction_rate) && axis.friction_rate > 0), who,
          "friction needs a friction rate, the speed at which it is tanh(1) of its full value: ",
          axis.friction_rate, " must be positive");
  require(!axis.drive || (axis.s_0 == 0 && axis.s_dot_0 == 0 && axis.load.value.empty() && !axis.law), who,
          "a prescribed motion takes no load, initial coordinate or initial rate beside it");
}

void require_covers(const Signal& signal, double end_time, const std::string& who) {
  if (signal.table) require_span(signal.time, end_time, who);
}

void require_covers(const Axis& axis, double end_time, const std::string& who) {
  require_covers(axis.load, end_time, who);
  if (axis.drive && axis.drive->type == Drive::Type::table) require_span(axis.drive->time, end_time, who);
}

}  // namespace elastogear::dynamics
