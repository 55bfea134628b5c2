#include "gear/worm/hobbed_wheel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "elastogear/base/error.h"
#include "gear/worm/secant.h"
#include "gear/worm/thread_form.h"

namespace elastogear::gear {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

constexpr int kPlaneSamples = 24;  // from the middle to the end of the face, in which the wheel is checked
constexpr int kAlongFlank = 40;    // along flank and fillet there
constexpr int kFaceBisections = 50;
constexpr double kLeastTip = 0.1;     // modules, thickness of a tooth's tip
constexpr double kLeastHeight = 0.3;  // modules, height of the flank

// The wheel's left flank in a plane.
struct HobbedSection {
  double z = 0;
  double r_f = 0, r_form = 0, r_a = 0;  // m
};

HobbedSection hobbed_section(const Hob& h, double z) {
  return {z, cut(h, arc_point(h, pi / 2), z).r, cut(h, flank_point(h, h.thread.r_form), z).r,
          tip_radius(h, z)};
}

// m, where the throat ends and the outside diameter begins; 0: nowhere.
double throat_end(const Hob& h) {
  const double depth = h.a_worm - h.tip;
  return h.throat > std::abs(depth) ? std::sqrt(h.throat * h.throat - depth * depth) : 0;
}

// Half the tooth thickness on flank or fillet.
double left_angle(const Hob& h, const HobbedSection& s, double r) {
  if (r >= s.r_form) return hobbed_half_angle(h, r, s.z).psi;
  const double begin = arc_begin(h);
  if (r <= s.r_f) return cut(h, arc_point(h, pi / 2), s.z).angle;
  // r_form is the radius of the flank's end. That of the arc's end differs from it by roundoff, and between
  // both the arc has no point of radius r.
  if (const Cut end = cut(h, arc_point(h, begin), s.z); r >= end.r) return end.angle;
  const double b =
      bracketed_zero([&](double at) { return cut(h, arc_point(h, at), s.z).r - r; }, begin, pi / 2);
  return cut(h, arc_point(h, b), s.z).angle;
}

// The hob's radius that makes the wheel's radius r in the plane z.
double hob_radius(const Hob& h, double r, double z) {
  const double low = innermost_radius(h, z), high = h.thread.r_form;
  if (cut(h, flank_point(h, low), z).r <= r) return low;
  return bracketed_zero([&](double at) { return cut(h, flank_point(h, at), z).r - r; }, low, high);
}

// The reason why the wheel has no sound left flank in the plane z; empty where it has. On a flank without
// undercut the wheel's radius falls from the tip to the root as the hob's grows.
std::string fault(const Design& d, const Hob& h, double z) {
  if (std::abs(z) >= 0.98 * h.thread.r_form) return "the hob does not reach that far";
  const HobbedSection s = hobbed_section(h, z);
  if (!(s.r_a - s.r_form >= kLeastHeight * d.m_n))
    return "too little of the flanks is left between fillet and tip";
  const double innermost = hob_radius(h, s.r_a, z);
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 2 * kAlongFlank; ++i) {
    const double x = static_cast<double>(i) / kAlongFlank;
    const HobPoint p = x <= 1 ? flank_point(h, std::lerp(innermost, h.thread.r_form, x))
                              : arc_point(h, std::lerp(arc_begin(h), pi / 2, x - 1));
    const Cut c = cut(h, p, z);
    if (!(c.denominator < 0) || !(c.r < last)) return "the hob undercuts the teeth";
    last = c.r;
  }
  const double tip = hobbed_half_angle(h, s.r_a, z).psi + hobbed_half_angle(h, s.r_a, -z).psi;
  if (!(tip * s.r_a >= kLeastTip * d.m_n)) return "the teeth are pointed";
  return {};
}

std::string fault_of_either(const Design& d, const Hob& h, double z) {
  const std::string at = fault(d, h, z);
  return at.empty() ? fault(d, h, -z) : at;
}

void check_face(const Design& d, const Hob& h) {
  double good = 0;
  for (int i = 0; i <= kPlaneSamples; ++i) {
    double bad = d.face_width / 2 * i / kPlaneSamples;
    const std::string what = fault_of_either(d, h, bad);
    if (what.empty()) {
      good = bad;
      continue;
    }
    require(i > 0, "the wheel cannot be hobbed: in its middle plane ", what,
            "; more teeth, a larger pressure_angle or a smaller wheel_rack_tip would do");
    for (int k = 0; k < kFaceBisections; ++k) {
      const double z = (good + bad) / 2;
      (fault_of_either(d, h, z).empty() ? good : bad) = z;
    }
    fail("face_width = ", d.face_width, " m: ", what, " at ", bad,
         " m from the wheel's middle plane; at most ", 2 * std::floor(good * 1e5) * 1e-5, " m would do");
  }
}

