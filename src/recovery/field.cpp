#include "elastogear/recovery/field.h"

#include <algorithm>
#include <vector>

#include "elastogear/base/error.h"
#include "elastogear/recovery/patch_error.h"
#include "elastogear/recovery/stress.h"
#include "recovery/error_estimate.h"

namespace elastogear::recovery {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using States = std::vector<FieldState>;

// One body's modes and the stresses of its displacements, a column for each of k states.
struct Fields {
  const std::string& body_file;
  const io::BodySource& source;
  const FiniteElements& finite_elements;

  // Phi q, 3 n_nodes x k. q: the elastic coordinates that count of a state.
  template <class Coordinates>
  MatrixXd displacements(const States& states, const Coordinates& q) const {
    MatrixXd Q(q(states.front()).size(), std::ssize(states));
    for (std::size_t i = 0; i < states.size(); ++i) Q.col(static_cast<Index>(i)) = q(states[i]);
    return io::read_displacement_fields(body_file, Q);
  }
  MatrixXd stresses(const MatrixXd& U) const { return finite_elements.nodal_stresses(source, U); }
};

// Adds the static displacement of a state to its column of U, where it has one.
void add_static(const VectorXd& u, std::size_t state, MatrixXd& U) {
  if (u.size() > 0) U.col(static_cast<Index>(state)) += u;
}

// Takes the stresses that viscoelastic regions have relaxed from those at their nodes. docs/theory, Eq.
// (4.10).
void subtract_relaxed(const Fields& fields, const States& states, MatrixXd& stress) {
  if (states.front().w.cols() == 0) return;
  const std::vector<int> node_region = fields.finite_elements.node_regions(fields.source);
  const model::ElasticBody body = io::read_body(fields.body_file, io::BodyUse::motion);
  for (std::size_t p = 0; p < body.relaxing.size(); ++p) {
    const model::RelaxingPart& part = body.relaxing[p];
    const auto lost = [&](const FieldState& state) -> VectorXd { return state.w.col(static_cast<Index>(p)); };
    const MatrixXd of_part = stress_of_part(fields.stresses(fields.displacements(states, lost)), part.part);
    for (std::size_t node = 0; node < node_region.size(); ++node)
      if (const int r = node_region[node]; r >= 0 && fields.source.regions[r].cell_set == part.cell_set)
        stress.middleRows<6>(static_cast<Index>(6 * node)) -=
            of_part.middleRows<6>(static_cast<Index>(6 * node));
  }
}

// n_nodes x k, Pa.
MatrixXd estimated_errors(const Fields& fields, const States& states, const MatrixXd& found) {
  MatrixXd U = fields.displacements(states, [](const FieldState& s) { return s.reference->q_d; });
  for (std::size_t i = 0; i < states.size(); ++i) add_static(states[i].reference->u_static, i, U);
  MatrixXd residual = fields.stresses(U);
  const MatrixXd whole = von_mises(residual);
  residual -=
      fields.stresses(fields.displacements(states, [](const FieldState& s) { return s.reference->q; }));
  const MatrixXd of_residual = von_mises(residual);
  residual =
      fields.stresses(fields.displacements(states, [](const FieldState& s) { return s.reference->q_upper; }));
  const MatrixXd upper = von_mises(residual);
  MatrixXd error(found.rows(), found.cols());
  for (Index i = 0; i < found.cols(); ++i)
    error.col(i) = field_error({found.col(i), whole.col(i), of_residual.col(i), upper.col(i)},
                               states[static_cast<std::size_t>(i)].reference->share);
  return error;
}

// The nodes of a body on which forces act, for the estimated error by the mesh at k times.
struct Loaded {
  std::vector<int> node;   // mesh numbers
  SurfacePatches patches;  // around each; of means none
  MatrixXd difference;     // n_nodes x k, Pa, von Mises stress of Eq. (1.16a); 0 at other nodes
};

Loaded find_loaded(const Fields& fields, const std::vector<int>& touched, const MatrixXd& U) {
  const bool averaged = fields.source.recovery.method == model::RecoveryMethod::average;
  Loaded loaded{averaged ? touched : fields.source.recovery.loaded, {}, {}};
  const MatrixXd stress =
      fields.finite_elements.difference_within_surface(fields.source, touched, loaded.node) * U;
  loaded.difference = MatrixXd::Zero(fields.source.mesh.n_nodes(), U.cols());
  loaded.difference(loaded.node, Eigen::all) = von_mises(stress);
  if (!averaged) loaded.patches = fields.finite_elements.surface_patches(fields.source, loaded.node);
  return loaded;
}

// The loaded nodes whose faces have a tangent plane, with the error of their means at one time.
LoadedNodes loaded_nodes(const Loaded& of, Index time, const VectorXd& found) {
  const VectorXd difference = of.difference.col(time);
  LoadedNodes loaded;
  std::vector<double> within;
  for (std::size_t i = 0; i < of.node.size(); ++i) {
    const int node = of.node[i];
    if (!(difference[node] > 0)) continue;
    loaded.node.push_back(node);
    within.push_back(difference[node]);
    if (of.patches.node.empty()) continue;
    std::vector<int> patch = of.patches.node[i];
    std::erase_if(patch, [&](int other) { return difference[other] == 0; });
    within.back() = error_within_surface(difference(patch), found(patch), of.patches.order[i]);
  }
  loaded.within = VectorXd::Map(within.data(), std::ssize(within));
  return loaded;
}

// The patches of the nodes that have a difference, of those of several times.
SurfacePatches patches_of(const std::vector<int>& node, const SurfacePatches& all,
                          const VectorXd& difference) {
  SurfacePatches patches;
  for (std::size_t i = 0; i < all.node.size(); ++i) {
    if (!(difference[node[i]] > 0)) continue;
    patches.node.push_back(all.node[i]);
    patches.order.push_back(all.order[i]);
  }
  return patches;
}

// n_nodes x k, Pa: Eqs. (1.17) and (1.18a), of displacements U.
MatrixXd estimated_mesh_errors(const Fields& fields, const std::vector<int>& touched, const MatrixXd& U,
                               const MatrixXd& found) {
  const MatrixXd difference = von_mises(fields.finite_elements.stress_difference(fields.source, touched, U));
  std::vector<int> free;
  SurfacePatches around;
  if (fields.source.recovery.method == model::RecoveryMethod::surface) {
    for (int i = 0; i < difference.rows(); ++i)
      if (difference.row(i).maxCoeff() > 0) free.push_back(i);
    around = fields.finite_elements.surface_patches(fields.source, free);
  }
  const Loaded loaded = find_loaded(fields, touched, U);
  MatrixXd error(found.rows(), found.cols());
  for (Index i = 0; i < found.cols(); ++i)
    error.col(i) =
        mesh_error_field(difference.col(i), found.col(i), patches_of(free, around, difference.col(i)),
                         loaded_nodes(loaded, i, found.col(i)));
  return error;
}

// Fields of one number a node, n_nodes x k.
struct Scalar {
  const char* name;
  MatrixXd value;
};

std::vector<Scalar> scalars(const Fields& body, const States& states, const MatrixXd& U,
                            const MatrixXd& stress) {
  std::vector<Scalar> all = {{"von_mises [Pa]", von_mises(stress)}, {"rankine [Pa]", rankine(stress)}};
  const MatrixXd found = all[0].value;
  if (states.front().reference)
    all.push_back({"error_of_von_mises [Pa]", estimated_errors(body, states, found)});
  if (const auto& touched = states.front().touched)
    all.push_back({"error_of_von_mises_by_mesh [Pa]", estimated_mesh_errors(body, *touched, U, found)});
  if (states.front().q_error.size() > 0)
    all.push_back(
        {"error_of_von_mises_by_steps [Pa]", von_mises(body.stresses(body.displacements(
                                                 states, [](const FieldState& s) { return s.q_error; })))});
  return all;
}

}  // namespace

