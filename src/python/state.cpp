#include "python/state.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "elastogear/base/error.h"
#include "elastogear/base/text.h"
#include "python/arrays.h"

namespace elastogear::python {
namespace {

/// A part of a snapshot, and the object of Python that keeps the snapshot.
template <class Part>
struct PartView {
  py::object owner;
  const Part* part;
  std::string name;
};

template <class Part>
PartView<Part> part_of(const py::object& state, const std::vector<Part>& parts,
                       const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  require(found != names.end(), "there is no '", name, "'; there are: ", join(names));
  const auto i = static_cast<std::size_t>(found - names.begin());
  return {state, &parts.at(i), name};
}

template <class Part>
py::dict all_parts(const py::object& state, const std::vector<Part>& parts,
                   const std::vector<std::string>& names) {
  py::dict all;
  for (std::size_t i = 0; i < parts.size(); ++i)
    all[py::str(names[i])] = py::cast(PartView<Part>{state, &parts[i], names[i]});
  return all;
}

// Shape of a vector or matrix of Eigen; matrices of a fixed size are stored by columns, and are symmetric
// here or transposed by the caller.
template <class Part, class Vector>
void def_vector(py::class_<PartView<Part>>& type, const char* name, Vector Part::*member, const char* doc) {
  type.def_property_readonly(
      name,
      [member](const PartView<Part>& v) {
        const auto& x = v.part->*member;
        return view(x.data(), {x.size()}, v.owner);
      },
      doc);
}

template <class Part>
void def_rotation(py::class_<PartView<Part>>& type, const char* name, Eigen::Matrix3d Part::*member,
                  const char* doc) {
  type.def_property_readonly(
      name,
      [member](const PartView<Part>& v) {
        return py::object(view((v.part->*member).data(), {3, 3}, v.owner).attr("T"));  // by columns
      },
      doc);
}

template <class Part, class Value>
void def_value(py::class_<PartView<Part>>& type, const char* name, Value Part::*member, const char* doc) {
  type.def_property_readonly(
      name, [member](const PartView<Part>& v) { return v.part->*member; }, doc);
}

void bind_body(py::module_& module) {
  using model::BodyState;
  py::class_<PartView<BodyState>> type(module, "BodyState", "Motion of one body.");
  def_vector(type, "position", &BodyState::r_WB, "(3,), m, origin of the body frame in the world");
  def_rotation(type, "rotation", &BodyState::R_WB, "(3, 3), -, from the body frame to the world");
  def_vector(type, "s", &BodyState::s, "(n_s,), rad or m, joint coordinates");
  def_vector(type, "s_dot", &BodyState::s_dot, "(n_s,), rad/s or m/s");
  def_vector(type, "s_ddot", &BodyState::s_ddot, "(n_s,), rad/s^2 or m/s^2");
  def_vector(type, "q", &BodyState::q, "(n_q,), elastic coordinates");
  def_vector(type, "q_dot", &BodyState::q_dot, "(n_q,), 1/s");
  def_vector(type, "q_ddot", &BodyState::q_ddot, "(n_q,), 1/s^2");
  def_vector(type, "joint_force", &BodyState::joint_force,
             "(n_s,), N or N m, of load, friction and drive along the joint coordinates");
  type.def_property_readonly(
      "contact_nodes",
      [](const PartView<BodyState>& v) {
        const std::vector<int>& node = v.part->contact.node;
        return view(node.data(), {static_cast<py::ssize_t>(node.size())}, v.owner);
      },
      "(n,), surface nodes that are touched, numbers in the surface");
  type.def_property_readonly(
      "contact_forces",
      [](const PartView<BodyState>& v) {
        const Eigen::Matrix3Xd& f = v.part->contact.f_B;
        return view(f.data(), {f.cols(), 3}, v.owner);
      },
      "(n, 3), N, sums of the contact forces at these nodes, body frame");
}

void bind_pair(py::module_& module) {
  using model::PairState;
  py::class_<PartView<PairState>> type(module, "PairState", "Contact of one pair a:b.");
  def_vector(type, "force", &PairState::force, "(3,), N, on body b, in the world");
  def_vector(type, "torque", &PairState::torque, "(3,), N m, on body b, about the world's origin");
  def_value(type, "count", &PairState::count, "number of active contacts");
  def_value(type, "penetration", &PairState::penetration, "m, largest");
  type.def_property_readonly(
      "contacts",
      [](const PartView<PairState>& v) {
        const auto& contacts = v.part->contacts;
        py::array array(contact_dtype(), {static_cast<py::ssize_t>(contacts.size())}, {}, contacts.data(),
                        v.owner);
        py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
        return array;
      },
      "(n,), active contacts, a structured array with the fields slave_side, slave_node, face, xi, eta, "
      "gap (m), force (N, on the slave node, world), pressure (Pa), slip (m/s)");
}

void bind_markers(py::module_& module) {
  using model::BushingState, model::LoadState, model::SensorState;
  py::class_<PartView<BushingState>> bushing(module, "BushingState", "A spring and damper of two markers.");
  def_vector(bushing, "displacement", &BushingState::displacement, "(3,), m, along the axes");
  def_vector(bushing, "velocity", &BushingState::velocity, "(3,), m/s");
  def_vector(bushing, "angle", &BushingState::angle, "(3,), rad");
  def_vector(bushing, "rate", &BushingState::rate, "(3,), rad/s");
  def_vector(bushing, "force", &BushingState::force, "(3,), N, on the second marker, in the world");
  def_vector(bushing, "torque", &BushingState::torque, "(3,), N m, on the second marker, in the world");
  py::class_<PartView<LoadState>> load(module, "LoadState", "A load at a marker, in the world.");
  def_vector(load, "force", &LoadState::force, "(3,), N");
  def_vector(load, "torque", &LoadState::torque, "(3,), N m");
  def_vector(load, "position", &LoadState::x, "(3,), m, of the marker");
  def_rotation(load, "rotation", &LoadState::R, "(3, 3), from the marker to the world");
  py::class_<PartView<SensorState>> sensor(module, "SensorState", "Motion of a marker, in the world.");
  def_vector(sensor, "position", &SensorState::position, "(3,), m");
  def_vector(sensor, "velocity", &SensorState::velocity, "(3,), m/s");
  def_vector(sensor, "acceleration", &SensorState::acceleration, "(3,), m/s^2");
  def_rotation(sensor, "rotation", &SensorState::rotation, "(3, 3), from the marker to the world");
  def_vector(sensor, "angular_velocity", &SensorState::angular_velocity, "(3,), rad/s");
}

py::dict energies(const StateView& state) {
  const model::Energies& e = state.snapshot->energy;
  py::dict all;
  all["kinetic"] = e.kinetic;
  all["elastic"] = e.elastic;
  all["contact"] = e.contact;
  all["bushing"] = e.bushing;
  all["dissipated"] = e.dissipated;
  all["work"] = e.work;
  all["balance"] = e.balance;
  return all;
}

template <class Parts>
void def_parts(py::class_<StateView>& type, const char* one, const char* all, Parts model::Snapshot::*member,
               std::vector<std::string> Names::*names, const char* doc) {
  type.def(
      one,
      [member, names](const py::object& self, const std::string& name) {
        const auto& state = self.cast<const StateView&>();
        return part_of(self, (*state.snapshot).*member, (*state.names).*names, name);
      },
      py::arg("name"), doc);
  type.def_property_readonly(
      all,
      [member, names](const py::object& self) {
        const auto& state = self.cast<const StateView&>();
        return all_parts(self, (*state.snapshot).*member, (*state.names).*names);
      },
      "All of these, by name.");
}

}  // namespace

py::dtype contact_dtype() {
  using model::ContactRecord;
  // Offsets of the members, which are those of every compiler that this is built with.
  const ContactRecord r{};
  const auto at = [&r](const auto& member) {
    return static_cast<py::ssize_t>(reinterpret_cast<const char*>(&member) -
                                    reinterpret_cast<const char*>(&r));
  };
  py::list names, formats, offsets;
  const auto add = [&](const char* name, const char* format, py::ssize_t offset) {
    names.append(name);
    formats.append(format);
    offsets.append(offset);
  };
  add("slave_side", "i4", at(r.slave_side));
  add("slave_node", "i4", at(r.slave_node));
  add("face", "i4", at(r.face));
  add("xi", "f8", at(r.xi));
  add("eta", "f8", at(r.eta));
  add("gap", "f8", at(r.g_n));
  add("force", "3f8", at(r.f));
  add("pressure", "f8", at(r.pressure));
  add("slip", "3f8", at(r.slip));
  return {names, formats, offsets, sizeof(ContactRecord)};
}

void bind_state(py::module_& module) {
  bind_body(module);
  bind_pair(module);
  bind_markers(module);
  py::class_<StateView> type(
      module, "State",
      "State of a simulation at one time. Its arrays are views of the simulation's own numbers, cannot be "
      "written to, and stay as they are when the simulation goes on.");
  type.def_property_readonly(
      "time", [](const StateView& s) { return s.snapshot->time; }, "s");
  type.def_property_readonly("energies", energies,
                             "J: kinetic, elastic, contact and bushing are stored; dissipated and work count "
                             "from the start; balance is the error of their sum");
  def_parts(type, "body", "bodies", &model::Snapshot::bodies, &Names::bodies, "Motion of a body.");
  def_parts(type, "pair", "pairs", &model::Snapshot::pairs, &Names::pairs, "Contact of a pair, 'a:b'.");
  def_parts(type, "bushing", "bushings", &model::Snapshot::bushings, &Names::bushings, "A bushing.");
  def_parts(type, "load", "loads", &model::Snapshot::loads, &Names::loads, "A load at a marker.");
  def_parts(type, "sensor", "sensors", &model::Snapshot::sensors, &Names::sensors, "Motion of a sensor.");
}

}  // namespace elastogear::python
