#include "python/simulation.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/console/advice.h"
#include "app/console/outputs.h"
#include "app/verbs/registry.h"
#include "app/verbs/simulation.h"
#include "elastogear/base/error.h"
#include "elastogear/io/result_file.h"
#include "python/arrays.h"
#include "python/state.h"
#include "python/verbs.h"

namespace elastogear::python {
namespace {

/// An object of Python that may be copied and destroyed without the GIL.
std::shared_ptr<py::object> kept(py::object object) {
  return {new py::object(std::move(object)), [](py::object* p) {
            const py::gil_scoped_acquire gil;
            delete p;
          }};
}

std::string type_name(const py::handle& object) {
  return py::str(py::type::handle_of(object).attr("__name__"));
}

dynamics::ForceLaw force_law(const std::string& name, const py::object& function) {
  return [name, f = kept(function)](double t, double s, double s_dot) {
    const py::gil_scoped_acquire gil;
    const py::object result = (*f)(t, s, s_dot);
    const double value = PyFloat_AsDouble(result.ptr());
    if (value == -1 && PyErr_Occurred()) {
      PyErr_Clear();
      fail("the force on '", name, "' must return a number, not ", type_name(result));
    }
    return value;
  };
}

/// Motion of a marker, as a load's function sees it.
py::object marker_motion(const body::MarkerMotion& m) {
  static const auto* const type = new py::object(py::module_::import("types").attr("SimpleNamespace"));
  const auto vector = [](const Eigen::Vector3d& x) {
    return py::array_t<double>(py::ssize_t{3}, x.data());  // a copy
  };
  py::array_t<double> R({3, 3});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R.mutable_at(i, j) = m.R(i, j);
  return (*type)(py::arg("position") = vector(m.x), py::arg("rotation") = R,
                 py::arg("velocity") = vector(m.v), py::arg("angular_velocity") = vector(m.w));
}

dynamics::WrenchLaw wrench_law(const std::string& name, const py::object& function) {
  return [name, f = kept(function)](double t, const body::MarkerMotion& marker) {
    const py::gil_scoped_acquire gil;
    const py::object result = (*f)(t, marker_motion(marker));
    require(PySequence_Check(result.ptr()) && PySequence_Size(result.ptr()) == 2, "the load '", name,
            "' must return (force, torque), not ", type_name(result));
    body::Wrench wrench;
    for (int part : {0, 1}) {
      const py::array_t<double> x = numbers_of(result[py::int_(part)], 1, "the load '" + name + "'");
      require(x.size() == 3, "the load '", name, "' must return three components of ",
              part == 0 ? "force" : "torque", ", not ", x.size());
      wrench.segment<3>(3 * part) = Eigen::Map<const Eigen::Vector3d>(x.data());
    }
    return wrench;
  };
}

app::ProgramLaws laws(const std::vector<std::string>& loads,
                      const std::map<std::string, py::object>& forces) {
  const py::gil_scoped_acquire gil;
  app::ProgramLaws all;
  for (const auto& [name, function] : forces) {
    require(PyCallable_Check(function.ptr()), "the force on '", name, "' must be a function, not ",
            type_name(function));
    if (std::find(loads.begin(), loads.end(), name) != loads.end())
      all.of_loads[name] = wrench_law(name, function);
    else
      all.of_axes[name] = force_law(name, function);
  }
  return all;
}

std::shared_ptr<const Names> names_of(const dynamics::System& system, const model::ResultHeader& header) {
  auto names = std::make_shared<Names>();
  for (const auto& body : header.bodies) names->bodies.push_back(body.name);
  for (const auto& pair : header.pairs) names->pairs.push_back(pair.name);
  names->bushings = header.bushings;
  names->sensors = header.sensors;
  for (const auto& load : system.marker_forces().setups().loads) names->loads.push_back(load.name);
  return names;
}

}  // namespace

/// The objects of the library that a run holds.
struct SteppedRun::Parts {
  OptionDatabase database;
  app::PreparedSimulation prepared = {};
  std::shared_ptr<const Names> names = {};
  std::string output = {};
  std::unique_ptr<app::OutputLock> lock = {};
  std::unique_ptr<io::ResultWriter> writer = {};
  std::unique_ptr<dynamics::Simulation> run = {};
  std::shared_ptr<const model::Snapshot> state = {};  // the last one, for all threads
  Work* work = nullptr;                               // the present one
  Items items = {};                                   // said since they were last taken
  bool failed = false, finished = false;
  dynamics::RunSummary summary = {};

  void finish() {
    if (std::exchange(finished, true)) return;
    summary = run->finish();
    end_output(summary.complete);
  }

  // The file keeps what there is; nothing stays to go on from.
  void end_output(bool complete) {
    if (writer && writer->n_times() > 0) writer->finish(complete);
    if (writer && !complete) std::filesystem::remove_all(output + ".partial");
    writer.reset();
    lock.reset();
  }
};

namespace {

/// While it lives the run works.
class Step {
 public:
  explicit Step(SteppedRun::Parts& parts)
      : work_(Ranks::this_one, &parts.database),
        listener_(work_, py::none(), false),
        embedding_(listener_.embedding()),
        scope_(embedding_),
        parts_(parts) {
    parts_.work = &work_;
  }
  ~Step() {
    parts_.work = nullptr;
    if (parts_.run) parts_.state = parts_.run->state();
    for (auto& item : listener_.items) parts_.items.push_back(std::move(item));
  }

