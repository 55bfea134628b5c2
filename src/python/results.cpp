#include "python/results.h"

#include <pybind11/stl.h>

#include <optional>
#include <utility>

#include "elastogear/base/error.h"
#include "elastogear/base/text.h"
#include "elastogear/io/body_file.h"
#include "elastogear/io/evaluation_file.h"
#include "elastogear/io/result_file.h"
#include "elastogear/io/stress_file.h"
#include "elastogear/recovery/stress.h"
#include "python/arrays.h"
#include "python/runtime.h"
#include "python/state.h"

namespace elastogear::python {
namespace {

// Name and unit of the times of a file.
py::tuple time_axis(const std::optional<model::RunInput>& input) {
  const io::TimeAxis axis = io::time_axis(input);
  return py::make_tuple(axis.name, axis.unit);
}

py::dict result_header(const std::string& path) {
  const Work work;
  const model::ResultHeader header = io::read_result_header(path);
  py::dict all;
  py::list bodies, pairs;
  for (const auto& body : header.bodies) bodies.append(py::make_tuple(body.name, body.joint, body.file));
  for (const auto& pair : header.pairs) pairs.append(pair.name);
  all["bodies"] = bodies;
  all["pairs"] = pairs;
  all["bushings"] = header.bushings;
  all["sensors"] = header.sensors;
  all["provenance"] = header.provenance;
  all["complete"] = io::is_complete(path);
  all["time"] = vector(io::read_times(path));
  all["time_axis"] = time_axis(header.input);
  return all;
}

py::dict body_history(const std::string& path, const std::string& body) {
  const Work work;
  io::BodyHistory h = io::read_body_history(path, body);
  py::dict all;
  all["position"] = history(std::move(h.r_WB), {3});
  all["rotation"] = history(std::move(h.R_WB), {3, 3});
  all["s"] = history(std::move(h.s));
  all["s_dot"] = history(std::move(h.s_dot));
  all["s_ddot"] = history(std::move(h.s_ddot));
  all["q"] = history(std::move(h.q));
  all["q_dot"] = history(std::move(h.q_dot));
  all["q_ddot"] = history(std::move(h.q_ddot));
  const bool has_error = h.q_error.size() > 0;
  all["q_error"] = has_error ? py::object(history(std::move(h.q_error))) : py::none();
  return all;
}

py::dict pair_history(const std::string& path, const std::string& pair) {
  const Work work;
  io::PairHistory h = io::read_pair_history(path, pair);
  py::dict all, groups;
  all["force"] = history(std::move(h.force), {3});
  all["torque"] = history(std::move(h.torque), {3});
  const Shape n{h.count.size()};
  all["count"] = owning_view(std::move(h.count), n);
  all["penetration"] = vector(std::move(h.penetration));
  all["area"] = vector(std::move(h.area));
  all["pressure"] = vector(std::move(h.pressure));
  all["sliding_speed"] = vector(std::move(h.sliding_speed));
  all["friction_power"] = vector(std::move(h.friction_power));
  all["damping_power"] = vector(std::move(h.damping_power));
  for (int side : {0, 1})
    for (std::size_t g = 0; g < h.group_name[side].size(); ++g) {
      const auto row = static_cast<Eigen::Index>(3 * g);
      if (h.group_force[side].rows() >= row + 3)
        groups[py::str(h.group_name[side][g])] =
            history(Eigen::MatrixXd(h.group_force[side].middleRows(row, 3)), {3});
    }
  all["group_force"] = groups;
  return all;
}

py::dict energies(const std::string& path) {
  const Work work;
  io::EnergyHistory h = io::read_energies(path);
  py::dict all;
  all["kinetic"] = vector(std::move(h.kinetic));
  all["elastic"] = vector(std::move(h.elastic));
  all["contact"] = vector(std::move(h.contact));
  all["bushing"] = vector(std::move(h.bushing));
  all["dissipated"] = vector(std::move(h.dissipated));
  all["work"] = vector(std::move(h.work));
  all["balance"] = vector(std::move(h.balance));
  return all;
}

py::list contacts(const std::string& path, const std::string& pair) {
  const Work work;
  const py::dtype type = contact_dtype();
  py::list all;
  for (std::vector<model::ContactRecord>& records : io::read_contacts(path, pair)) {
    auto* kept = new std::vector<model::ContactRecord>(std::move(records));
    const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<model::ContactRecord>*>(p); });
    all.append(py::array(type, {static_cast<py::ssize_t>(kept->size())}, {}, kept->data(), owner));
  }
  return all;
}

