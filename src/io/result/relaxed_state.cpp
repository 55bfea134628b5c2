#include "elastogear/io/relaxed_state.h"

#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

// A row of the dataset is a column of the matrix.
h5::View<double> columns(const Eigen::MatrixXd& A) {
  return {{extent(A.cols()), extent(A.rows())}, A.data()};
}

Eigen::MatrixXd read_columns(const h5::File& file, const std::string& name) {
  const h5::Shape shape = h5::shape(file, name);
  require(shape.size() == 2, file.path, ": ", name, " must have two dimensions");
  const std::vector<double> values = h5::read<double>(file, name, {h5::kAny, h5::kAny});
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), static_cast<Eigen::Index>(shape[1]),
                                           static_cast<Eigen::Index>(shape[0]));
}

}  // namespace

void add_relaxed_states(const std::string& path, const std::map<std::string, model::RelaxedState>& states,
                        const std::string& all) {
  h5::File file = h5::open_to_add(path);
  h5::make_group(file, all);
  for (const auto& [body, state] : states) {
    const std::string group = std::string(all).append("/").append(body);
    h5::make_group(file, group);
    h5::write<double>(file, group + "/q", view(state.q), "1");
    if (state.tau.size() > 0) {
      h5::write<double>(file, group + "/tau", view(state.tau), "s");
      h5::write<double>(file, group + "/z", columns(state.z), "1");
    }
    if (state.node.empty()) continue;
    h5::write<int>(file, group + "/nodes", view(state.node), "1");
    h5::write<double>(file, group + "/force", columns(state.force), "N");
  }
  h5::close(file);
}

model::RelaxedState read_relaxed_state(const std::string& path, const std::string& body,
                                       const std::string& all) {
  const h5::File file = open_format(path, kResultFormat);
  const std::string group = std::string(all).append("/").append(body);
  if (!h5::exists(file, group)) return {};
  model::RelaxedState state{read_vector(file, group + "/q"), {}, {}, {}, Eigen::MatrixXd(3, 0)};
  state.z.resize(state.q.size(), 0);
  if (h5::exists(file, group + "/tau")) {
    state.tau = read_vector(file, group + "/tau");
    state.z = read_columns(file, group + "/z");
  }
  if (h5::exists(file, group + "/nodes")) {
    state.node = h5::read<int>(file, group + "/nodes", {h5::kAny});
    state.force = read_columns(file, group + "/force");
  }
  require(state.q.allFinite() && state.z.allFinite() && state.force.allFinite(), path, ": ", group,
          " is not finite");
  return state;
}

}  // namespace elastogear::io
