#pragma once
// The bracket of a search for the least gap along a side of the slave.

#include <utility>

namespace elastogear::contact {

/// The part of a side, in shares of its length, that a search is left with. Beyond an end that is cut no foot
/// point was found.
struct Bracket {
  static constexpr double kConverged = 1e-10;  // of local coordinates
  static constexpr double kNearCut = 1e-5;     // of a side, from where a cut end may be near

  double low = 0, high = 1;
  bool low_is_cut = false, high_is_cut = false;

  double middle() const { return 0.5 * (low + high); }
  bool is_cut() const { return low_is_cut || high_is_cut; }
  void cut(double s, double from) {
    (s > from ? high : low) = s;
    (s > from ? high_is_cut : low_is_cut) = true;
  }
  void narrow(double s, double slope) {
    (slope > 0 ? high : low) = s;
    (slope > 0 ? high_is_cut : low_is_cut) = false;
  }
  void join_again() {
    if (std::exchange(low_is_cut, false)) low = 0;
    if (std::exchange(high_is_cut, false)) high = 1;
  }
  bool falls_to_cut(double slope) const { return slope > 0 ? low_is_cut : high_is_cut; }
  bool is_left(double slope) const { return high - low > (falls_to_cut(slope) ? kNearCut : kConverged); }
};

}  // namespace elastogear::contact
