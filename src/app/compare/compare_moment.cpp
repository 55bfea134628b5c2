#include "app/compare/compare_moment.h"

#include <algorithm>
#include <vector>

#include "elastogear/base/error.h"

namespace elastogear::app {
namespace {

constexpr double kRoundoff = 1e-9;  // of the last time

double last(const Eigen::VectorXd& time) { return time[time.size() - 1]; }

// Time that an option gives as a number or as "last".
double time_of(const Options& options, const std::string& name, const Eigen::VectorXd& time) {
  if (options.text(name) == "last") return last(time);
  const double t = options.number(name);
  require(t >= time[0] && t <= last(time) * (1 + kRoundoff), "option -", name, " = ", t,
          " s: is outside of the file, ", time[0], " .. ", last(time), " s");
  return t;
}

}  // namespace

OptionTable compare_table() {
  return {
      {"match", "-", "number",
       "which nodes of two stress files belong together: of the same number or position"},
      {"match_tolerance", "m", "1e-6", "match position: how far apart two such nodes may lie"},
      {"at", "s", "peak",
       "time at which values are compared: a number, last, or peak: where the reference's largest von Mises "
       "stress, or its largest contact force, is, between from and to when they are given"},
      {"reference_at", "s", "",
       "the same in the reference, when its times mean something else (static analysis): a number or last; "
       "no "
       "signals then"},
      {"node_<body>", "-", "",
       "nodes (numbers in the reference) in tables and signals besides those of the peak"},
      {"from", "s", "",
       "begin of the signals over time; without it, result files: the reference's first contact"},
      {"to", "s", "", "end of the signals over time; without it, result files: the reference's last contact"},
      {"output", "-", "", "first part of the names of CSV tables; without it tables are only printed"},
  };
}

Eigen::Index peak_within(const Options& options, const Eigen::VectorXd& time, const Eigen::VectorXd& values) {
  const double from = options.given("from") ? options.number("from") : time[0];
  const double to = options.given("to") ? options.number("to") : last(time);
  Eigen::Index peak = -1;
  for (Eigen::Index i = 0; i < time.size(); ++i)
    if (time[i] >= from && time[i] <= to && (peak < 0 || values[i] > values[peak])) peak = i;
  require(peak >= 0, "options -from and -to: the reference has no time between ", from, " and ", to, " s");
  return peak;
}

Moment moment(const Options& options, const Eigen::VectorXd& time, const Eigen::VectorXd& reference_time,
              double peak) {
  const bool at_peak = options.text("at") == "peak";
  const bool last_of_both = options.text("at") == "last" && !options.given("reference_at");
  const double t = at_peak ? peak : time_of(options, "at", time);
  if (options.given("reference_at")) return {t, time_of(options, "reference_at", reference_time)};
  if (last_of_both) return {t, last(reference_time)};
  require(t >= time[0] && t <= last(time) * (1 + kRoundoff), "the reference's peak at ", t,
          " s is outside of the file, ", time[0], " .. ", last(time), " s: say -at TIME");
  return {t, at_peak ? t : time_of(options, "at", reference_time)};
}

Eigen::VectorXd common_times(const Options& options, const Eigen::VectorXd& time,
                             const Eigen::VectorXd& reference_time, double begin, double end) {
  if (options.given("reference_at") || options.text("at") == "last") return {};
  const double from = std::max(options.given("from") ? options.number("from") : begin, time[0]);
  const double to = std::min(options.given("to") ? options.number("to") : end, last(time) * (1 + kRoundoff));
  std::vector<double> common;
  std::copy_if(reference_time.begin(), reference_time.end(), std::back_inserter(common),
               [&](double t) { return t >= from && t <= to; });
  require(common.size() > 1, "the files share ", common.size(), " times between ", from, " and ", to,
          " s: signals need two; -reference_at compares files whose times mean different things");
  return Eigen::Map<const Eigen::VectorXd>(common.data(), static_cast<Eigen::Index>(common.size()));
}

}  // namespace elastogear::app
