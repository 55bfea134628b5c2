#include "elastogear/io/stress_file.h"

#include <algorithm>
#include <utility>

#include "elastogear/base/file.h"
#include "elastogear/base/finite.h"
#include "io/hdf5/schema.h"
#include "io/result/run_input.h"

namespace elastogear::io {
namespace {

void check(const h5::File& file, const StressSet& set, Eigen::Index n_t) {
  require_name(file, set.body);
  require_name(file, set.set);
  const auto n = static_cast<Eigen::Index>(set.node.size());
  const bool fits = set.stress.rows() == 6 * n && set.von_mises.rows() == n && set.rankine.rows() == n &&
                    set.stress.cols() == n_t && set.von_mises.cols() == n_t && set.rankine.cols() == n_t;
  require(std::all_of(set.node.begin(), set.node.end(), [](int node) { return node >= 0; }), file.path,
          ": nodes of ", set.body, "/", set.set, " have negative numbers");
  require(set.X.size() == 0 || set.X.cols() == n, file.path, ": ", set.X.cols(), " positions of the ", n,
          " nodes of ", set.body, "/", set.set);
  require(fits, file.path, ": stresses of ", set.body, "/", set.set, " do not have ", n, " nodes and ", n_t,
          " times");
  require(set.error.size() == 0 ||
              (set.error.rows() == n && set.error.cols() == n_t && set.peak_error.size() == n_t),
          file.path, ": estimated errors of ", set.body, "/", set.set, " do not have ", n, " nodes and ", n_t,
          " times");
  for (const auto& [error, by] : {std::pair{&set.mesh_error, "the mesh"},
                                  {&set.contact_error, "contact"},
                                  {&set.time_error, "steps in time"}})
    require(error->size() == 0 || (error->rows() == n && error->cols() == n_t), file.path,
            ": estimated errors by ", by, " of ", set.body, "/", set.set, " do not have ", n, " nodes and ",
            n_t, " times");
  require(all_finite(set.stress) && all_finite(set.von_mises) && all_finite(set.rankine) &&
              all_finite(set.error) && all_finite(set.peak_error) && all_finite(set.mesh_error) &&
              all_finite(set.contact_error) && all_finite(set.time_error),
          file.path, ": stresses of ", set.body, "/", set.set, " are not finite");
}

void write_set(const h5::File& file, const StressSet& set) {
  const std::string group = "/" + set.body + "/" + set.set;
  const hsize_t n_t = extent(set.von_mises.cols()), n = set.node.size();
  h5::write<int>(file, group + "/nodes", view(set.node), "1");
  h5::write<double>(file, group + "/stress", {{n_t, n, 6}, set.stress.data()}, "Pa");
  h5::set_attribute(file, group + "/stress", "components", "xx yy zz xy yz xz");
  h5::write<double>(file, group + "/von_mises", {{n_t, n}, set.von_mises.data()}, "Pa");
  h5::write<double>(file, group + "/rankine", {{n_t, n}, set.rankine.data()}, "Pa");
  if (set.X.size() > 0) h5::write<double>(file, group + "/X", view(set.X), "m");
  if (set.error.size() > 0) {
    h5::write<double>(file, group + "/error", {{n_t, n}, set.error.data()}, "Pa");
    h5::write<double>(file, group + "/peak_error", view(set.peak_error), "Pa");
  }
  if (set.mesh_error.size() > 0)
    h5::write<double>(file, group + "/mesh_error", {{n_t, n}, set.mesh_error.data()}, "Pa");
  if (set.contact_error.size() > 0)
    h5::write<double>(file, group + "/contact_error", {{n_t, n}, set.contact_error.data()}, "Pa");
  if (set.time_error.size() > 0)
    h5::write<double>(file, group + "/time_error", {{n_t, n}, set.time_error.data()}, "Pa");
  h5::set_attribute(file, group, "frame", "body");
}

Eigen::MatrixXd columns(const std::vector<double>& values, Eigen::Index n_t) {
  const auto rows = n_t == 0 ? 0 : static_cast<Eigen::Index>(values.size()) / n_t;
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), rows, n_t);
}

StressSet read_set(const h5::File& file, const std::string& body, const std::string& name, Eigen::Index n_t) {
  const std::string group = "/" + body + "/" + name;
  StressSet set{body, name, h5::read<int>(file, group + "/nodes", {h5::kAny}), {}, {}, {}};
  const hsize_t n = set.node.size();
  set.stress = columns(h5::read<double>(file, group + "/stress", {extent(n_t), n, 6}), n_t);
  set.von_mises = columns(h5::read<double>(file, group + "/von_mises", {extent(n_t), n}), n_t);
  set.rankine = columns(h5::read<double>(file, group + "/rankine", {extent(n_t), n}), n_t);
  if (h5::exists(file, group + "/X")) set.X = read_points(file, group + "/X");
  for (const auto& [error, dataset] : {std::pair{&set.mesh_error, "/mesh_error"},
                                       {&set.contact_error, "/contact_error"},
                                       {&set.time_error, "/time_error"}})
    if (h5::exists(file, group + dataset))
      *error = columns(h5::read<double>(file, group + dataset, {extent(n_t), n}), n_t);
  if (h5::exists(file, group + "/error")) {
    set.error = columns(h5::read<double>(file, group + "/error", {extent(n_t), n}), n_t);
    set.peak_error = read_vector(file, group + "/peak_error", extent(n_t));
  }
  return set;
}

bool is_body(const std::string& name) { return name != "time" && name != "provenance"; }

}  // namespace

void write_stress(const std::string& path, const StressFile& history) {
  PendingFile pending(path);
  h5::File file = h5::create(path, pending.temporary());
  write_format(file, kStressFormat);
  h5::write_map(file, "/provenance", history.provenance);
  write_run_input(file, history.input);
  h5::write<double>(file, "/time", view(history.time), "s");
  for (const StressSet& set : history.sets) {
    check(file, set, history.time.size());
    require(is_body(set.body), path, ": a body must not be called '", set.body, "'");
    write_set(file, set);
  }
  h5::close(file);
  pending.commit();
}

StressFile read_stress(const std::string& path) {
  const h5::File file = open_format(path, kStressFormat);
  StressFile history;
  history.time = read_time(file);
  history.provenance = h5::read_map(file, "/provenance");
  history.input = read_run_input(file);
  for (const std::string& body : h5::members(file, "/"))
    if (is_body(body))
      for (const std::string& set : h5::members(file, "/" + body))
        check(file, history.sets.emplace_back(read_set(file, body, set, history.time.size())),
              history.time.size());
  return history;
}

}  // namespace elastogear::io
