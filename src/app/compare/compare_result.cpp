#include "app/compare/compare_result.h"

#include <algorithm>
#include <limits>
#include <map>

#include "app/compare/compare_moment.h"
#include "app/console/console.h"
#include "elastogear/base/error.h"
#include "elastogear/io/result_file.h"
#include "elastogear/recovery/deviation.h"

namespace elastogear::app {
namespace {

struct Signals {
  Eigen::VectorXd time;
  std::map<std::string, std::pair<std::string, Eigen::RowVectorXd>> by_name;  // unit, n_t values
  Eigen::VectorXd force;                                                      // N, n_t, largest of all pairs
  double first_contact = 0, last_contact = 0;                                 // s
};

Eigen::RowVectorXd magnitude(const Eigen::MatrixXd& force, Eigen::Index group) {
  return force.middleRows(3 * group, 3).colwise().norm();
}

void add_pair(Signals& signals, const std::string& name, const io::PairHistory& pair) {
  const Eigen::RowVectorXd force = magnitude(pair.force, 0);
  signals.by_name["force " + name] = {"N", force};
  signals.by_name["penetration " + name] = {"m", pair.penetration.transpose()};
  for (const int side : {0, 1})
    for (std::size_t g = 0; g < pair.group_name[side].size(); ++g) {
      const Eigen::RowVectorXd part = magnitude(pair.group_force[side], static_cast<Eigen::Index>(g));
      if (part.maxCoeff() > 0)
        signals.by_name["force " + name + " " + pair.group_name[side][g]] = {"N", part};
    }
  signals.force = signals.force.cwiseMax(force.transpose());
}

// The spans between the first and the last active contact of any pair; else all times.
void set_contact_times(Signals& signals, const Eigen::VectorXi& count) {
  signals.first_contact = signals.time[0];
  signals.last_contact = signals.time[signals.time.size() - 1];
  std::vector<double> touching;
  for (Eigen::Index i = 0; i < count.size(); ++i)
    if (count[i] > 0) touching.push_back(signals.time[i]);
  if (touching.size() < 2) return;
  signals.first_contact = touching.front();
  signals.last_contact = touching.back();
}

void add_body(Signals& signals, const std::string& name, const std::string& joint,
              const io::BodyHistory& history) {
  const bool turns = joint != "prismatic";
  for (Eigen::Index i = 0; i < history.s.rows(); ++i) {
    const std::string suffix = history.s.rows() > 1 ? name + " " + std::to_string(i + 1) : name;
    signals.by_name["coordinate " + suffix] = {turns && i == 0 ? "rad" : "m", history.s.row(i)};
    signals.by_name["speed " + suffix] = {turns && i == 0 ? "rad/s" : "m/s", history.s_dot.row(i)};
  }
}

// Forces under two laws of contact differ for more reasons than the bodies.
void warn_of_laws(const model::ResultHeader& file, const model::ResultHeader& reference) {
  for (const auto& a : file.pairs)
    for (const auto& b : reference.pairs)
      if (a.name == b.name && !a.law.empty() && !b.law.empty() && a.law != b.law)
        print_item("warning",
                   "contact " + a.name + ": the law of contact is " + a.law + ", that of the reference " +
                       b.law +
                       "; for a difference of the bodies alone run both with one, -contact_law penalty");
}

Signals read_signals(const std::string& path, const model::ResultHeader& header) {
  Signals signals;
  signals.time = io::read_times(path);
  Eigen::VectorXi count = Eigen::VectorXi::Zero(signals.time.size());
  signals.force = Eigen::VectorXd::Zero(signals.time.size());
  for (const auto& pair : header.pairs) {
    const io::PairHistory history = io::read_pair_history(path, pair.name);
    add_pair(signals, pair.name, history);
    count += history.count;
  }
  set_contact_times(signals, count);
  for (const auto& body : header.bodies)
    if (body.joint == "revolute" || body.joint == "prismatic" || body.joint == "cylindrical")
      add_body(signals, body.name, body.joint, io::read_joint_history(path, body.name));
  return signals;
}

double relative(double a, double b) {
  return b == 0 ? std::numeric_limits<double>::quiet_NaN() : kPercent * std::abs(a - b) / std::abs(b);
}

Table values_table(const CompareSettings& settings, const Signals& file, const Signals& reference) {
  const double peak = reference.time[peak_within(settings, reference.time, reference.force)];
  const Moment when = moment(settings, file.time, reference.time, peak);
  Table table{"Values", "signal", {{"value", "1"}, {"reference", "1"}, {"deviation", "%"}}, {}, {}};
  for (const auto& [name, b] : reference.by_name) {
    const auto found = file.by_name.find(name);
    if (found == file.by_name.end()) continue;
    const auto value = [](const Eigen::VectorXd& time, const Eigen::RowVectorXd& values, double t) {
      return recovery::at_times(time, values, Eigen::VectorXd::Constant(1, t))(0, 0);
    };
    const double v = value(file.time, found->second.second, when.time);
    const double r = value(reference.time, b.second, when.reference_time);
    table.add(name + " [" + b.first + "]", Eigen::Vector3d(v, r, relative(v, r)));
  }
  return table;
}

Table signals_table(const CompareSettings& settings, const Signals& file, const Signals& reference) {
  Table table{"Signals over time",
              "signal",
              {{"L2", "%"}, {"peak", "1"}, {"reference", "1"}, {"peak at", "s"}, {"reference at", "s"}},
              {},
              {}};
  const Eigen::VectorXd time =
      common_times(settings, file.time, reference.time, reference.first_contact, reference.last_contact);
  if (time.size() == 0) return table;
  for (const auto& [name, b] : reference.by_name) {
    const auto found = file.by_name.find(name);
    if (found == file.by_name.end()) continue;
    const recovery::SignalDeviation d = recovery::signal_deviation(
        time, recovery::at_times(file.time, found->second.second, time).row(0).transpose(),
        recovery::at_times(reference.time, b.second, time).row(0).transpose());
    Eigen::VectorXd row(5);
    row << kPercent * d.l2, d.peak.value, d.reference_peak.value, d.peak.time, d.reference_peak.time;
    table.add(name + " [" + b.first + "]", row);
  }
  return table;
}

}  // namespace

std::vector<Table> compare_results(const Options& options, const std::string& path,
                                   const std::string& reference_path) {
  options.reject_unknown();
  const CompareSettings settings = compare_settings(options);
  const model::ResultHeader header = io::read_result_header(path),
                            reference_header = io::read_result_header(reference_path);
  warn_of_laws(header, reference_header);
  const Signals file = read_signals(path, header), reference = read_signals(reference_path, reference_header);
  std::vector<Table> tables = {values_table(settings, file, reference)};
  require(!tables[0].rows.empty(), path, " and ", reference_path,
          " have no pair of bodies and no moving body of the same name");
  const Table signals = signals_table(settings, file, reference);
  if (!signals.rows.empty()) tables.push_back(signals);
  return tables;
}

}  // namespace elastogear::app