py::dict sensor_history(const std::string& path, const std::string& sensor) {
  const Work work;
  io::SensorHistory h = io::read_sensor_history(path, sensor);
  py::dict all;
  all["position"] = history(std::move(h.position), {3});
  all["velocity"] = history(std::move(h.velocity), {3});
  all["acceleration"] = history(std::move(h.acceleration), {3});
  all["rotation"] = history(std::move(h.rotation), {3, 3});
  all["angular_velocity"] = history(std::move(h.angular_velocity), {3});
  return all;
}

py::dict stress_set(io::StressSet&& set) {
  py::dict all;
  all["body"] = set.body;
  all["set"] = set.set;
  const Shape n{static_cast<py::ssize_t>(set.node.size())};
  const bool has_error = set.error.size() > 0, has_peak = set.peak_error.size() > 0,
             has_mesh_error = set.mesh_error.size() > 0, has_contact_error = set.contact_error.size() > 0,
             has_time_error = set.time_error.size() > 0;
  all["node"] = owning_view(std::move(set.node), n);
  all["stress"] = history(std::move(set.stress), {6});
  all["von_mises"] = history(std::move(set.von_mises));
  all["rankine"] = history(std::move(set.rankine));
  const Shape of_points{set.X.cols(), 3};
  all["X"] = owning_view(std::move(set.X), of_points);
  all["error"] = has_error ? py::object(history(std::move(set.error))) : py::none();
  all["peak_error"] = has_peak ? py::object(vector(std::move(set.peak_error))) : py::none();
  all["mesh_error"] = has_mesh_error ? py::object(history(std::move(set.mesh_error))) : py::none();
  all["contact_error"] = has_contact_error ? py::object(history(std::move(set.contact_error))) : py::none();
  all["time_error"] = has_time_error ? py::object(history(std::move(set.time_error))) : py::none();
  return all;
}

// A set with one node would lose its index of nodes.
py::dict read_stress(const std::string& path) {
  const Work work;
  io::StressFile file = io::read_stress(path);
  py::dict all;
  py::list sets;
  for (io::StressSet& set : file.sets) sets.append(stress_set(std::move(set)));
  all["time"] = vector(std::move(file.time));
  all["sets"] = sets;
  all["provenance"] = file.provenance;
  all["time_axis"] = time_axis(file.input);
  return all;
}

// A number, an array, or a list of words.
py::object value_of(io::EvaluationItem&& item) {
  if (!item.words.empty()) return py::cast(item.words);
  if (item.shape.empty() && item.value.size() == 1) return py::float_(item.value[0]);
  const Shape shape(item.shape.begin(), item.shape.end());
  return owning_view(std::move(item.value), shape);
}

py::dict read_evaluation(const std::string& path) {
  const Work work;
  io::EvaluationFile file = io::read_evaluation(path);
  py::dict items, all;
  for (io::EvaluationItem& item : file.items) {
    const py::str name(item.path), unit(item.unit), meaning(item.meaning);
    items[name] = py::make_tuple(value_of(std::move(item)), unit, meaning);
  }
  all["items"] = items;
  all["provenance"] = file.provenance;
  return all;
}

/// A body file, for stresses of given coordinates.
struct Body {
  explicit Body(const std::string& file) : path(file) {
    const Work work;
    body = std::make_shared<model::ElasticBody>(io::read_body(file));
  }

