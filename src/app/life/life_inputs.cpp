#include "app/life/life_inputs.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <utility>

#include "app/evaluate/cases.h"
#include "app/evaluate/evaluate_options.h"
#include "app/evaluate/mesh_errors.h"
#include "app/options/units.h"
#include "app/setup/drive_input.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/number.h"
#include "elastogear/base/text.h"
#include "elastogear/drive/finite_elements.h"
#include "elastogear/io/describe.h"
#include "elastogear/io/result_file.h"
#include "elastogear/life/revolution.h"
#include "elastogear/recovery/recover.h"

namespace elastogear::app {
namespace {

namespace fs = std::filesystem;

bool is_stress_file(const std::string& file) {
  const std::string format = io::file_format(file);
  require(format == "elastogear stress" || format == "elastogear result", file, ": holds an ", format,
          "; a life is computed from result files of sweeps, or from stress files");
  return format == "elastogear stress";
}

// The torque of a run, < 0 on the coast side.
double torque_of(const std::string& file) {
  const auto input = io::read_run_input(file);
  require(input && input->drive && input->drive->torque != 0, file,
          ": does not say the torque of its run; give it by -file_torques");
  return input->drive->torque;
}

SweptTorque of_file(const std::string& file, const double* torque) {
  const bool recovered = is_stress_file(file);
  return {file, torque ? *torque : torque_of(file), recovered};
}

// Commas between quotes belong to a field.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (char c : line)
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      fields.emplace_back();
    else if (c != '\r')
      fields.back() += c;
  return fields;
}

std::size_t column_of(const std::string& file, const std::vector<std::string>& heading,
                      const std::string& name) {
  for (std::size_t i = 0; i < heading.size(); ++i)
    if (heading[i] == name || heading[i].starts_with(name + " [")) return i;
  fail(file, ": has no column ", name);
}

// The table of cases that a sweep with several torques or variants writes.
std::vector<SweptTorque> of_cases(const Options& options, const std::string& table,
                                  const std::string& variant) {
  std::ifstream in = open_input(table);
  std::string line;
  require(static_cast<bool>(std::getline(in, line)), table, ": cannot be read");
  const std::vector<std::string> heading = fields_of(line);
  const std::size_t file = column_of(table, heading, "file"), torque = column_of(table, heading, "torque"),
                    name = column_of(table, heading, "variant");
  const double sense = options.choice("side", {"drive", "coast"}) == 0 ? 1 : -1;
  std::vector<SweptTorque> all;
  std::set<std::string> variants;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = fields_of(line);
    if (fields.size() != heading.size()) fail(table, ": '", line, "' has not the columns of its heading");
    variants.insert(fields[name]);
    if (!variant.empty() && fields[name] != variant) continue;
    require(!fields[file].empty(), table, ": the case '", line, "' has no file: no position was found");
    const std::string path = (fs::path(table).parent_path() / fields[file]).string();
    const std::string unit = heading_of(table, heading[torque]).unit;
    const auto value =
        parse<double>(unit.empty() ? fields[torque] : in_unit(table, fields[torque] + " " + unit, "N m"));
    require(value.has_value(), table, ": torque '", fields[torque], "' is no number");
    require_torque_of_run(std::string(table).append(", case '").append(line).append("'"), path, *value);
    all.push_back({path, sense * *value, is_stress_file(path)});
  }
  require(!all.empty() && (variants.size() == 1 || !variant.empty()), table, ": ",
          all.empty() ? "no case of variant '" + variant + "'" : "has several variants",
          "; choose one by -variant: ", join(variants));
  return all;
}

struct Stresses {
  io::StressFile file;
  std::set<std::string> rigid = {};  // bodies, which have none
};

// Stresses of the sets that are wanted, of a result.
Stresses recovered(const LifeSettings& settings, const std::string& result) {
  require(io::is_complete(result), result, ": is incomplete, its run did not reach the end; go on with it");
  Stresses stresses{{io::read_times(result), {}, {}}};
  for (recovery::BodyOfRun& body : recovery::read_bodies_of_run(result, settings.body_file)) {
    const auto sets = settings.sets.find(body.name);
    if (sets == settings.sets.end()) continue;
    if (body.rigid) {
      stresses.rigid.insert(body.name);
      continue;
    }
    recovery::RecoveredBody ready = recovery::prepare_recovery(
        std::move(body), recovery::Acceleration::automatic, true, drive::finite_elements());
    const model::ElasticBody elastic = recovery::read_elastic_body(ready.run);
    for (const std::string& set : sets->second)
      stresses.file.sets.push_back(recovery::recover_stress(ready, elastic, set, true));
  }
  return stresses;
}

