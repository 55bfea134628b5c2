#pragma once
// Zeros of smooth functions of one variable.

#include <cmath>

namespace elastogear::gear {

/// Zero near x of a function whose slope is `slope` there, by secants; tolerance: of the function. NaN
/// without one.
template <class Function>
double secant_zero(Function function, double x, double slope, double tolerance) {
  constexpr int kSteps = 60;
  double f = function(x);
  for (int step = 0; step < kSteps && std::abs(f) > tolerance; ++step) {
    const double next = x - f / slope, f_next = function(next);
    if (next == x) break;
    slope = (f_next - f) / (next - x);
    x = next, f = f_next;
  }
  return std::abs(f) <= 1e3 * tolerance ? x : std::nan("");
}

/// Zero in [low, high] of a function that changes its sign there, to roundoff: secants, halved where they
/// hardly move the bracket.
template <class Function>
double bracketed_zero(Function function, double low, double high) {
  constexpr int kSteps = 200;
  double f_low = function(low), f_high = function(high), last = high;
  for (int step = 0; step < kSteps; ++step) {
    double x = low - f_low * (high - low) / (f_high - f_low);
    if (step % 4 == 3 || !(x > low && x < high)) x = (low + high) / 2;
    const double f = function(x);
    if (f == 0 || x == last || x == low || x == high) return x;
    last = x;
    // Illinois: the end that stays loses half its weight.
    if ((f < 0) == (f_low < 0))
      low = x, f_low = f, f_high /= 2;
    else
      high = x, f_high = f, f_low /= 2;
  }
  return last;
}

}  // namespace elastogear::gear
