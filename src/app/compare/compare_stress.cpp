#include "app/compare/compare_stress.h"

#include <algorithm>

#include "app/compare/compare_moment.h"
#include "elastogear/base/error.h"
#include "elastogear/io/stress_file.h"
#include "elastogear/recovery/deviation.h"

namespace elastogear::app {
namespace {

constexpr double kPerMega = 1e-6;
const std::vector<std::string> kMeasures = {"xx", "yy", "zz", "xy", "yz", "xz", "von Mises", "Rankine"};
constexpr int kPaperOrder[] = {0, 1, 2, 3, 5, 4, 6, 7};  // of Tab. 3

// Stresses at the same nodes in the same order, 6 n x the times of each file.
struct Matched {
  std::string name;  // "worm root"
  std::vector<int> node;
  Eigen::MatrixXd stress, reference;
  Eigen::VectorXd time, reference_time;

  Eigen::VectorXd at(double t) const {
    return recovery::at_times(time, stress, Eigen::VectorXd::Constant(1, t));
  }
  Eigen::VectorXd reference_at(double t) const {
    return recovery::at_times(reference_time, reference, Eigen::VectorXd::Constant(1, t));
  }
};

std::vector<int> match(const CompareSettings& settings, const io::StressSet& set,
                       const io::StressSet& reference) {
  if (!settings.by_position) return recovery::match_numbers(set.node, reference.node);
  require(
      set.X.size() > 0 && reference.X.size() > 0,
      "one of the files holds no positions (an older version wrote it): match by number, or recover it anew");
  return recovery::match_positions(set.X, reference.X, settings.match_tolerance);
}

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& stress, const std::vector<int>& node) {
  Eigen::MatrixXd rows(6 * static_cast<Eigen::Index>(node.size()), stress.cols());
  for (std::size_t i = 0; i < node.size(); ++i)
    rows.middleRows(6 * static_cast<Eigen::Index>(i), 6) = stress.middleRows(6 * node[i], 6);
  return rows;
}

std::vector<Matched> matched_sets(const CompareSettings& settings, const io::StressFile& file,
                                  const io::StressFile& reference) {
  std::vector<Matched> all;
  for (const io::StressSet& wanted : reference.sets)
    for (const io::StressSet& set : file.sets) {
      if (set.body != wanted.body || set.set != wanted.set) continue;
      const std::vector<int> places = match(settings, set, wanted);
      all.push_back({set.body + " " + set.set, wanted.node, rows_of(set.stress, places), wanted.stress,
                     file.time, reference.time});
    }
  return all;
}

// Node and time of the reference's largest von Mises stress.
std::pair<Eigen::Index, Eigen::Index> peak(const CompareSettings& settings, const Matched& set) {
  const Eigen::MatrixXd von_mises = recovery::von_mises(set.reference);
  const Eigen::Index time =
      peak_within(settings, set.reference_time, von_mises.colwise().maxCoeff().transpose());
  Eigen::Index node = 0;
  von_mises.col(time).maxCoeff(&node);
  return {node, time};
}

// The peak node at the time of the comparison, then those asked for.
std::vector<Eigen::Index> shown_nodes(const CompareSettings& settings, const Matched& set,
                                      Eigen::Index first) {
  std::vector<Eigen::Index> nodes = {first};
  const auto wanted = settings.node.find(set.name.substr(0, set.name.find(' ')));
  if (wanted == settings.node.end()) return nodes;
  for (const double number : wanted->second) {
    const auto found = std::find(set.node.begin(), set.node.end(), number);
    if (found != set.node.end()) nodes.push_back(found - set.node.begin());
  }
  return nodes;
}

// A node may be in one of several sets of its body.
void require_nodes(const Options& options, const CompareSettings& settings,
                   const std::vector<Matched>& sets) {
  for (const auto& [body, numbers] : settings.node)
    for (const double number : numbers) {
      const bool found = std::any_of(sets.begin(), sets.end(), [&, &body = body](const Matched& set) {
        return set.name.starts_with(body + " ") &&
               std::find(set.node.begin(), set.node.end(), number) != set.node.end();
      });
      require(found, options.label("node_" + body), " = ", number, ": the reference has no such node of ",
              body, " in the sets that are compared");
    }
}

Table stress_table(const std::string& title) {
  Table table{title, "nodes", {}, {}, {}};
  for (const int i : kPaperOrder) table.columns.push_back({kMeasures[static_cast<std::size_t>(i)], "%"});
  table.columns.push_back({"reference", "MPa"});
  return table;
}

void add_row(Table& table, const std::string& name, const recovery::StressMeasures& share, double von_mises) {
  Eigen::VectorXd row(share.size() + 1);
  row << kPercent * share(Eigen::Map<const Eigen::Array<int, 8, 1>>(kPaperOrder)), kPerMega * von_mises;
  table.add(name, row);
}

void add_rows(std::vector<Table>& tables, const std::string& name, const Eigen::VectorXd& stress,
              const Eigen::VectorXd& reference) {
  const recovery::StressDeviation deviation = recovery::stress_deviation(stress, reference);
  const double von_mises = recovery::von_mises(Eigen::MatrixXd(reference)).maxCoeff();
  add_row(tables[0], name, deviation.relative, von_mises);
  add_row(tables[1], name, deviation.of_von_mises, von_mises);
}

std::string node_name(const Matched& set, Eigen::Index i) {
  return set.name + " node " + std::to_string(set.node[static_cast<std::size_t>(i)]);
}

// Stresses of one set at one time.
void add_set(const CompareSettings& settings, const Matched& set, std::vector<Table>& tables) {
  const auto [unused, step] = peak(settings, set);
  const Moment when = moment(settings, set.time, set.reference_time, set.reference_time[step]);
  const Eigen::VectorXd stress = set.at(when.time), reference = set.reference_at(when.reference_time);
  Eigen::Index first = 0;
  recovery::von_mises(Eigen::MatrixXd(reference)).col(0).maxCoeff(&first);
  for (const Eigen::Index i : shown_nodes(settings, set, first))
    add_rows(tables, node_name(set, i), stress.segment<6>(6 * i), reference.segment<6>(6 * i));
  add_rows(tables, set.name + " all " + std::to_string(set.node.size()), stress, reference);
}

void add_signal(Table& table, const std::string& name, const Eigen::VectorXd& time, const Eigen::VectorXd& a,
                const Eigen::VectorXd& b) {
  const recovery::SignalDeviation d = recovery::signal_deviation(time, a, b);
  Eigen::VectorXd row(5);
  row << kPercent * d.l2, kPerMega * d.peak.value, kPerMega * d.reference_peak.value, d.peak.time,
      d.reference_peak.time;
  table.add(name, row);
}

// Histories of one set's nodes over the common times.
void add_signals(const CompareSettings& settings, const Matched& set, Table& table) {
  const Eigen::VectorXd time = common_times(settings, set.time, set.reference_time, set.reference_time[0],
                                            set.reference_time[set.reference_time.size() - 1]);
  if (time.size() == 0) return;
  for (const Eigen::Index i : shown_nodes(settings, set, peak(settings, set).first)) {
    const auto rows = [&](const Eigen::VectorXd& t, const Eigen::MatrixXd& stress) -> Eigen::MatrixXd {
      const Eigen::MatrixXd sigma = recovery::at_times(t, stress.middleRows(6 * i, 6), time);
      Eigen::MatrixXd all(8, time.size());
      all << sigma, recovery::von_mises(sigma), recovery::rankine(sigma);
      return all;
    };
    const Eigen::MatrixXd a = rows(set.time, set.stress), b = rows(set.reference_time, set.reference);
    for (const int m : kPaperOrder)
      add_signal(table, node_name(set, i) + " " + kMeasures[static_cast<std::size_t>(m)], time, a.row(m),
                 b.row(m));
  }
}

}  // namespace

std::vector<Table> compare_stresses(const Options& options, const std::string& path,
                                    const std::string& reference_path) {
  const io::StressFile file = io::read_stress(path), reference = io::read_stress(reference_path);
  std::vector<std::string> bodies;
  for (const io::StressSet& set : reference.sets) bodies.push_back(set.body);
  options.reject_unknown({{"body", bodies}});
  const CompareSettings settings = compare_settings(options);
  const std::vector<Matched> sets = matched_sets(settings, file, reference);
  require(!sets.empty(), path, " and ", reference_path, " have no stresses at the same set of the same body");
  require_nodes(options, settings, sets);
  std::vector<Table> tables = {stress_table("Deviation of the stress, of each measure"),
                               stress_table("Deviation of the stress, of the reference's von Mises stress")};
  Table signals{"Stress over time",
                "signal",
                {{"L2", "%"}, {"peak", "MPa"}, {"reference", "MPa"}, {"peak at", "s"}, {"reference at", "s"}},
                {},
                {}};
  for (const Matched& set : sets) {
    add_set(settings, set, tables);
    add_signals(settings, set, signals);
  }
  if (!signals.rows.empty()) tables.push_back(signals);
  return tables;
}

}  // namespace elastogear::app
