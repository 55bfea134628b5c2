#include "elastogear/fem/stress.h"

#include <limits>
#include <optional>
#include <set>

#include "elastogear/base/error.h"
#include "elastogear/fem/element.h"
#include "fem/surface/surface_stress.h"

namespace elastogear::fem {
namespace {

Averaging find_averaging(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions) {
  const auto n = static_cast<std::size_t>(mesh.n_nodes());
  Averaging average{cell_regions(mesh, regions), std::vector<int>(n, std::numeric_limits<int>::max()),
                    std::vector<int>(n, 0)};
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    for (int node : mesh.cells[cell])
      average.region[node] = std::min(average.region[node], average.region_of_cell[cell]);
  for (int cell = 0; cell < mesh.cells.size(); ++cell)
    for (int node : mesh.cells[cell]) average.count[node] += average.counts(cell, node);
  return average;
}

Eigen::MatrixXd element_stress(const mesh::Mesh& mesh, int cell, const model::Material& material,
                               model::Element element) {
  const auto& functions = element_functions(mesh.cells.type[cell]);
  return functions.stress(cell_coordinates(mesh, cell), elasticity(material), element);
}

Eigen::MatrixXd displacements(std::span<const int> nodes, const Eigen::MatrixXd& U) {
  Eigen::MatrixXd U_e(3 * nodes.size(), U.cols());
  for (std::size_t a = 0; a < nodes.size(); ++a)
    U_e.middleRows<3>(static_cast<Eigen::Index>(3 * a)) = U.middleRows<3>(3 * nodes[a]);
  return U_e;
}

// Adds 6 rows S_a for the displacements of some nodes to the operator's rows 6 i ..
void add_rows(std::vector<Eigen::Triplet<double>>& entries, int i, std::span<const int> nodes,
              const Eigen::MatrixXd& S_a) {
  for (int row = 0; row < 6; ++row)
    for (Eigen::Index b = 0; b < S_a.cols(); ++b)
      entries.emplace_back(6 * i + row, 3 * nodes[static_cast<std::size_t>(b / 3)] + b % 3, S_a(row, b));
}

// Recovery at free surfaces, where the body asks for it.
class SurfaceRecovery {
 public:
  SurfaceRecovery(const StressedBody& body, const Averaging& average) : body_(body), average_(average) {
    if (body.recovery.method == model::RecoveryMethod::surface)
      surface_.emplace(body, average.region_of_cell);
  }

  /// Rows at a node of a cell; nothing where the mean is to be taken.
  std::optional<SurfaceRows> operator()(int node) const {
    if (!surface_) return {};
    return surface_stress(*surface_, body_.mesh.X, body_.regions[average_.region[node]].material, node);
  }

 private:
  const StressedBody& body_;
  const Averaging& average_;
  std::optional<FreeSurface> surface_;
};

}  // namespace

model::SparseRows stress_operator(const StressedBody& body, const std::vector<int>& nodes) {
  const mesh::Mesh& mesh = body.mesh;
  const Averaging average = find_averaging(mesh, body.regions);
  std::vector<int> local(static_cast<std::size_t>(mesh.n_nodes()), -1);
  for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
    if (average.count[nodes[i]] == 0) fail("stress ", mesh::node_text(mesh, nodes[i]), " belongs to no cell");
    local[nodes[i]] = i;
  }
  std::vector<Eigen::Triplet<double>> entries;
  const SurfaceRecovery recover(body, average);
  for (int node : nodes) {
    if (local[node] < 0) continue;
    if (const auto rows = recover(node)) {
      add_rows(entries, local[node], rows->node, rows->S);
      local[node] = -1;
    }
  }
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    Eigen::MatrixXd S_e;
    const auto cell_nodes = mesh.cells[cell];
    for (int a = 0; a < static_cast<int>(cell_nodes.size()); ++a) {
      const int node = cell_nodes[a];
      if (local[node] < 0 || !average.counts(cell, node)) continue;
      if (S_e.size() == 0)
        S_e = element_stress(mesh, cell, body.regions[average.region_of_cell[cell]].material, body.element);
      add_rows(entries, local[node], cell_nodes, S_e.middleRows(6 * a, 6) / average.count[node]);
    }
  }
  model::SparseRows S(6 * static_cast<Eigen::Index>(nodes.size()), 3 * mesh.n_nodes());
  S.setFromTriplets(entries.begin(), entries.end());
  return S;
}

