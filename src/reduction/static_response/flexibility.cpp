#include "elastogear/reduction/flexibility.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "elastogear/base/collectively.h"
#include "elastogear/base/dense_product.h"
#include "elastogear/base/error.h"
#include "reduction/static_response/independent_rows.h"
#include "reduction/static_response/inertia_relief.h"
#include "reduction/static_response/nested_response.h"

namespace elastogear::reduction {
namespace {

constexpr const char* kStage = "static responses";
constexpr double kShareOfSpeed = 0.45;  // that static responses reach of the speed of large products

using Eigen::MatrixXd;

// Speed of large products in single precision on this core, flop/s, measured in some milliseconds.
double single_precision_speed() {
  using Clock = std::chrono::steady_clock;
  constexpr Eigen::Index kSize = 384;
  constexpr int kTimes = 3;  // the first one enters memory
  const Eigen::MatrixXf A = Eigen::MatrixXf::Ones(kSize, kSize);
  const Eigen::MatrixXf B = Eigen::MatrixXf::Ones(kSize, kSize);
  Eigen::MatrixXf C(kSize, kSize);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTimes; ++i) {
    const Clock::time_point start = Clock::now();
    multiply(Op::plain, Op::plain, 1.0F, A, B, 0.0F, C);
    least = std::min(least, std::chrono::duration<double>(Clock::now() - start).count());
  }
  return 2.0 * kSize * kSize * kSize / least;
}

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

// The wanted rows of the displacements, first those of the loaded nodes, then those of stresses. dof:
// displacement of each row of K.
model::SparseRows wanted_rows(const FlexibilityTask& task, const model::Flexibility& flexibility,
                              const IndependentRows& stress, const std::vector<int>& dof) {
  std::vector<int> row(static_cast<std::size_t>(task.mesh.X.size()), -1);
  for (std::size_t i = 0; i < dof.size(); ++i) row[dof[i]] = static_cast<int>(i);
  const int n_u = 3 * static_cast<int>(flexibility.node.size()), n_sigma = static_cast<int>(stress.W.rows());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n_u; ++i)
    if (const int j = row[3 * task.surface.node[flexibility.node[i / 3]] + i % 3]; j >= 0)
      entries.emplace_back(i, j, 1.0);
  for (int i = 0; i < n_sigma; ++i)
    for (model::SparseRows::InnerIterator it(stress.W, i); it; ++it)
      if (const int j = row[it.col()]; j >= 0) entries.emplace_back(n_u + i, j, it.value());
  model::SparseRows P(n_u + n_sigma, static_cast<Eigen::Index>(dof.size()));
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

// The rows of all ranks, one below the other, on rank 0.
MatrixXd gather_rows(MPI_Comm comm, const MatrixXd& own) {
  int rank = 0, size = 1, n_own = static_cast<int>(own.rows());
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  std::vector<int> n(size), first(size + 1, 0);
  MPI_Gather(&n_own, 1, MPI_INT, n.data(), 1, MPI_INT, 0, comm);
  for (int r = 0; r < size; ++r) first[r + 1] = first[r] + n[r];
  MatrixXd all(first[size], own.cols());
  for (Eigen::Index j = 0; j < own.cols(); ++j)
    MPI_Gatherv(own.col(j).data(), n_own, MPI_DOUBLE, all.col(j).data(), n.data(), first.data(), MPI_DOUBLE,
                0, comm);
  return all;
}

// The whole body on rank 0: what static responses need.
struct RootSystem {
  UniqueMat matrix = {};
  Mat K = nullptr;  // sequential; of a free body grounded
  RigidFields rigid = {};
};

RootSystem gather(const ElasticSystem& system) {
  RootSystem root;
  const MPI_Comm comm = comm_of(system.K);
  UniqueMat grounded;
  if (system.rigid) {
    const InertiaRelief relief(system.M, *system.rigid);
    grounded = relief.ground(system.K);
    const RigidFields own = relief.fields();
    root.rigid = {gather_rows(comm, own.R), gather_rows(comm, own.M_R)};
  }
  root.matrix = fem::on_root(grounded ? grounded.get() : system.K);
  root.K = root.matrix;
  int size = 1;
  MPI_Comm_size(comm, &size);
  if (size > 1) check(MatGetDiagonalBlock(root.matrix, &root.K));
  return root;
}

// Enters the responses to these of the loads.
void enter(const Eigen::MatrixXf& responses, const std::vector<int>& loads, const IndependentRows& stress,
           model::Flexibility& flexibility) {
  const Eigen::Index n_u = flexibility.F.rows();
  const Eigen::Matrix<float, 6, Eigen::Dynamic> Q = stress.Q.cast<float>();
  flexibility.F(Eigen::all, loads) = responses.topRows(n_u);
  for (int node = 0; node < stress.n_nodes(); ++node) {
    const int first = stress.first[node], n = stress.first[node + 1] - first;
    flexibility.G(Eigen::seqN(6 * node, 6), loads) =
        Q.middleCols(first, n) * responses.middleRows(n_u + first, n);
  }
}

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
  constexpr double kSingle = 4, kFreeSurface = 3;  // bytes; independent stresses at a node
  const int Z = plan.n_sectors, n_harmonics = Z / 2 + 1;
  const double n_loads = 3 * static_cast<double>(plan.surface.node.cols()),
               parts = Z > 2 ? 2 : 1,  // real form of a complex harmonic
      unknowns = parts * static_cast<double>(n_free) / Z,
               n_stress = static_cast<double>(stress_nodes(task, plan).size()),
               n_displacements = 3 * static_cast<double>(plan.node.size()),
               wanted = parts * (n_displacements + kFreeSurface * n_stress) / Z;
  const auto [nested, whole] = response_flops(unknowns, wanted, n_loads);
  const double flops = n_harmonics * std::min(nested, whole), separator = std::pow(unknowns, 2. / 3);
  const int at_work = std::min(n_ranks, n_harmonics);
  StaticResponseCost cost;
  cost.n_nodes = plan.node.size();
  cost.n_columns = static_cast<std::size_t>(n_loads) * static_cast<std::size_t>(n_harmonics);
  cost.seconds = flops / (kShareOfSpeed * single_precision_speed() * at_work);
  cost.kept_bytes = (n_displacements + 6 * n_stress) * n_loads * kSingle;
  // A cyclically symmetric body keeps the responses of all harmonics, from which F and G are made piece by
  // piece; any other body keeps F and G.
  const double responses = Z > 1 ? n_harmonics * wanted * n_loads * kSingle : cost.kept_bytes;
  cost.bytes = responses + 4 * wanted * separator * kSingle * at_work;
  return cost;
}

