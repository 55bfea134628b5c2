#include "dynamics/errors/time_error.h"

#include <cmath>

namespace elastogear::dynamics {
namespace {

constexpr std::size_t kForces = 3;    // of stages, through which a force is a parabola
constexpr double kShortTime = 0.5;    // times frequency and decay, up to which responses are summed up
constexpr double kShortBefore = 0.1;  // of a step, between two forces before it
constexpr int kTerms = 16;            // of their power series, to roundoff at kShortTime

struct Response {
  double g, g_dot, P_0, P_1, P_2;
};

// By the power series of g, whose derivatives at 0 are 0, 1 and a_(n+2) = -d a_(n+1) - k a_n.
Response short_response(double d, double k, double t) {
  double a = 0, next = 1, power = t * t / 2, P_1 = 0, P_2 = 0;  // power: t^(n+2)/(n+2)!
  for (int n = 0; n < kTerms; ++n) {
    P_1 += a * power;
    power *= t / (n + 3);
    P_2 += a * power;
    const double after = -d * next - k * a;
    a = next;
    next = after;
  }
  const double P_0 = t * t / 2 - d * P_1 - k * P_2, g = t - d * P_0 - k * P_1;
  return {g, 1 - d * g - k * P_0, P_0, P_1, P_2};
}

// In closed form, of damping below and above the critical one.
Response long_response(double d, double k, double t) {
  const double s = k - d * d / 4, w = std::sqrt(std::abs(s));
  double c = 1, g = t;
  if (s > 0) {
    c = std::cos(w * t);
    g = std::sin(w * t) / w;
  } else if (s < 0) {
    c = std::cosh(w * t);
    g = std::sinh(w * t) / w;
  }
  const double decay = std::exp(-d * t / 2);
  g *= decay;
  const double g_dot = decay * c - d / 2 * g, P_0 = (1 - g_dot - d * g) / k, P_1 = (t - g - d * P_0) / k;
  return {g, g_dot, P_0, P_1, (t * t / 2 - P_0 - d * P_1) / k};
}

}  // namespace

Responses responses(const Oscillators& of, double duration) {
  const Eigen::Index n = of.m.size();
  Responses all{duration,          Eigen::ArrayXd(n), Eigen::ArrayXd(n),
                Eigen::ArrayXd(n), Eigen::ArrayXd(n), Eigen::ArrayXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const double d = of.d[i] / of.m[i], k = of.k[i] / of.m[i];
    const bool is_short = std::max(d, std::sqrt(k)) * duration < kShortTime;
    const Response r = is_short ? short_response(d, k, duration) : long_response(d, k, duration);
    all.g[i] = r.g, all.g_dot[i] = r.g_dot;
    all.P_0[i] = r.P_0, all.P_1[i] = r.P_1, all.P_2[i] = r.P_2;
  }
  return all;
}

TimeError::TimeError(Oscillators of)
    : of_(std::move(of)),
      error_(Coordinates::Zero(size())),
      error_rate_(Coordinates::Zero(size())),
      start_U_(size()),
      start_V_(size()),
      start_error_(error_),
      start_error_rate_(error_) {}

TimeError::Coordinates TimeError::force(const Coordinates& U, const Coordinates& V,
                                        const Coordinates& A) const {
  return A + (of_.d * V + of_.k * U) / of_.m;
}

void TimeError::start(double time, const IntegratedStep::Motion& motion) {
  forces_ = {{0, force(motion.U.array(), motion.V.array(), motion.A.array())}};
  end_time_ = time;
}

// The parabola through the forces at the last stages, a line or a constant through fewer; Newton's form.
// Times count from the start of the step.
TimeError::Polynomial TimeError::acting() const {
  const Force& last = forces_.back();
  const Coordinates zero = Coordinates::Zero(size());
  if (forces_.size() == 1) return {last.value, zero, zero};
  const Force &before = forces_[forces_.size() - 2], &first = forces_.front();
  const Coordinates slope = (last.value - before.value) / (last.time - before.time);
  if (forces_.size() == 2) return {last.value - last.time * slope, slope, zero};
  const Coordinates slope_before = (before.value - first.value) / (before.time - first.time),
                    bend = (slope - slope_before) / (last.time - first.time);
  return {last.value - last.time * slope + before.time * last.time * bend,
          slope - (before.time + last.time) * bend, 2 * bend};
}

// Eq. (8.20). A force so shortly before another one tells nothing of the bend over this step.
void TimeError::add_force(const IntegratedStep& step) {
  const auto at_stage = [](double alpha, const auto& start, const auto& end) -> Coordinates {
    return (1 - alpha) * start.array() + alpha * end.array();
  };
  if (forces_.size() == kForces) forces_.erase(forces_.begin());
  if (forces_.size() == 2 && forces_[1].time - forces_[0].time < kShortBefore * step.size)
    forces_.erase(forces_.begin());
  forces_.push_back({step.alpha_f * step.size, force(at_stage(step.alpha_f, step.start.U, step.end.U),
                                                     at_stage(step.alpha_f, step.start.V, step.end.V),
                                                     at_stage(step.alpha_m, step.start.A, step.end.A))});
}

// Eq. (8.21).
void TimeError::follow(const IntegratedStep& step, bool had_impulse) {
  start_time_ = step.time;
  end_time_ = step.time + step.size;
  start_U_ = step.start.U;
  start_V_ = step.start.V;
  start_error_ = error_;
  start_error_rate_ = error_rate_;
  if (responses_.duration != step.size) responses_ = responses(of_, step.size);
  const Responses& r = responses_;
  const Coordinates k = of_.k / of_.m, held = r.g_dot + of_.d / of_.m * r.g;
  error_ = held * start_error_ + r.g * start_error_rate_;
  error_rate_ = r.g_dot * start_error_rate_ - k * r.g * start_error_;
  acting_ = {};
  if (had_impulse) return forces_.clear();
  add_force(step);
  acting_ = acting();
  error_ += step.end.U.array() - held * start_U_ - r.g * start_V_ - r.P_0 * acting_.c_0 -
            r.P_1 * acting_.c_1 - r.P_2 * acting_.c_2;
  error_rate_ += step.end.V.array() - r.g_dot * start_V_ + k * r.g * start_U_ - r.g * acting_.c_0 -
                 r.P_0 * acting_.c_1 - r.P_1 * acting_.c_2;
  for (Force& each : forces_) each.time -= step.size;
}

Eigen::VectorXd TimeError::within(double time, const Eigen::Ref<const Eigen::VectorXd>& U) const {
  const Responses r = responses(of_, time - start_time_);
  const Coordinates held = r.g_dot + of_.d / of_.m * r.g;
  Coordinates error = held * start_error_ + r.g * start_error_rate_;
  if (acting_.c_0.size() > 0)
    error += U.array() - held * start_U_ - r.g * start_V_ - r.P_0 * acting_.c_0 - r.P_1 * acting_.c_1 -
             r.P_2 * acting_.c_2;
  return error;
}

void TimeError::serialize(Archive& archive) {
  archive(error_);
  archive(error_rate_);
  archive(end_time_);
  archive.each(forces_, [&](Force& force) {
    archive(force.time);
    archive(force.value);
  });
}

}  // namespace elastogear::dynamics