// Least radius of the worm in contact and range of the thread's travel, over all planes.
struct Range {
  double r_worm = std::numeric_limits<double>::infinity();
  double from = std::numeric_limits<double>::infinity(), to = -from;
};

Range contact_range(const Design& d, const Geometry& g, const Hob& h) {
  Range range;
  for (int i = -kPlaneSamples; i <= kPlaneSamples; ++i) {
    const double z = d.face_width / 2 * i / kPlaneSamples;
    const double inner = hob_radius(h, tip_radius(h, z), z);
    range.r_worm = std::min(range.r_worm, inner - (h.thread.r - g.worm.r));
    for (double r : {inner, g.worm.r_a + (h.thread.r - g.worm.r)}) {
      const double at = cut(h, flank_point(h, std::min(r, h.thread.r_form)), z).travelled;
      range.from = std::min(range.from, at), range.to = std::max(range.to, at);
    }
  }
  return range;
}

}  // namespace

void derive_hobbed(const Design& d, Geometry& g) {
  const auto h = std::make_shared<const Hob>(hob(d, g));
  const double end = h->thread.r_form - (h->thread.r - g.worm.r);
  require(end >= g.worm.r_a - 1e-9 * g.worm.r_a, "wheel_rack_tip = ", d.wheel_rack_tip,
          " m: the hob's flank ends at the radius ", end, " m, below the worm's tip at ", g.worm.r_a,
          " m; at most ", (d.dedendum - d.addendum) / (1 - flank_point(*h, h->thread.r_form).n_r),
          " m would do");
  check_face(d, *h);
  g.outside_diameter = 2 * h->tip, g.throat_radius = h->throat, g.hob_swivel = h->sigma;
  const HobbedSection middle = hobbed_section(*h, 0);
  g.wheel.r_form = middle.r_form, g.wheel.r_b = g.wheel.beta_b = g.wheel.psi_b = 0;
  g.wheel.half_angle = [h](double r, double z) { return hobbed_half_angle(*h, r, z); };
  g.wheel.ends = [h](double z) {
    const HobbedSection left = hobbed_section(*h, z), right = hobbed_section(*h, -z);
    return FlankEnds{std::max(left.r_form, right.r_form), left.r_a};
  };
  g.wheel.half_face = d.face_width / 2;
  g.wheel.crease = throat_end(*h);
  const Range range = contact_range(d, g, *h);
  g.epsilon = (range.to - range.from) / g.p_x;
  require(g.epsilon >= 1, "addendum = ", d.addendum, " m: the contact ratio is ", g.epsilon,
          ", at least 1 is needed");
  g.worm.r_start = range.r_worm;
  g.wheel.r_start =
      cut(*h, flank_point(*h, std::min(g.worm.r_a + (h->thread.r - g.worm.r), h->thread.r_form)), 0).r;
}

// Radii and angles of both sides are those of the left flank in the planes z and -z.
Profile hobbed_profile(const Hob& hob, int z_2, double r_inner, double z) {
  const HobbedSection left = hobbed_section(hob, z), right = hobbed_section(hob, -z);
  const double r_f = left.r_f, r_form = std::max(left.r_form, right.r_form);
  const auto half = [=](double r, double sign) {
    return (left_angle(hob, left, r) + sign * left_angle(hob, right, r)) / 2;
  };
  Profile p{.polar = true,
            .half_pitch = pi / z_2,
            .r_inner = r_inner,
            .r_f = r_f,
            .r_form = r_form,
            .r_a = left.r_a,
            .half_width = [=](double r) { return half(r, 1); },
            .fillet = {},
            .shift = {}};
  p.fillet = [=](double t) {
    const double r = t >= 1 ? r_form : r_f + (r_form - r_f) * (1 - std::cos(t * pi / 2)), c = half(r, 1);
    return Vector2d(r * std::sin(c), r * std::cos(c));
  };
  p.shift = [=](double r) {
    const double fade = std::clamp((r - r_inner) / (r_f - r_inner), 0.0, 1.0);
    return fade * half(r, -1);
  };
  return p;
}

}  // namespace elastogear::gear