model::SparseRows recovery_difference(StressedBody body, const std::vector<int>& nodes) {
  body.recovery.method = model::RecoveryMethod::surface;
  const model::SparseRows recovered = stress_operator(body, nodes);
  body.recovery.method = model::RecoveryMethod::average;
  model::SparseRows difference = recovered - stress_operator(body, nodes);
  difference.prune(0.0);
  return difference;
}

model::SparseRows difference_within_surface(StressedBody body, const std::vector<int>& nodes) {
  const std::set<int> loaded(body.recovery.loaded.begin(), body.recovery.loaded.end());
  body.recovery = {model::RecoveryMethod::surface, {}};
  const Averaging average = find_averaging(body.mesh, body.regions);
  const SurfaceRecovery recover(body, average);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (const auto rows = loaded.contains(nodes[i]) ? recover(nodes[i]) : std::nullopt)
      for (int a = 0; a < 6; ++a)
        for (int b = 0; b < 6; ++b)
          entries.emplace_back(6 * static_cast<int>(i) + a, 6 * static_cast<int>(i) + b, rows->within(a, b));
  const auto n = 6 * static_cast<Eigen::Index>(nodes.size());
  model::SparseRows within(n, n);
  within.setFromTriplets(entries.begin(), entries.end());
  model::SparseRows difference = within * recovery_difference(std::move(body), nodes);
  difference.prune(0.0);
  return difference;
}

std::vector<int> stress_regions(const mesh::Mesh& mesh, const std::vector<model::MaterialRegion>& regions) {
  Averaging average = find_averaging(mesh, regions);
  for (std::size_t node = 0; node < average.region.size(); ++node)
    if (average.count[node] == 0) average.region[node] = -1;
  return average.region;
}

NodalStresses::NodalStresses(const StressedBody& body)
    : body_(body), average_(find_averaging(body.mesh, body.regions)) {
  const SurfaceRecovery recover(body_, average_);
  std::vector<Eigen::Triplet<double>> entries;
  for (int node = 0; node < body_.mesh.n_nodes(); ++node)
    if (average_.count[node] > 0)
      if (const auto rows = recover(node)) {
        add_rows(entries, static_cast<int>(free_.size()), rows->node, rows->S);
        free_.push_back(node);
      }
  S_free_.resize(6 * std::ssize(free_), 3 * body_.mesh.n_nodes());
  S_free_.setFromTriplets(entries.begin(), entries.end());
}

Eigen::MatrixXd NodalStresses::means(const Eigen::MatrixXd& U) const {
  const mesh::Mesh& mesh = body_.mesh;
  require(U.rows() == 3 * mesh.n_nodes(), "displacement has ", U.rows(), " entries, the mesh needs ",
          3 * mesh.n_nodes());
  Eigen::MatrixXd sigma = Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(mesh.n_nodes()), U.cols());
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const model::Material& material = body_.regions[average_.region_of_cell[cell]].material;
    const auto nodes = mesh.cells[cell];
    const Eigen::MatrixXd s = element_stress(mesh, cell, material, body_.element) * displacements(nodes, U);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      if (average_.counts(cell, nodes[a]))
        sigma.middleRows<6>(6 * nodes[a]) +=
            s.middleRows<6>(static_cast<Eigen::Index>(6 * a)) / average_.count[nodes[a]];
  }
  return sigma;
}

Eigen::MatrixXd NodalStresses::operator()(const Eigen::MatrixXd& U) const {
  Eigen::MatrixXd sigma = means(U);
  const Eigen::MatrixXd of_free = S_free_ * U;
  for (std::size_t i = 0; i < free_.size(); ++i)
    sigma.middleRows<6>(6 * free_[i]) = of_free.middleRows<6>(static_cast<Eigen::Index>(6 * i));
  return sigma;
}

Eigen::MatrixXd nodal_stress(const StressedBody& body, const Eigen::VectorXd& u) {
  return NodalStresses(body)(u).reshaped(6, body.mesh.n_nodes());
}

}  // namespace elastogear::fem
