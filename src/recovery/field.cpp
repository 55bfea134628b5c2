#include "elastogear/recovery/field.h"

#include <algorithm>
#include <array>
#include <vector>

#include "elastogear/base/error.h"
#include "elastogear/recovery/patch_error.h"
#include "elastogear/recovery/stress.h"
#include "recovery/error_estimate.h"

namespace elastogear::recovery {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using States = std::vector<FieldState>;

bool takes_means(const FieldBody& body) {
  return body.source.recovery.method == model::RecoveryMethod::average;
}

// Phi q, 3 n_nodes x k. q: the elastic coordinates that count of a state.
template <class Coordinates>
MatrixXd displacements(const FieldBody& body, const States& states, const Coordinates& q) {
  MatrixXd Q(q(states.front()).size(), std::ssize(states));
  for (std::size_t i = 0; i < states.size(); ++i) Q.col(static_cast<Index>(i)) = q(states[i]);
  return io::read_displacement_fields(body.file, Q);
}

// 6 n_nodes x k, and at free nodes what their recovery gives less the means, 6 n_free x k.
struct Stresses {
  MatrixXd at_nodes, difference;
};

Stresses stresses(const FieldBody& body, const MatrixXd& U) {
  const NodalStresses& of = body.nodal_stresses;
  Stresses found{of.means(U), of.of_free * U};
  for (std::size_t i = 0; i < of.free.size(); ++i) {
    auto at_node = found.at_nodes.middleRows<6>(6 * of.free[i]);
    auto difference = found.difference.middleRows<6>(static_cast<Index>(6 * i));
    difference -= at_node;
    if (!takes_means(body)) at_node += difference;
  }
  return found;
}

// Adds the static displacement of a state to its column of U, where it has one.
void add_static(const VectorXd& u, std::size_t state, MatrixXd& U) {
  if (u.size() > 0) U.col(static_cast<Index>(state)) += u;
}

// Takes the stresses that viscoelastic regions have relaxed from those at their nodes. docs/theory, Eq.
// (4.10).
void subtract_relaxed(const FieldBody& fields, const States& states, MatrixXd& stress) {
  if (states.front().w.cols() == 0) return;
  const std::vector<int> node_region = fields.finite_elements.node_regions(fields.source);
  const model::ElasticBody body = io::read_body(fields.file, io::BodyUse::motion);
  for (std::size_t p = 0; p < body.relaxing.size(); ++p) {
    const model::RelaxingPart& part = body.relaxing[p];
    const auto lost = [&](const FieldState& state) -> VectorXd { return state.w.col(static_cast<Index>(p)); };
    const MatrixXd of_part =
        stress_of_part(stresses(fields, displacements(fields, states, lost)).at_nodes, part.part);
    for (std::size_t node = 0; node < node_region.size(); ++node)
      if (const int r = node_region[node]; r >= 0 && fields.source.regions[r].cell_set == part.cell_set)
        stress.middleRows<6>(static_cast<Index>(6 * node)) -=
            of_part.middleRows<6>(static_cast<Index>(6 * node));
  }
}

// n_nodes x k, Pa. Three displacements of each state are recovered at once.
MatrixXd estimated_errors(const FieldBody& body, const States& states, const MatrixXd& found) {
  const Index k = found.cols();
  MatrixXd U(3 * body.source.mesh.n_nodes(), 3 * k);
  U << displacements(body, states, [](const FieldState& s) { return s.reference->q_d; }),
      displacements(body, states, [](const FieldState& s) { return s.reference->q; }),
      displacements(body, states, [](const FieldState& s) { return s.reference->q_upper; });
  for (std::size_t i = 0; i < states.size(); ++i) add_static(states[i].reference->u_static, i, U);
  MatrixXd stress = stresses(body, U).at_nodes;
  const MatrixXd whole = von_mises(MatrixXd(stress.leftCols(k))),
                 upper = von_mises(MatrixXd(stress.rightCols(k)));
  stress.leftCols(k) -= stress.middleCols(k, k);
  const MatrixXd of_residual = von_mises(MatrixXd(stress.leftCols(k)));
  MatrixXd error(found.rows(), k);
  for (Index i = 0; i < k; ++i)
    error.col(i) = field_error({found.col(i), whole.col(i), of_residual.col(i), upper.col(i)},
                               states[static_cast<std::size_t>(i)].reference->share);
  return error;
}

// The loaded nodes whose faces have a tangent plane, with the error of their means at one time. difference:
// von Mises stresses of Eq. (1.16a), at all nodes of the mesh; 0 at others.
LoadedNodes loaded_nodes(const LoadedSurface& of, const VectorXd& difference, const VectorXd& found) {
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

// The patches of the free nodes that have a difference.
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

// von Mises stresses of k tensors at some nodes: n_nodes x k, 0 at others.
MatrixXd at_all_nodes(const FieldBody& body, const std::vector<int>& nodes, const MatrixXd& stress) {
  MatrixXd all = MatrixXd::Zero(body.source.mesh.n_nodes(), stress.cols());
  all(nodes, Eigen::all) = von_mises(stress);
  return all;
}

// n_nodes x k, Pa: Eqs. (1.17) and (1.18a), of displacements U. of_free: their difference at free nodes.
MatrixXd estimated_mesh_errors(const FieldBody& body, const MatrixXd& U, const MatrixXd& of_free,
                               const MatrixXd& found) {
  const std::vector<int>& free = body.nodal_stresses.free;
  const MatrixXd difference = at_all_nodes(body, free, of_free),
                 within = at_all_nodes(body, body.loaded->node, body.loaded->difference * U);
  MatrixXd error(found.rows(), found.cols());
  for (Index i = 0; i < found.cols(); ++i)
    error.col(i) = mesh_error_field(difference.col(i), found.col(i),
                                    patches_of(free, body.around_free, difference.col(i)),
                                    loaded_nodes(*body.loaded, within.col(i), found.col(i)));
  return error;
}

// Fields of one number a node, n_nodes x k.
struct Scalar {
  const char* name;
  MatrixXd value;
};

std::vector<Scalar> scalars(const FieldBody& body, const States& states, const MatrixXd& U,
                            const Stresses& of) {
  std::vector<Scalar> all = {{"von_mises [Pa]", von_mises(of.at_nodes)},
                             {"rankine [Pa]", rankine(of.at_nodes)}};
  const MatrixXd found = all[0].value;
  if (states.front().reference)
    all.push_back({"error_of_von_mises [Pa]", estimated_errors(body, states, found)});
  if (body.loaded)
    all.push_back({"error_of_von_mises_by_mesh [Pa]", estimated_mesh_errors(body, U, of.difference, found)});
  if (states.front().q_error.size() > 0) {
    const MatrixXd U_error = displacements(body, states, [](const FieldState& s) { return s.q_error; });
    all.push_back({"error_of_von_mises_by_steps [Pa]", von_mises(stresses(body, U_error).at_nodes)});
  }
  return all;
}

}  // namespace

int fields_together(int n_nodes) {
  constexpr int kMost = 16, kNodes = 1'000'000;  // 6 stresses of 8 bytes and their like at each node
  return std::clamp(kNodes / std::max(1, n_nodes), 1, kMost);
}

FieldBody field_body(const std::string& body_file, const io::BodySource& source,
                     const std::optional<std::vector<int>>& touched, const FiniteElements& finite_elements) {
  FieldBody body{body_file, source, finite_elements,
                 finite_elements.nodal_stresses(source, touched.value_or(std::vector<int>{}))};
  if (!touched) return body;
  const bool averaged = takes_means(body);
  const auto patches = [&](const std::vector<int>& nodes) {
    return averaged ? SurfacePatches{} : finite_elements.surface_patches(source, nodes);
  };
  body.around_free = patches(body.nodal_stresses.free);
  const std::vector<int>& loaded = averaged ? *touched : source.recovery.loaded;
  body.loaded = LoadedSurface{loaded, patches(loaded),
                              finite_elements.difference_within_surface(source, *touched, loaded)};
  return body;
}

void write_fields(const std::vector<std::string>& paths, const FieldBody& body, const States& states) {
  require(paths.size() == states.size() && !states.empty(), "fields need a path for each state");
  MatrixXd U = displacements(body, states, [](const FieldState& s) { return s.q; });
  for (std::size_t i = 0; i < states.size(); ++i) add_static(states[i].u_static, i, U);
  Stresses of = stresses(body, U);
  subtract_relaxed(body, states, of.at_nodes);
  const std::vector<Scalar> all = scalars(body, states, U, of);
  mesh::Mesh placed = body.source.mesh;
  const int n = placed.n_nodes();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const FieldState& state = states[i];
    const auto column = static_cast<Index>(i);
    placed.X = (state.R_WB * body.source.mesh.X).colwise() + state.r_WB;
    std::vector<io::NodeField> fields = {{"displacement [m]", state.R_WB * U.col(column).reshaped(3, n)},
                                         {"stress [Pa]", of.at_nodes.col(column).reshaped(6, n)}};
    for (const Scalar& scalar : all) fields.push_back({scalar.name, scalar.value.col(column).transpose()});
    fields.insert(fields.end(), state.more.begin(), state.more.end());
    io::write_vtu(paths[i], placed, fields);
  }
}

}  // namespace elastogear::recovery
