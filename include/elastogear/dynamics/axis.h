#pragma once
// Load, friction and prescribed motion along one coordinate of a joint.

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace elastogear::dynamics {

/// A load over time: linear between the given times, constant before and after them.
struct Signal {
  std::vector<double> time, value;  ///< s ascending; N or N m. Empty: zero
  bool table = false;               ///< of a user: must cover the whole run
};

Signal constant_signal(double value);
/// From zero to `value` within `duration` (s) from time 0.
Signal ramp_signal(double value, double duration);
/// Throws Error unless times ascend and all is finite.
Signal table_signal(std::vector<double> time, std::vector<double> value);

double at(const Signal& signal, double t);

/// Coordinate and rates, m or rad.
struct Prescribed {
  double s, s_dot, s_ddot;
};

/// A motion over time, at least twice continuously differentiable.
struct Drive {
  enum class Type {
    speed,    ///< s_0 + v t
    spin_up,  ///< from rest to v within a duration T: s' = v (t/T - sin(2 pi t/T)/(2 pi)), then v
    table,    ///< natural cubic spline through times and values
    still,    ///< s_0 + v (t - duration) from then on, as if at rest: for equilibria, where t is no time
  };
  Type type = Type::speed;
  double s_0 = 0, v = 0, duration = 0;  ///< m or rad, per s, s
  std::vector<double> time, value, curvature;
};

Drive speed_drive(double s_0, double v);
Drive spin_up_drive(double s_0, double v, double duration);
Drive still_drive(double s_0, double v, double start = 0);
/// Throws Error unless there are at least two ascending times and all is finite.
Drive table_drive(std::vector<double> time, std::vector<double> value);

Prescribed at(const Drive& drive, double t);

/// A force along a coordinate that a program computes, N or N m, of the time (s), the coordinate (m or rad)
/// and its rate. It is asked any number of times in a step, in any order, and must depend on nothing else.
using ForceLaw = std::function<double(double t, double s, double s_dot)>;

struct Axis {
  double s_0 = 0, s_dot_0 = 0;  ///< m or rad, initial values; not with a drive
  Signal load = {};             ///< N or N m
  double damping = 0;           ///< N s/m or N m s, viscous
  double friction = 0;          ///< N or N m, Coulomb: friction tanh(s' / friction_rate)
  double friction_rate = 0;     ///< m/s or rad/s
  std::optional<Drive> drive = {};
  ForceLaw law = {};  ///< beside the load; not with a drive
};

/// Force of the law, 0 where there is none. Throws Error when it is not finite.
double law_force(const Axis& axis, double t, double s, double s_dot);

/// Derivatives of the law's force with coordinate and rate, by central differences; zero where there is none.
struct LawRates {
  double by_s = 0, by_s_dot = 0;
};
LawRates law_rates(const Axis& axis, double t, double s, double s_dot);

/// Damping and friction, a force against the motion, and its derivative with the rate.
double resistance(const Axis& axis, double s_dot);
double resistance_rate(const Axis& axis, double s_dot);

/// Throws Error, beginning with `who`, for values that are not finite, negative damping or friction, friction
/// without a rate, loads, laws or initial values beside a drive.
void validate(const Axis& axis, const std::string& who);

/// Throws Error when a table ends before `end_time` or begins after 0.
void require_covers(const Signal& signal, double end_time, const std::string& who);
void require_covers(const Axis& axis, double end_time, const std::string& who);

}  // namespace elastogear::dynamics
