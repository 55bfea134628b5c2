#include "app/compare/compare_moment.h"

#include <algorithm>
#include <vector>

#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

constexpr double kRoundoff = 1e-9;  // of the last time

double last(const Eigen::VectorXd& time) { return time[time.size() - 1]; }

// The time that an option of this name asks for.
double time_of(double t, const std::string& name, const Eigen::VectorXd& time) {
  if (t == kLastTime) return last(time);
  require(t >= time[0] && t <= last(time) * (1 + kRoundoff), "option -", name, " = ", t,
          " s: is outside of the file, ", time[0], " .. ", last(time), " s");
  return t;
}

}  // namespace

Eigen::Index peak_within(const CompareSettings& settings, const Eigen::VectorXd& time,
                         const Eigen::VectorXd& values) {
  const double from = settings.from.value_or(time[0]);
  const double to = settings.to.value_or(last(time));
  Eigen::Index peak = -1;
  for (Eigen::Index i = 0; i < time.size(); ++i)
    if (time[i] >= from && time[i] <= to && (peak < 0 || values[i] > values[peak])) peak = i;
  require(peak >= 0, "options -from and -to: the reference has no time between ", from, " and ", to, " s");
  return peak;
}

Moment moment(const CompareSettings& settings, const Eigen::VectorXd& time,
              const Eigen::VectorXd& reference_time, double peak) {
  const double t = settings.at ? time_of(*settings.at, "at", time) : peak;
  if (settings.reference_at) return {t, time_of(*settings.reference_at, "reference_at", reference_time)};
  if (settings.at == kLastTime) return {t, last(reference_time)};
  require(t >= time[0] && t <= last(time) * (1 + kRoundoff), "the reference's peak at ", t,
          " s is outside of the file, ", time[0], " .. ", last(time), " s: say -at TIME");
  return {t, settings.at ? time_of(t, "at", reference_time) : t};
}

Eigen::VectorXd common_times(const CompareSettings& settings, const Eigen::VectorXd& time,
                             const Eigen::VectorXd& reference_time, double begin, double end) {
  if (settings.reference_at || settings.at == kLastTime) return {};
  const double from = std::max(settings.from.value_or(begin), time[0]);
  const double to = std::min(settings.to.value_or(end), last(time) * (1 + kRoundoff));
  std::vector<double> common;
  std::copy_if(reference_time.begin(), reference_time.end(), std::back_inserter(common),
               [&](double t) { return t >= from && t <= to; });
  require(common.size() > 1, "the files share ", common.size(), " times between ", from, " and ", to,
          " s: signals need two; -reference_at compares files whose times mean different things");
  return Eigen::Map<const Eigen::VectorXd>(common.data(), static_cast<Eigen::Index>(common.size()));
}

}  // namespace elastogear::app