model::Flexibility find_flexibility(const FlexibilityTask& task, const ElasticSystem& system,
                                    const Progress& progress) {
  const MPI_Comm comm = comm_of(system.K);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const RootSystem root = gather(system);
  model::Flexibility flexibility;
  collectively(comm, [&] {
    if (rank != 0) return;
    flexibility = plan_flexibility(task);
    const auto n_stress = static_cast<Eigen::Index>(6 * task.stress_node.size());
    const IndependentRows stress = independent_rows(task.S.topRows(n_stress));
    const model::SparseRows P = wanted_rows(task, flexibility, stress, system.gather.dof());
    const auto n_u = static_cast<Eigen::Index>(3 * flexibility.node.size());
    std::vector<int> loads(static_cast<std::size_t>(n_u));
    std::iota(loads.begin(), loads.end(), 0);
    NestedResponse response(root.K, P, loads, root.rigid, 0,
                            [&](double share) { report(progress, kStage, share); });
    flexibility.F.resize(n_u, n_u);
    flexibility.G.resize(n_stress, n_u);
    for (const std::vector<int>& group : response.groups())
      enter(response.next(), group, stress, flexibility);
    fill_symmetric(response.groups(), [&](int load) { return flexibility.F.col(load).data(); });
    model::set_self(flexibility);
  });
  return flexibility;
}

}  // namespace elastogear::reduction
