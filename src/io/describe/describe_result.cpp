#include "io/describe/describe_result.h"

#include <set>

#include "elastogear/base/text.h"

#include "elastogear/io/evaluation_file.h"
#include "elastogear/io/result_file.h"
#include "elastogear/io/stress_file.h"
#include "io/hdf5/schema.h"
#include "io/result/contact_forces.h"

namespace elastogear::io {
namespace {

void describe_pair(Out& out, const std::string& path, const std::string& name, const Eigen::VectorXd& time,
                   const TimeAxis& axis) {
  const PairHistory history = read_pair_history(path, name);
  line(out, "contact ", name, ": ", counted(history.group_name[0].size(), "group"), " and ",
       counted(history.group_name[1].size(), "group"));
  Eigen::Index at = 0;
  const double peak = history.force.colwise().norm().maxCoeff(&at);
  line(out, "  peak force: ", peak, " N at ", axis.at(time[at]));
  line(out, "  most contacts: ", history.count.maxCoeff(),
       ", largest penetration: ", history.penetration.maxCoeff(), " m");
}

// Says how many nodes of a body carry contact forces, for results of versions that hold these.
void describe_forces(Out& out, const h5::File& file, const std::string& body) {
  const std::string group = "/bodies/" + body + kForces;
  if (version(file) < kFirstWithForces || h5::shape(file, group + "/node")[0] == 0) return;
  const auto node = h5::read<int>(file, group + "/node", {h5::kAny});
  const Eigen::Matrix3Xd f_B = read_points(file, group + "/force");
  line(out, "  touched at ", counted(std::set<int>(node.begin(), node.end()).size(), "surface node"),
       ", largest contact force on one: ", f_B.colwise().norm().maxCoeff(), " N");
}

void describe_energies(Out& out, const EnergyHistory& energy) {
  const auto last = energy.balance.size() - 1;
  line(out, "energy at the start: ", energy.kinetic[0], " J kinetic, ", energy.elastic[0], " J elastic, ",
       energy.contact[0], " J contact");
  line(out, "energy at the end: ", energy.kinetic[last], " J kinetic, ", energy.elastic[last], " J elastic, ",
       energy.contact[last], " J contact, ", energy.dissipated[last], " J dissipated, ", energy.work[last],
       " J work of loads");
  line(out, "energy balance: at most ", energy.balance.cwiseAbs().maxCoeff(), " J off");
}

// At the time `step` of the largest von Mises stress, Pa; see docs/theory, section 4.3.
void describe_error(Out& out, const StressSet& set, double peak, Eigen::Index step) {
  if (set.error.size() == 0) return line(out, "  estimated error of the reduction: none in the file");
  const double error = set.peak_error[step], share = peak > 0 ? 100 * error / peak : 0;
  line(out, "  estimated error of the reduction: ", error, " Pa of the peak (", share, " %), at most ",
       set.error.maxCoeff(), " Pa at one node");
}

// The estimated error by `cause` in the largest stress: docs/theory, sections 1.7, 4.6
// and 4.7.
void describe_error_by(Out& out, const char* cause, const StressSet& set, const Eigen::MatrixXd& error_by,
                       Eigen::Index node, Eigen::Index step) {
  if (error_by.size() == 0) return line(out, "  estimated error of ", cause, ": none in the file");
  const double error = error_by(node, step), peak = set.von_mises(node, step);
  line(out, "  estimated error of ", cause, ": ", error, " Pa of the peak (",
       peak > 0 ? 100 * error / peak : 0, " %), at most ", error_by.maxCoeff(), " Pa at one node");
}

void describe_times(Out& out, const std::string& path, const Eigen::VectorXd& time, const TimeAxis& axis) {
  require(time.size() > 0, path, ": holds no times");
  line(out, axis.name, "s: ", time.size(), " from ", time[0], " to ", time[time.size() - 1],
       axis.unit == "1" ? "" : " " + axis.unit);
}

}  // namespace

void describe_result(Out& out, const std::string& path) {
  const model::ResultHeader header = read_result_header(path);
  const Eigen::VectorXd time = read_times(path);
  const TimeAxis axis = time_axis(header.input);
  describe_times(out, path, time, axis);
  if (!is_complete(path)) line(out, "incomplete: the run has not reached its end");
  const h5::File file = open_format(path, kResultFormat);
  for (const auto& body : header.bodies) {
    const h5::Shape q = h5::shape(file, "/bodies/" + body.name + "/q");
    line(out, "body ", body.name, ": ", body.file, ", joint ", body.joint, ", ",
         counted(q.back(), "elastic coordinate"));
    describe_forces(out, file, body.name);
  }
  for (const auto& pair : header.pairs) describe_pair(out, path, pair.name, time, axis);
  for (const std::string& name : header.bushings) {
    const BushingHistory history = read_bushing_history(path, name);
    line(out, "bushing ", name, ": peak force ", history.force.colwise().norm().maxCoeff(),
         " N, peak torque ", history.torque.colwise().norm().maxCoeff(), " N m");
  }
  for (const std::string& name : header.sensors) line(out, "sensor ", name);
  describe_energies(out, read_energies(path));
  describe_map(out, header.provenance);
}

void describe_evaluation(Out& out, const std::string& path) {
  const EvaluationFile evaluation = read_evaluation(path);
  for (const EvaluationItem& item : evaluation.items) {
    const std::string unit = item.unit == "1" ? "" : " " + item.unit;
    if (!item.words.empty())
      line(out, item.path, ": ", join(item.words));
    else if (item.shape.empty())
      line(out, item.path, ": ", item.value[0], unit, " (", item.meaning, ")");
    else
      line(out, item.path, ": ", join(item.shape, " x ", [](std::size_t n) { return std::to_string(n); }),
           " numbers", unit.empty() ? "" : " in", unit);
  }
  describe_map(out, evaluation.provenance);
}

void describe_stress(Out& out, const std::string& path) {
  const StressFile history = read_stress(path);
  const TimeAxis axis = time_axis(history.input);
  describe_times(out, path, history.time, axis);
  for (const StressSet& set : history.sets) {
    line(out, "stress of ", set.body, "/", set.set, ": ", counted(set.node.size(), "node"), ", body frame");
    if (set.node.empty()) continue;
    Eigen::Index node = 0, step = 0;
    const double peak = set.von_mises.maxCoeff(&node, &step);
    line(out, "  peak von Mises: ", peak, " Pa at node ", set.node[node], ", ", axis.at(history.time[step]));
    describe_error(out, set, peak, step);
    describe_error_by(out, "the mesh", set, set.mesh_error, node, step);
    describe_error_by(out, "the contact's resolution", set, set.contact_error, node, step);
    describe_error_by(out, "the steps in time", set, set.time_error, node, step);
    const double tension = set.rankine.maxCoeff(&node, &step);
    line(out, "  peak Rankine: ", tension, " Pa at node ", set.node[node], ", ", axis.at(history.time[step]));
  }
  describe_map(out, history.provenance);
}

void describe_life(Out& out, const std::string& path) {
  const h5::File file = open_format(path, kLifeFormat);
  line(out, "duty cycle: ", counted(h5::shape(file, "/duty_cycle/torque")[0], "block"), ", ",
       read_vector(file, "/duty_cycle/revolutions").sum(), " revolutions of the first gear");
  for (const std::string& body : h5::members(file, "/")) {
    if (body == "duty_cycle" || body == "provenance") continue;
    const std::string of_body = "/" + body;
    for (const std::string& set : h5::members(file, of_body)) {
      const std::string group = std::string(of_body).append("/").append(set);
      const Eigen::VectorXd damage = read_vector(file, group + "/damage");
      line(out, "damage of ", body, "/", set, ": ", counted(damage.size(), "node"), ", largest ",
           damage.maxCoeff(), " at node ", h5::number_attribute(file, group + "/critical", "node"));
    }
  }
  describe_map(out, h5::read_map(file, "/provenance"));
}

void describe_wear(Out& out, const std::string& path) {
  const h5::File file = open_format(path, kWearFormat);
  const Eigen::VectorXd revolutions = read_vector(file, "/revolutions");
  line(out, "wear over ", revolutions.tail<1>()[0], " revolutions of the first gear, ",
       counted(revolutions.size() - 1, "step"));
  for (const std::string& body : h5::members(file, "/")) {
    if (body == "revolutions" || body == "provenance") continue;
    line(out, "wear of ", body, ": largest depth ",
         read_vector(file, "/" + body + "/largest_depth").tail<1>()[0], " m, mass ",
         read_vector(file, "/" + body + "/mass").tail<1>()[0], " kg");
  }
  describe_map(out, h5::read_map(file, "/provenance"));
}

}  // namespace elastogear::io
