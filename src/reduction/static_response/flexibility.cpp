#include "elastogear/reduction/flexibility.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "reduction/eigensolver/factorisation.h"
#include "reduction/static_response/inertia_relief.h"

namespace elastogear::reduction {
namespace {

constexpr int kBlock = 32;  // loaded nodes whose 3 x 32 right-hand sides go through the factor together
constexpr const char* kStage = "static responses";

using Eigen::MatrixXd;

// Surface nodes (local numbers) of the faces that may be loaded.
std::set<int> chosen_nodes(const FlexibilityTask& task) {
  const std::vector<int>& node = task.surface.node;
  std::set<int> chosen;
  if (task.loaded.empty())
    for (std::size_t i = 0; i < node.size(); ++i) chosen.insert(static_cast<int>(i));
  for (const std::string& name : task.loaded)
    for (const mesh::Face& face : mesh::face_set(task.mesh, name))
      for (int corner : face) {
        const auto at = std::lower_bound(node.begin(), node.end(), corner);
        require(at != node.end() && *at == corner, "face set '", name, "' of the flexibility: node ", corner,
                " is not on the contact surface; add the set to -surface");
        chosen.insert(static_cast<int>(at - node.begin()));
      }
  return chosen;
}

// All surface nodes in orbits of the chosen ones.
std::vector<int> with_images(const FlexibilityTask& task, const std::set<int>& chosen) {
  const std::vector<int>&node = task.surface.node, &orbit = task.repetition.orbit;
  std::set<int> orbits;
  for (int i : chosen) orbits.insert(orbit[node[i]]);
  std::vector<int> all;
  for (std::size_t i = 0; i < node.size(); ++i)
    if (orbits.contains(orbit[node[i]])) all.push_back(static_cast<int>(i));
  return all;
}

// All nodes of the mesh in orbits of the given ones, ascending.
std::vector<int> images_of(const std::vector<int>& nodes, const mesh::Repetition& repetition) {
  std::set<int> orbits;
  for (int node : nodes) orbits.insert(repetition.orbit[node]);
  std::vector<int> all;
  for (std::size_t node = 0; node < repetition.orbit.size(); ++node)
    if (orbits.contains(repetition.orbit[node])) all.push_back(static_cast<int>(node));
  return all;
}

// Are stresses recovered alike at all images of a node? nodes: with all images, ascending.
bool recovers_alike(const FlexibilityTask& task, const std::vector<int>& nodes) {
  const std::vector<int>& loaded = task.stressed.recovery.loaded;
  std::vector<int> both;
  std::set_intersection(nodes.begin(), nodes.end(), loaded.begin(), loaded.end(), std::back_inserter(both));
  return images_of(both, task.repetition) == both;
}

std::vector<int> positions(const std::vector<int>& nodes, const std::vector<int>& in) {
  std::vector<int> at;
  for (int node : nodes)
    at.push_back(static_cast<int>(std::lower_bound(in.begin(), in.end(), node) - in.begin()));
  return at;
}

// Images of the nodes (mesh numbers); nothing when some image of a node is not in the list.
std::optional<model::Images> find_images(const std::vector<int>& nodes, const mesh::Repetition& repetition) {
  const int Z = repetition.turn.n_sectors;
  std::map<int, int> number;  // of the mesh's orbits
  std::vector<int> orbit, sector_index;
  for (int node : nodes) {
    orbit.push_back(number.emplace(repetition.orbit[node], static_cast<int>(number.size())).first->second);
    sector_index.push_back(repetition.sector_index[node]);
  }
  if (nodes.size() != number.size() * static_cast<std::size_t>(Z)) return {};
  return model::make_images(orbit, sector_index, Z, "nodes of the flexibility");
}

std::vector<int> mesh_numbers(const FlexibilityTask& task, const std::vector<int>& local) {
  std::vector<int> numbers;
  for (int i : local) numbers.push_back(task.surface.node[i]);
  return numbers;
}

// Mesh numbers of the nodes on which the forces of each orbit act.
std::vector<int> first_nodes(const FlexibilityTask& task, const model::Flexibility& flexibility) {
  std::vector<int> nodes;
  for (Eigen::Index orbit = 0; orbit < flexibility.surface.node.cols(); ++orbit)
    nodes.push_back(task.surface.node[flexibility.node[flexibility.surface.node(0, orbit)]]);
  return nodes;
}

// Enters the displacements (3 n_nodes) that one force causes as column j.
void enter(const FlexibilityTask& task, const Eigen::VectorXd& u, Eigen::Index j,
           model::Flexibility& flexibility) {
  for (std::size_t i = 0; i < flexibility.node.size(); ++i)
    flexibility.F.block<3, 1>(static_cast<Eigen::Index>(3 * i), j) =
        u.segment<3>(3 * task.surface.node[flexibility.node[i]]).cast<float>();
  if (flexibility.G.rows() > 0)
    flexibility.G.col(j) = (task.S.topRows(flexibility.G.rows()) * u).cast<float>();
}

// Static solutions of the whole body.
class Solver {
 public:
  explicit Solver(const ElasticSystem& system)
      : gather_(system.gather),
        relief_(system.rigid ? std::make_optional<InertiaRelief>(system.M, *system.rigid) : std::nullopt),
        grounded_(relief_ ? relief_->ground(system.K) : UniqueMat()),
        factor_(relief_ ? grounded_.get() : system.K, system.M) {
    check(MatCreateVecs(system.K, vec_.out(), nullptr));
    check(VecGetLocalSize(vec_, &n_own_));
    factor_.factorise(0);
  }