  const std::vector<int>& members(const std::string& set) const {
    const auto found = body->stress.sets.find(set);
    std::vector<std::string> known;
    for (const auto& [name, nodes] : body->stress.sets) known.push_back(name);
    require(found != body->stress.sets.end(), path, ": has no set '", set,
            "' of stress nodes; it has: ", join(known));
    return found->second;
  }

  py::array stress(const std::string& set, const py::object& q) const {
    require(body->relaxing.empty(), path,
            ": is viscoelastic, and its stress depends on its history: recover takes that from the result");
    const std::vector<int>& nodes = members(set);
    const py::array_t<double> x = numbers_of(q, 1, "q");
    require(x.size() == body->n_q(), "q: has ", x.size(), " numbers, the body has ", body->n_q(),
            " elastic coordinates");
    Eigen::MatrixXd sigma =
        recovery::modal_stress(body->stress, nodes, Eigen::Map<const Eigen::VectorXd>(x.data(), x.size()));
    const Shape shape{sigma.rows() / 6, 6};
    return owning_view(std::move(sigma), shape);
  }

  std::string path;
  std::shared_ptr<const model::ElasticBody> body;
};

void bind_body_file(py::module_& module) {
  const auto names = [](const Body& b) {
    std::vector<std::string> all;
    for (const auto& [name, nodes] : b.body->stress.sets) all.push_back(name);
    return all;
  };
  py::class_<Body>(module, "Body", "A reduced body, from its file.")
      .def(py::init<const std::string&>(), py::arg("path"))
      .def_readonly("path", &Body::path)
      .def_property_readonly("name", [](const Body& b) { return b.body->name; })
      .def_property_readonly(
          "n_modes", [](const Body& b) { return b.body->n_q(); }, "number of elastic coordinates")
      .def_property_readonly(
          "mass", [](const Body& b) { return b.body->inertia.m; }, "kg")
      .def_property_readonly(
          "frequencies",
          [](const py::object& self) {
            const Eigen::VectorXd& f = self.cast<const Body&>().body->frequency;
            return view(f.data(), {f.size()}, self);
          },
          "(n_modes,), Hz, ascending; empty for the full basis")
      .def_property_readonly(
          "surface",
          [](const py::object& self) {
            const Eigen::Matrix3Xd& X = self.cast<const Body&>().body->surface.X;
            return view(X.data(), {X.cols(), 3}, self);
          },
          "(n_s, 3), m, nodes of the contact surface, body frame")
      .def_property_readonly("stress_sets", names, "names of the sets of nodes that have stresses")
      .def("stress", &Body::stress, py::arg("set"), py::arg("q"),
           "Stress of the elastic coordinates q (n_modes,) at the nodes of a set: (n, 6), Pa, xx yy zz xy yz "
           "xz, "
           "body frame; of the modes alone, Eq. (4.1).");
}

}  // namespace

void bind_results(py::module_& module) {
  const auto path = py::arg("path");
  module.def("read_result_header", result_header, path);
  module.def("read_body_history", body_history, path, py::arg("body"));
  module.def("read_pair_history", pair_history, path, py::arg("pair"));
  module.def("read_energies", energies, path);
  module.def("read_contacts", contacts, path, py::arg("pair"));
  module.def("read_sensor_history", sensor_history, path, py::arg("sensor"));
  module.def("read_stress", read_stress, path);
  module.def("read_evaluation", read_evaluation, path);
  module.def(
      "von_mises",
      [](const py::object& stress) {
        const py::array_t<double> x = numbers_of(stress, 2, "stress");
        require(x.shape(1) == 6, "stress: must have the shape (n, 6), not (n, ", x.shape(1), ")");
        const Eigen::Map<const Eigen::MatrixXd> columns(x.data(), 6, x.shape(0));
        return vector(Eigen::VectorXd(recovery::von_mises(Eigen::MatrixXd(columns)).transpose()));
      },
      py::arg("stress"), "Equivalent stresses (n,) of stresses (n, 6), Pa. Eq. (4.2).");
  bind_body_file(module);
}

}  // namespace elastogear::python
