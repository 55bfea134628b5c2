#include "elastogear/gear/modification.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>

#include "elastogear/base/error.h"

namespace elastogear::gear {
namespace {

using std::numbers::pi;

constexpr double kLargest = 0.1;      // modules: larger deviations are another design, or a wrong unit
constexpr double kMicron = 1e-6;      // m
constexpr double kTolerance = 1e-13;  // m
constexpr int kSteps = 50;
constexpr double kRound = 0.05;  // of the length of a linear relief: to both sides of its beginning

// distance: from the beginning of the relief towards its end. Linear ones begin with a parabola. Eq. (9.7a).
double removed(const Relief& relief, double distance) {
  if (relief.amount == 0) return 0;
  const double t = distance / relief.length, blend = relief.parabolic ? 0 : kRound;
  if (t <= -blend) return 0;
  if (relief.parabolic) return relief.amount * t * t;
  return relief.amount * (t < blend ? (t + blend) * (t + blend) / (4 * blend) : t);
}

// roll: from the start of contact. z: from the middle of the face.
double removed(const FlankModification& m, double roll, double profile, double z, double width) {
  const double a = 2 * roll / profile - 1, b = 2 * z / width;  // -1 and 1 at the ends
  return removed(m.tip, roll - profile + m.tip.length) + removed(m.root, m.root.length - roll) +
         m.C_alpha * a * a + m.C_Halpha * (a + 1) / 2 +
         removed(m.end, std::abs(z) - width / 2 + m.end.length) + m.C_beta * b * b + m.C_Hbeta * (b + 1) / 2 +
         m.S_alpha * a * b / 4;
}

// The interval of increasing values that holds `at`, and the place within it.
std::pair<Eigen::Index, double> place(const Eigen::VectorXd& values, double at) {
  const auto above = std::upper_bound(values.begin() + 1, values.end() - 1, at);
  const Eigen::Index i = above - values.begin() - 1;
  return {i, std::clamp((at - values[i]) / (values[i + 1] - values[i]), 0.0, 1.0)};
}

double height(const Topography& topography, double roll, double z) {
  const auto [i, s] = place(topography.roll, roll);
  const auto [j, t] = place(topography.z, z);
  const auto& h = topography.height;
  return (1 - s) * ((1 - t) * h(i, j) + t * h(i, j + 1)) + s * ((1 - t) * h(i + 1, j) + t * h(i + 1, j + 1));
}

bool is_of(const Topography& topography, const Flank& flank) {
  return (topography.tooth < 0 || topography.tooth == flank.tooth) &&
         (topography.side == 0 || topography.side == flank.side);
}

double module_of(const Toothing& t) { return 2 * t.r / t.z; }

// One number of the modifications, for messages; the names are those of the drive file.
struct Amount {
  const char* name;
  double value;
};

void check_amounts(const std::string& name, double largest, std::initializer_list<Amount> amounts) {
  for (const Amount& amount : amounts)
    require(std::isfinite(amount.value) && std::abs(amount.value) <= largest, name, ": ", amount.name, " = ",
            amount.value / kMicron, " um: must be at most ", largest / kMicron,
            " um, a tenth of a module; is its unit right?");
}

void check_length(const std::string& name, const char* what, const Relief& relief, double most) {
  if (relief.amount == 0) return;
  require(relief.length > 0 && relief.length <= most, name, ": ", what, " = ", relief.length * 1e3,
          " mm: must be above 0 and at most ", most * 1e3, " mm");
}

void check(const std::string& name, const FlankModification& m, double profile, double width,
           double largest) {
  check_amounts(name, largest,
                {{"tip_relief", m.tip.amount},
                 {"root_relief", m.root.amount},
                 {"profile_crowning", m.C_alpha},
                 {"profile_slope", m.C_Halpha},
                 {"end_relief", m.end.amount},
                 {"lead_crowning", m.C_beta},
                 {"helix_slope", m.C_Hbeta},
                 {"twist", m.S_alpha}});
  check_length(name, "tip_relief_length", m.tip, profile);
  check_length(name, "root_relief_length", m.root, profile);
  check_length(name, "end_relief_length", m.end, width / 2);
}

}  // namespace

bool teeth_differ(const FlankDeviations& d) {
  return d.index.any() || d.eccentricity.any() ||
         std::any_of(d.topography.begin(), d.topography.end(), [](const auto& t) { return t.tooth >= 0; });
}

bool are_exact(const FlankDeviations& d) {
  const auto is_exact = [](const FlankModification& m) {
    const double amounts[] = {m.tip.amount, m.root.amount, m.end.amount, m.C_alpha,
                              m.C_Halpha,   m.C_beta,      m.C_Hbeta,    m.S_alpha};
    return std::all_of(std::begin(amounts), std::end(amounts), [](double amount) { return amount == 0; });
  };
  return is_exact(d.left) && is_exact(d.right) && !d.index.any() && !d.eccentricity.any() &&
         d.topography.empty();
}

double length_of_roll(const Toothing& t, double r) { return std::sqrt(std::max(0.0, r * r - t.r_b * t.r_b)); }

double profile_length(const Toothing& t) {
  return t.sign() * (length_of_roll(t, t.r_a) - length_of_roll(t, t.r_start));
}

double relief_length(const Toothing& t) {
  const double profile = profile_length(t), p_bt = 2 * pi * t.r_b / t.z;
  return std::clamp(profile - p_bt, profile / 10, profile / 2);
}

void check(const std::string& name, const Toothing& t, const FlankDeviations& deviations) {
  const double largest = kLargest * module_of(t);
  for (const FlankModification* m : {&deviations.left, &deviations.right})
    check(name, *m, profile_length(t), deviations.width, largest);
  check_amounts(name, largest, {{"run_out", 2 * deviations.eccentricity.norm()}});
  for (double value : deviations.index) check_amounts(name, largest, {{"pitch_deviation", value}});
  for (const Topography& topography : deviations.topography)
    for (double value : topography.height.reshaped())
      check_amounts(name, largest, {{"a height of the topography", value}});
}

// Eq. (9.7): an index deviation turns the tooth, an eccentricity moves it.
double flank_deviation(const Toothing& t, const FlankDeviations& deviations, const Flank& flank,
                       const Eigen::Vector3d& x) {
  const double length = length_of_roll(t, x.head<2>().norm()),
               roll = t.sign() * (length - length_of_roll(t, t.r_start));
  double out = -removed(flank.side > 0 ? deviations.left : deviations.right, roll, profile_length(t), x[2],
                        deviations.width);
  const Eigen::Vector2d n = flank_normal(t, flank, x).head<2>();
  if (deviations.index.size() > 0) out += deviations.index[flank.tooth] / t.r * (n[1] * x[0] - n[0] * x[1]);
  out += deviations.eccentricity.dot(n);
  for (const Topography& topography : deviations.topography)
    if (is_of(topography, flank)) out += height(topography, length, x[2]);
  return out;
}

// The normals of the exact flank are straight and its distance is exact along them (of other forms than
// involutes to second order), so that the foot of a point is found at once.
double flank_distance_along(const Toothing& t, const FlankDeviations& deviations, const Flank& flank,
                            const Eigen::Vector3d& x, const Eigen::Vector3d& n) {
  double s = flank_distance_along(t, flank, x, n);
  for (int step = 0; step < kSteps && std::isfinite(s); ++step) {
    const Eigen::Vector3d at = x + s * n, normal = flank_normal(t, flank, at);
    const double d = flank_distance(t, flank.tooth, flank.side, at);
    const double left = d - flank_deviation(t, deviations, flank, at - d * normal);
    if (std::abs(left) <= kTolerance) return s;
    s -= left / n.dot(normal);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace elastogear::gear