// The sum of the estimates, as recover says it; empty where that of the mesh or of the reduction is missing.
Eigen::MatrixXd whole_error(const io::StressSet& set) {
  if (set.error.size() == 0 || set.mesh_error.size() == 0) return {};
  Eigen::MatrixXd error = set.error + set.mesh_error;
  if (set.contact_error.size() > 0) error += set.contact_error;
  if (set.time_error.size() > 0) error += set.time_error;
  return error;
}

// The error of the largest tension at a gear's root that `run` has found from coarser meshes, as a share of
// the stress everywhere; empty where no evaluation is of this result.
Eigen::MatrixXd error_of_run(const Options& options, const std::string& result, const io::StressSet& set) {
  const std::string evaluation = drive_stem(options) + "_evaluation.h5";
  if (set.set != "root" || !fs::is_regular_file(evaluation)) return {};
  const double share = root_error_of(evaluation, result, set.body);
  return share < 0 ? Eigen::MatrixXd()
                   : Eigen::MatrixXd(share * life::signed_principal(set.stress).cwiseAbs());
}

std::vector<SweptTorque> named_torques(const Options& options, const LifeSettings& settings) {
  std::vector<SweptTorque> all;
  for (std::size_t i = 0; i < settings.files.size(); ++i)
    all.push_back(of_file(settings.files[i], settings.torques.empty() ? nullptr : &settings.torques[i]));
  const auto refuse_variant = [&](const std::string& file) {
    require(settings.variant.empty(), options.label("variant"), " = '", settings.variant,
            "': chooses among the cases of a sweep over variants; ", file,
            " is a result or stresses of one; leave it out");
  };
  if (!all.empty()) return refuse_variant(all.front().file), all;
  const std::string stem = drive_stem(options) + "_result", table = stem + "/cases.csv";
  if (fs::exists(table) && result_of_drive(options, stem) == stem)
    return of_cases(options, table, settings.variant);
  require(fs::exists(stem + ".h5"), stem, ".h5: there is no such file, nor ", table,
          ": sweep the drive first, elastogear simulate ", options.files().empty() ? "" : options.files()[0],
          " with analysis: sweep, or name result or stress files by -files");
  refuse_variant(stem + ".h5");
  return {of_file(stem + ".h5", nullptr)};
}

}  // namespace

std::vector<SweptTorque> swept_torques(const Options& options, const LifeSettings& settings) {
  std::vector<SweptTorque> all = named_torques(options, settings);
  std::map<double, std::string> file_of;
  for (const SweptTorque& at : all) {
    const auto [other, is_new] = file_of.emplace(at.torque, at.file);
    require(is_new, at.file, ": is of ", at.torque, " N m, as ", other->second,
            " is: a torque has one file; leave one of the two out");
    require_input(options, at.file);
  }
  return all;
}

std::vector<SweptStress> read_stresses(const Options& options, const LifeSettings& settings,
                                       const SweptTorque& at) {
  const auto [file, rigid] = at.recovered ? Stresses{io::read_stress(at.file)} : recovered(settings, at.file);
  std::vector<SweptStress> all;
  for (const auto& [body, sets] : settings.sets)
    for (const std::string& name : sets) {
      if (rigid.contains(body)) continue;
      const auto set =
          std::find_if(file.sets.begin(), file.sets.end(),
                       [&, &body = body](const io::StressSet& s) { return s.body == body && s.set == name; });
      require(set != file.sets.end() && set->X.cols() > 0, at.file, ": holds no stresses of ", body, " ",
              name, ": recover it with -stress_", body, " ", name);
      Eigen::MatrixXd error = whole_error(*set);
      if (error.size() == 0 && !at.recovered) error = error_of_run(options, at.file, *set);
      all.push_back(
          {body, name, set->node, set->X, file.time, life::signed_principal(set->stress), std::move(error)});
    }
  return all;
}

std::string body_file_of(const Options& options, const DriveMember& member, const SweptTorque& at) {
  if (!at.recovered && !options.given(member.name + "_file"))
    for (const auto& body : io::read_result_header(at.file).bodies)
      if (body.name == member.name) return body.file;
  const std::string file = body_file(options, member);
  return fs::exists(file) ? file : "";
}

}  // namespace elastogear::app
