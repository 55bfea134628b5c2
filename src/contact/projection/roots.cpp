#include "contact/projection/roots.h"

namespace elastogear::contact {
namespace {

double value(const std::vector<double>& p, double u) {
  double sum = 0;
  for (std::size_t i = p.size(); i-- > 0;) sum = sum * u + p[i];
  return sum;
}

std::vector<double> derivative(const std::vector<double>& p) {
  std::vector<double> d;
  for (std::size_t i = 1; i < p.size(); ++i) d.push_back(static_cast<double>(i) * p[i]);
  return d;
}

double bisect(const std::vector<double>& p, double lo, double hi) {
  constexpr int kHalvings = 54;  // of an interval, down to roundoff
  const bool rises = value(p, hi) > 0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (lo + hi) / 2;
    ((value(p, middle) > 0) == rises ? hi : lo) = middle;
  }
  return hi;
}

}  // namespace

// Between the roots of its derivative a polynomial is monotonic.
std::vector<double> sign_changes(const std::vector<double>& p, double lo, double hi) {
  std::vector<double> roots;
  if (p.size() < 2) return roots;
  std::vector<double> knots = sign_changes(derivative(p), lo, hi);
  knots.push_back(hi);
  for (double from = lo; double to : knots) {
    if ((value(p, from) > 0) != (value(p, to) > 0)) roots.push_back(bisect(p, from, to));
    from = to;
  }
  return roots;
}

}  // namespace elastogear::contact