  /// visit(j, u) for unit forces in direction j % 3 on node j / 3 of n_loads. force: 3 n_nodes zeros on rank
  /// 0; node: mesh numbers, there.
  template <class Visit>
  void operator()(const int* node, int n_loads, Eigen::VectorXd& force, Visit&& visit) {
    MatrixXd U(n_own_, 3 * n_loads);
    for (int j = 0; j < U.cols(); ++j) {
      if (node) force(3 * node[j / 3] + j % 3) = 1;
      gather_.scatter(force, vec_);
      if (node) force(3 * node[j / 3] + j % 3) = 0;
      const PetscScalar* values = nullptr;
      check(VecGetArrayRead(vec_, &values));
      U.col(j) = Eigen::Map<const Eigen::VectorXd>(values, n_own_);
      check(VecRestoreArrayRead(vec_, &values));
    }
    if (relief_) relief_->balance(U);
    factor_.solve(U);
    if (relief_) relief_->release(U);
    for (int j = 0; j < U.cols(); ++j) {
      PetscScalar* values = nullptr;
      check(VecGetArrayWrite(vec_, &values));
      std::copy(U.col(j).begin(), U.col(j).end(), values);
      check(VecRestoreArrayWrite(vec_, &values));
      const Eigen::VectorXd u = gather_(vec_);
      if (node) visit(j, u);
    }
  }

 private:
  const fem::VectorGather& gather_;
  std::optional<InertiaRelief> relief_;  // of a free body
  UniqueMat grounded_;
  ShiftedFactor factor_;
  UniqueVec vec_;
  PetscInt n_own_ = 0;
};

}  // namespace

model::Flexibility plan_flexibility(const FlexibilityTask& task) {
  model::Flexibility flexibility;
  const std::set<int> chosen = chosen_nodes(task);
  if (task.repetition.turn.n_sectors > 1) {
    const std::vector<int> all = with_images(task, chosen),
                           rows = images_of(task.stress_node, task.repetition);
    const auto surface = find_images(mesh_numbers(task, all), task.repetition),
               stress = find_images(rows, task.repetition);
    if (surface && stress && recovers_alike(task, rows))
      return {task.repetition.turn.n_sectors,
              task.repetition.turn.axis,
              all,
              *surface,
              *stress,
              positions(task.stress_node, rows),
              {},
              {},
              {}};
  }
  flexibility.node.assign(chosen.begin(), chosen.end());
  flexibility.surface = model::no_images(static_cast<int>(chosen.size()));
  flexibility.stress = model::no_images(static_cast<int>(task.stress_node.size()));
  flexibility.stress_row = positions(task.stress_node, task.stress_node);
  return flexibility;
}

std::vector<int> stress_nodes(const FlexibilityTask& task, const model::Flexibility& flexibility) {
  return flexibility.n_sectors > 1 ? images_of(task.stress_node, task.repetition) : task.stress_node;
}

StaticResponseCost forecast(const FlexibilityTask& task, const model::Flexibility& plan, std::size_t n_free,
                            int n_ranks) {
  // Factors for a three-dimensional mesh after nested dissection (docs/performance.md): entries of the factor
  // and flops of the factorisation; speed of a core with many right-hand sides.
  constexpr double kEntries = 17, kFactorFlops = 8, kSpeed = 25e9, kSingle = 4, kDouble = 8;
  const int Z = plan.n_sectors, n_factors = Z / 2 + 1;
  const double n_orbits = static_cast<double>(plan.surface.node.cols()),
               unknowns =
                   static_cast<double>(n_free) / Z * (Z > 2 ? 2 : 1),  // real form of a complex harmonic
      entries = kEntries * std::pow(unknowns, 4. / 3);
  const double solved = 3 * n_orbits * n_factors,
               flops = n_factors * kFactorFlops * unknowns * unknowns + solved * 4 * entries;
  const double rows =
      3. * static_cast<double>(plan.node.size()) + 6. * static_cast<double>(stress_nodes(task, plan).size());
  StaticResponseCost cost;
  cost.n_nodes = plan.node.size();
  cost.n_columns = static_cast<std::size_t>(solved);
  cost.seconds = flops / (kSpeed * n_ranks);
  cost.bytes =
      rows * 3 * n_orbits * kSingle * (Z > 1 ? n_ranks : 1) + entries * kDouble * (Z > 1 ? n_ranks : 1);
  return cost;
}

model::Flexibility find_flexibility(const FlexibilityTask& task, const ElasticSystem& system,
                                    const Progress& progress) {
  const MPI_Comm comm = comm_of(system.K);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  model::Flexibility flexibility;
  std::vector<int> node;
  Eigen::VectorXd force;
  collectively(comm, [&] {
    if (rank != 0) return;
    flexibility = plan_flexibility(task);
    node = first_nodes(task, flexibility);
    force.setZero(task.mesh.X.size());
    flexibility.F.resize(3 * static_cast<Eigen::Index>(flexibility.node.size()),
                         static_cast<Eigen::Index>(3 * node.size()));
    flexibility.G.resize(6 * static_cast<Eigen::Index>(task.stress_node.size()), flexibility.F.cols());
  });
  int n_loads = static_cast<int>(node.size());
  MPI_Bcast(&n_loads, 1, MPI_INT, 0, comm);
  Solver solve(system);
  for (int first = 0; first < n_loads; first += kBlock) {
    const int n = std::min(kBlock, n_loads - first);
    solve(rank == 0 ? node.data() + first : nullptr, n, force,
          [&](int j, const Eigen::VectorXd& u) { enter(task, u, 3 * first + j, flexibility); });
    report(progress, kStage, static_cast<double>(first + n) / n_loads);
  }
  if (rank == 0) model::set_self(flexibility);
  return flexibility;
}

}  // namespace elastogear::reduction