int fields_together(int n_nodes) {
  constexpr int kMost = 16, kNodes = 1'000'000;  // 6 stresses of 8 bytes and their like at each node
  return std::clamp(kNodes / std::max(1, n_nodes), 1, kMost);
}

void write_fields(const std::vector<std::string>& paths, const std::string& body_file,
                  const io::BodySource& source, const States& states, const FiniteElements& finite_elements) {
  require(paths.size() == states.size() && !states.empty(), "fields need a path for each state");
  const Fields body{body_file, source, finite_elements};
  MatrixXd U = body.displacements(states, [](const FieldState& s) { return s.q; });
  for (std::size_t i = 0; i < states.size(); ++i) add_static(states[i].u_static, i, U);
  MatrixXd stress = body.stresses(U);
  subtract_relaxed(body, states, stress);
  const std::vector<Scalar> all = scalars(body, states, U, stress);
  mesh::Mesh placed = source.mesh;
  const int n = source.mesh.n_nodes();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const FieldState& state = states[i];
    const auto column = static_cast<Index>(i);
    placed.X = (state.R_WB * source.mesh.X).colwise() + state.r_WB;
    std::vector<io::NodeField> fields = {{"displacement [m]", state.R_WB * U.col(column).reshaped(3, n)},
                                         {"stress [Pa]", stress.col(column).reshaped(6, n)}};
    for (const Scalar& of : all) fields.push_back({of.name, of.value.col(column).transpose()});
    fields.insert(fields.end(), state.more.begin(), state.more.end());
    io::write_vtu(paths[i], placed, fields);
  }
}

}  // namespace elastogear::recovery
