#include "python/verbs.h"

#include <pybind11/stl.h>

#include <tuple>
#include <variant>

#include "app/gear/drive_options.h"
#include "app/options/petsc_names.h"
#include "app/verbs/registry.h"
#include "elastogear/base/error.h"
#include "elastogear/io/describe.h"

namespace elastogear::python {
namespace {

// All ranks reduce and sweep together; what else simulate does is for one of them.
Ranks ranks_of(const app::Verb& verb, const std::vector<app::Verb>& verbs, const Given& given) {
  if (verb.name != "simulate") return verb.parallel ? Ranks::all : Ranks::this_one;
  const OptionDatabase database;
  const Work work(Ranks::this_one, &database);
  const app::Options options = app::load_options(verb, verbs, sources(given));
  return options.given("analysis") && options.text("analysis") == "sweep" ? Ranks::all : Ranks::this_one;
}

Items run_verb(const std::string& name, const Given& given, const py::object& progress) {
  const std::vector<app::Verb> verbs = app::all_verbs();
  const app::Verb& verb = app::find_verb(verbs, name);
  const Ranks ranks = ranks_of(verb, verbs, given);
  const OptionDatabase database;
  Work work(ranks, &database);
  Listener listener(work, progress, name != "simulate" && name != "wear");
  const app::Embedding embedding = listener.embedding();
  const app::EmbeddingScope scope(embedding);
  work.without_gil([&] {
    verb.run(app::load_options(verb, verbs, sources(given)), given.files);
    for (const std::string& unused : app::unused_petsc_options())
      listener.items.emplace_back("warning", "nothing used the option -" + unused);
  });
  work.raise_kept();
  return listener.items;
}

std::vector<std::array<std::string, 4>> option_table(const std::string& name) {
  const std::vector<app::Verb> verbs = app::all_verbs();
  std::vector<std::array<std::string, 4>> rows;
  for (const app::OptionSpec& spec : app::find_verb(verbs, name).table)
    rows.push_back({spec.name, spec.unit, spec.default_value, spec.help});
  return rows;
}

// (name, number, unit), or (name, text, "") each, by the names of gears and pairs.
using FactList = std::vector<std::tuple<std::string, std::variant<double, std::string>, std::string>>;
using FactsByName = std::map<std::string, FactList>;

FactList fact_list(const drive::Facts& facts) {
  FactList list;
  for (const drive::Fact& fact : facts) {
    for (const drive::Figure& figure : fact.figures)
      list.emplace_back(figure.name, figure.value, figure.unit);
    if (fact.figures.empty()) list.emplace_back(fact.name, fact.text, "");
  }
  return list;
}

// Names and values of a drive's numbers, by its gears and pairs.
FactsByName drive_facts(const Given& given) {
  const std::vector<app::Verb> verbs = app::all_verbs();
  const OptionDatabase database;
  Work work(Ranks::this_one, &database);
  const app::Options options =
      app::with_gears(app::load_options(app::find_verb(verbs, "mesh"), verbs, sources(given)));
  require(app::is_drive(options), "option -drive is missing: these are not the keys of a drive");
  options.reject_unknown();
  const app::Drive drive = app::read_drive(options);
  FactsByName facts;
  for (std::size_t i = 0; i < drive.members.size(); ++i)
    facts[drive.members[i].name] = fact_list(drive.facts.members[i]);
  for (std::size_t i = 0; i < drive.pairs.size(); ++i)
    facts[pair_name(drive, drive.pairs[i])] = fact_list(drive.facts.pairs[i]);
  return facts;
}

}  // namespace

app::OptionSources sources(const Given& given) {
  static char program[] = "elastogear";
  static char* argv[] = {program, nullptr};
  app::OptionSources all{.files = given.files, .argc = 1, .argv = argv};
  if (!given.text.empty()) all.texts.push_back({given.text, given.name});
  if (!given.chosen.empty()) all.chosen.push_back({given.chosen, "keyword"});
  return all;
}

Listener::Listener(Work& work, py::object told, bool progress_ends)
    : work_(work), told_(std::move(told)), progress_ends_(progress_ends) {}

app::Embedding Listener::embedding() {
  return {
      .item = [this](const std::string& name, const std::string& text) { items.emplace_back(name, text); },
      .progress =
          [this](std::string_view stage, double fraction) {
            if (progress_ends_) work_.interrupts().raise();
            if (told_.is_none()) return;
            const py::gil_scoped_acquire gil;
            try {
              told_(std::string(stage), fraction);
            } catch (const py::error_already_set& error) {
              work_.interrupts().keep(error);
              throw;
            }
          },
      .interrupted = [this] { return work_.interrupts().pending(); }};
}

void bind_verbs(py::module_& module) {
  py::class_<Given>(module, "Given", "Where the options of a run come from.")
      .def(py::init(
               [](std::vector<std::string> files, std::string text, std::string name, std::string chosen) {
                 return Given{std::move(files), std::move(text), std::move(name), std::move(chosen)};
               }),
           py::arg("files"), py::arg("text") = "", py::arg("name") = "", py::arg("chosen") = "");
  module.def("run_verb", run_verb, py::arg("name"), py::arg("given"), py::arg("progress") = py::none(),
             "Runs a verb of the program; returns what it said, as (name, text).");
  module.def("option_table", option_table, py::arg("verb"),
             "Options of a verb: (name, unit, default, meaning) each.");
  module.def("drive_facts", drive_facts, py::arg("given"),
             "The numbers of a drive, by the names of gears and pairs: (name, number, unit) or (name, text, "
             "empty) each.");
  module.def(
      "describe",
      [](const std::string& path) {
        const Work work;
        return io::describe(path);
      },
      py::arg("path"), "What a mesh, body, result or stress file holds, as text.");
}

}  // namespace elastogear::python
