#include "app/verbs/recover_tables.h"

#include <algorithm>
#include <cstdio>

#include "app/console/console.h"
#include "app/console/plausibility.h"
#include "elastogear/io/csv.h"

namespace elastogear::app {
namespace {

constexpr int kSmallSet = 10;  // nodes; of larger sets only the nodes of the largest stresses go to CSV

struct Position {
  Eigen::Index node = 0, time = 0;
};

Position peak(const Eigen::MatrixXd& history) {
  Position at;
  if (history.size() > 0) history.maxCoeff(&at.node, &at.time);
  return at;
}

constexpr double kTrusted = 0.05;     // of the peak
constexpr double kTrustedMesh = 0.1;  // the same, of the mesh's error

// Advice for stresses whose estimated error is too large.
std::string remedy(const recovery::RecoveredBody& body) {
  if (body.relaxes() && !body.response)
    return "the body is viscoelastic; reduce it with -basis modal_residual, or compare with -basis full";
  const bool untouched = body.reference && body.reference->node.empty();
  if (!body.response && !untouched)
    return "reduce the body with -basis modal_residual, loaded wherever it is touched (option loaded; by "
           "default "
           "everywhere)";
  return "reduce the body with more modes (-modes)";
}

void print_error(const recovery::RecoveredBody& body, const io::StressSet& set) {
  const auto [node, step] = peak(set.von_mises);
  if (set.error.size() == 0)
    return print_item("", "error of the reduction not estimated: not to be trusted; " + remedy(body));
  const double share = set.peak_error[step] / std::max(set.von_mises(node, step), 1e-300);
  print_item("", "estimated error of the reduction " + with_unit(1e-6 * set.peak_error[step], "MPa") + ", " +
                     percent(share));
  if (share > kTrusted)
    print_item("warning", set.body + " " + set.set + ": not to be trusted; " + remedy(body));
}

// Estimated error of the largest stress by one cause.
void print_error_by(const std::string& cause, const io::StressSet& set, const Eigen::MatrixXd& error_by) {
  if (error_by.size() == 0) return print_item("", "error of " + cause + " not estimated");
  const auto [node, step] = peak(set.von_mises);
  const double error = error_by(node, step);
  print_item("", "estimated error of " + cause + " " + with_unit(1e-6 * error, "MPa") + ", " +
                     percent(error / std::max(set.von_mises(node, step), 1e-300)));
}

// The sum of the estimates that there are, at the largest stress.
void print_whole_error(const io::StressSet& set) {
  if (set.error.size() == 0 || set.mesh_error.size() == 0) return;
  const auto [node, step] = peak(set.von_mises);
  const double whole = set.peak_error[step] + set.mesh_error(node, step) +
                       (set.contact_error.size() > 0 ? set.contact_error(node, step) : 0) +
                       (set.time_error.size() > 0 ? set.time_error(node, step) : 0);
  print_item("", "all together " + with_unit(1e-6 * whole, "MPa") + ", " +
                     percent(whole / std::max(set.von_mises(node, step), 1e-300)));
}

void warn_above(const io::StressSet& set, const Eigen::MatrixXd& error_by, const std::string& warning) {
  if (error_by.size() == 0) return;
  const auto [node, step] = peak(set.von_mises);
  if (error_by(node, step) > kTrustedMesh * set.von_mises(node, step))
    print_item("warning", set.body + " " + set.set + ": " + warning);
}

// Steps in time leave no error where nothing moves.
void print_other_errors(const recovery::RecoveredBody& body, const io::StressSet& set) {
  const bool moves = (body.run.history.q_dot.array() != 0).any();
  print_error_by("the mesh", set, set.mesh_error);
  print_error_by("the contact's resolution", set, set.contact_error);
  if (moves || set.time_error.size() > 0) print_error_by("the steps in time", set, set.time_error);
  print_whole_error(set);
  warn_above(
      set, set.mesh_error,
      "too coarse a mesh for this stress; take a finer one there (of gear data by -refinement), or elements "
      "of second order in place of first (-element_order 2)");
  warn_above(set, set.contact_error,
             "this stress lies beside a contact that faces there are too wide to resolve; take those of the "
             "root's other nodes, or a finer mesh there (of gear data by -refinement)");
  warn_above(set, set.time_error,
             "too long steps for this stress; take shorter ones by a smaller step_error, or a smaller ts_dt "
             "where that is given");
}

std::string peak_text(const io::StressSet& set, const Eigen::MatrixXd& history, const StressTimes& times) {
  const auto [node, step] = peak(history);
  return with_unit(1e-6 * history(node, step), "MPa") + " at node " + std::to_string(set.node[node]) + ", " +
         times.axis.at(times.time[step]);
}

void add_columns(std::vector<io::CsvColumn>& columns, const io::StressSet& set, Eigen::Index node) {
  const char* components[] = {"xx", "yy", "zz", "xy", "yz", "xz"};
  const std::string suffix = " node " + std::to_string(set.node[node]);
  for (int c = 0; c < 6; ++c) columns.push_back({components[c] + suffix, "Pa", set.stress.row(6 * node + c)});
  columns.push_back({"von_mises" + suffix, "Pa", set.von_mises.row(node)});
  columns.push_back({"rankine" + suffix, "Pa", set.rankine.row(node)});
  if (set.error.size() > 0) columns.push_back({"error of von_mises" + suffix, "Pa", set.error.row(node)});
  if (set.mesh_error.size() > 0)
    columns.push_back({"error of von_mises by the mesh" + suffix, "Pa", set.mesh_error.row(node)});
  if (set.contact_error.size() > 0)
    columns.push_back({"error of von_mises by contact" + suffix, "Pa", set.contact_error.row(node)});
  if (set.time_error.size() > 0)
    columns.push_back({"error of von_mises by steps" + suffix, "Pa", set.time_error.row(node)});
}

}  // namespace

void print_stress(const recovery::RecoveredBody& body, const io::StressSet& set, const StressTimes& times) {
  print_item(set.body + " " + set.set, "peak von Mises " + peak_text(set, set.von_mises, times));
  print_error(body, set);
  print_other_errors(body, set);
  print_item("", "largest tension (Rankine) " + peak_text(set, set.rankine, times));
  warn_of_strain(set, body.run.file);
}

void write_table(const std::string& path, const io::StressSet& set, const StressTimes& times, bool all) {
  std::vector<io::CsvColumn> columns = {{times.axis.name, times.axis.unit, times.time}};
  if (all || set.node.size() <= kSmallSet) {
    for (std::size_t node = 0; node < set.node.size(); ++node) add_columns(columns, set, node);
  } else {
    const Eigen::Index node = peak(set.von_mises).node, stretched = peak(set.rankine).node;
    add_columns(columns, set, node);
    if (stretched != node) add_columns(columns, set, stretched);
  }
  io::write_csv(path, columns);
}

}  // namespace elastogear::app