  template <class F>
  void run(F&& f) {
    try {
      work_.without_gil(std::forward<F>(f));
      work_.raise_kept();
    } catch (...) {
      parts_.failed = true;
      parts_.end_output(false);
      throw;
    }
  }

 private:
  Work work_;
  Listener listener_;
  app::Embedding embedding_;
  app::EmbeddingScope scope_;
  SteppedRun::Parts& parts_;
};

}  // namespace

SteppedRun::SteppedRun(const Given& given, const std::map<std::string, py::object>& forces,
                       const std::string& output)
    : parts_(std::make_shared<Parts>()) {
  Parts& p = *parts_;
  Step step(p);
  step.run([&] {
    const std::vector<app::Verb> verbs = app::all_verbs();
    const app::Options options = app::load_options(app::find_verb(verbs, "simulate"), verbs, sources(given));
    p.prepared = app::prepare_simulation(options, [&](const auto& loads) { return laws(loads, forces); });
    p.names = names_of(*p.prepared.system, p.prepared.header);
    if (!output.empty()) {
      app::protect_inputs(options, {{"output", {output}}});
      p.output = output;
      p.lock = std::make_unique<app::OutputLock>(output);
      for (const auto& [name, function] : forces)
        p.prepared.header.provenance["force_on_" + name] = "a program";
      p.writer = std::make_unique<io::ResultWriter>(output, p.prepared.header);
    }
    begin(p);
  });
}

// Sets up and enters the first state.
void SteppedRun::begin(Parts& p) {
  dynamics::Checkpoints checkpoints;
  checkpoints.patience = 0;
  checkpoints.stop = [&p] { return p.work && p.work->interrupts().pending(); };
  const dynamics::Observer write = [&p](const model::Snapshot& snapshot) {
    if (p.writer) p.writer->append(snapshot);
  };
  p.run = std::make_unique<dynamics::Simulation>(*p.prepared.system, p.prepared.time,
                                                 app::guarded(*p.prepared.system, write, p.prepared.time.dt),
                                                 Progress{}, checkpoints);
  p.run->advance();
}

SteppedRun::~SteppedRun() {
  if (parts_) destroy_safely(std::move(parts_));
}

SteppedRun::Parts& SteppedRun::parts() {
  require(parts_ != nullptr, "this simulation is closed");
  return *parts_;
}

SteppedRun::Parts& SteppedRun::unfailed_parts() {
  Parts& p = parts();
  require(!p.failed, "this simulation has ended by an error or an interrupt");
  return p;
}

bool SteppedRun::step() {
  Parts& p = unfailed_parts();
  if (p.finished) return false;
  bool taken = false;
  Step step(p);
  step.run([&] {
    taken = p.run->advance();
    if (p.run->ended()) p.finish();
  });
  return taken;
}

void SteppedRun::run() {
  Parts& p = unfailed_parts();
  if (p.finished) return;
  Step step(p);
  step.run([&] {
    while (p.run->advance()) continue;
    p.finish();
  });
}

bool SteppedRun::ended() { return parts().finished || parts().failed; }

StateView SteppedRun::state() {
  Parts& p = parts();
  require(p.state != nullptr, "this simulation has no state");
  return {p.state, p.names};
}

Items SteppedRun::take_items() { return std::exchange(parts().items, {}); }

const dynamics::RunSummary& SteppedRun::finish() {
  Parts& p = parts();
  if (!p.finished) {
    Step step(p);
    step.run([&] { p.finish(); });
  }
  return p.summary;
}

void SteppedRun::close() { parts_.reset(); }

namespace {

py::dict summary(SteppedRun& run) {
  const dynamics::RunSummary& s = run.finish();
  py::dict all;
  all["steps"] = s.steps;
  all["rejected_steps"] = s.rejected_steps;
  all["newton_iterations"] = s.newton_iterations;
  all["most_contacts"] = s.most_contacts;
  all["initial_energy"] = s.initial_energy;
  all["work"] = s.work;
  all["largest_imbalance"] = s.largest_imbalance;
  all["complete"] = s.complete;
  all["at_rest"] = s.at_rest;
  all["time"] = s.time;
  all["wall_time"] = s.wall_time;
  return all;
}

void close(SteppedRun& run) {
  if (!run.is_open()) return;
  if (!run.ended()) run.finish();
  const Work alone;  // nothing else is at work
  run.close();
}

}  // namespace

void bind_simulation(py::module_& module) {
  py::class_<SteppedRun, std::shared_ptr<SteppedRun>>(module, "SteppedRun",
                                                      "A motion that the program advances step by step.")
      .def(py::init<const Given&, const std::map<std::string, py::object>&, const std::string&>(),
           py::arg("given"), py::arg("forces"), py::arg("output"))
      .def("step", &SteppedRun::step, "Takes a step; False when the end was reached before.")
      .def("run", &SteppedRun::run, "Takes all steps that are left.")
      .def("finish", summary, "Ends the run; its figures: counts, J and s.")
      .def("close", close, "Ends the run and frees its memory.")
      .def("take_items", &SteppedRun::take_items, "What was said since the last call, (name, text) each.")
      .def_property_readonly("state", &SteppedRun::state, "The last state.")
      .def_property_readonly("ended", &SteppedRun::ended, "Is there no step to take any more?");
}

}  // namespace elastogear::python
