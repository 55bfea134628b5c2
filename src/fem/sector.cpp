#include "elastogear/fem/sector.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "elastogear/base/broadcast.h"
#include "elastogear/base/rotation.h"

namespace elastogear::fem {
namespace {

// Re and Im of A z as one real matrix that takes Re z and Im z.
Eigen::MatrixXd in_parts(const Eigen::MatrixXcd& A) {
  Eigen::MatrixXd parts(2 * A.rows(), 2 * A.cols());
  parts << A.real(), -A.imag(), A.imag(), A.real();
  return parts;
}

// Amplitudes z of a node on the axis: R z exp(i k alpha) = z. Columns: one for each that there is.
// docs/theory, Eq. (2.12).
Eigen::MatrixXcd directions_on_axis(const mesh::Turn& turn, int k) {
  const Eigen::Vector3d e_1 = turn.axis.unitOrthogonal(), e_2 = turn.axis.cross(e_1);
  Eigen::MatrixXcd P(3, 0);
  if (k == 0) {
    P = turn.axis.cast<std::complex<double>>();
  } else if (k == 1 && turn.n_sectors == 2) {
    P.resize(3, 2);
    P << e_1, e_2;
  } else if (k == 1) {
    P.resize(3, 1);
    P.real() = e_1 / std::numbers::sqrt2;
    P.imag() = e_2 / std::numbers::sqrt2;
  }
  return P;
}

// Positions of the first nodes of the orbits, from a point on the axis.
Eigen::Matrix3Xd first_positions(const Sector& sector) {
  const mesh::Turn& turn = sector.turn;
  Eigen::Matrix3Xd x(3, sector.n_orbits());
  for (std::size_t node = 0; node < sector.node_orbits.orbit.size(); ++node) {
    const int orbit = sector.node_orbits.orbit[node];
    if (orbit < 0) continue;
    const double angle = 2 * std::numbers::pi / turn.n_sectors * sector.node_orbits.sector_index[node];
    x.col(orbit) = rotation_matrix(-angle * turn.axis) *
                   (sector.mesh.X.col(static_cast<Eigen::Index>(node)) - turn.point);
  }
  return x;
}

// Real coordinates of amplitudes at the first nodes of all orbits.
Eigen::VectorXd coordinates(const Harmonic& harmonic, const Sector& sector, const Eigen::Matrix3Xcd& z) {
  Eigen::VectorXd all(harmonic.size());
  for (int orbit = 0; orbit < sector.n_orbits(); ++orbit) {
    const Eigen::MatrixXd& Q = harmonic.at(sector.on_axis[orbit], 0);  // orthonormal columns
    Eigen::VectorXd parts(Q.rows());
    parts.head<3>() = z.col(orbit).real();
    if (!harmonic.real) parts.tail<3>() = z.col(orbit).imag();
    all.segment(harmonic.first[orbit], Q.cols()) = Q.transpose() * parts;
  }
  return all;
}

// Displacements of nodes from the coordinates of their orbits: visit(node, first coordinate, T).
template <class Visit>
void visit_nodes(const Harmonic& harmonic, const NodeOrbits& node_orbits, const Visit& visit) {
  const double scale = std::sqrt((harmonic.real ? 1.0 : 2.0) / harmonic.n_sectors);
  const Eigen::Index n = harmonic.turned.front().cols();
  const Eigen::Matrix3Xd on_axis = scale * harmonic.on_axis.topRows<3>();
  std::vector<Eigen::Matrix3Xd> turned;
  for (const Eigen::MatrixXd& Q : harmonic.turned) turned.emplace_back(scale * Q.topRows<3>());
  for (std::size_t node = 0; node < node_orbits.orbit.size(); ++node) {
    const int orbit = node_orbits.orbit[node];
    if (orbit < 0) continue;
    const int first = harmonic.first[orbit];
    const auto at = static_cast<Eigen::Index>(node);
    if (harmonic.first[orbit + std::size_t{1}] - first < n)
      visit(at, first, on_axis);
    else
      visit(at, first, turned[node_orbits.sector_index[node]]);
  }
}

}  // namespace

NodeOrbits free_node_orbits(const mesh::Repetition& repetition, const std::vector<bool>& is_free) {
  std::vector<int> number(repetition.on_axis.size(), -1);
  NodeOrbits node_orbits{std::vector<int>(is_free.size(), -1), repetition.sector_index};
  int n_free = 0;
  for (std::size_t node = 0; node < is_free.size(); ++node) {
    const int orbit = repetition.orbit[node];
    if (orbit < 0 || !is_free[node]) continue;
    if (number[orbit] < 0) number[orbit] = n_free++;
    node_orbits.orbit[node] = number[orbit];
  }
  return node_orbits;
}

Sector make_sector(const mesh::Mesh& mesh, const mesh::Repetition& repetition, const std::vector<int>& region,
                   const NodeOrbits& node_orbits) {
  Sector sector;
  sector.turn = repetition.turn;
  std::vector<int> local(static_cast<std::size_t>(mesh.n_nodes()), -1), nodes, cell_nodes;
  for (std::size_t i = 0; i < repetition.cell.size(); ++i) {
    const int cell = repetition.cell[i];
    cell_nodes.clear();
    for (int node : mesh.cells[cell]) {
      if (local[node] < 0) {
        local[node] = static_cast<int>(nodes.size());
        nodes.push_back(node);
      }
      cell_nodes.push_back(local[node]);
    }
    sector.mesh.cells.add(mesh.cells.type[cell], cell_nodes);
    sector.region.push_back(region[cell]);
    sector.weight.push_back(repetition.cell_count[i] / static_cast<double>(sector.turn.n_sectors));
  }
  sector.mesh.X = mesh.X(Eigen::all, nodes);
  const int n_orbits = node_orbits.orbit.empty() ? 0 : 1 + *std::ranges::max_element(node_orbits.orbit);
  sector.on_axis.resize(static_cast<std::size_t>(n_orbits));
  for (int node : nodes) {
    const int orbit = node_orbits.orbit[node];
    sector.node_orbits.orbit.push_back(orbit);
    sector.node_orbits.sector_index.push_back(node_orbits.sector_index[node]);
    if (orbit >= 0) sector.on_axis[orbit] = repetition.on_axis[repetition.orbit[node]];
  }
  return sector;
}

void broadcast(MPI_Comm comm, Sector& sector) {
  std::vector<mesh::Turn> turn{sector.turn};
  std::vector<double> X(sector.mesh.X.reshaped().begin(), sector.mesh.X.reshaped().end());
  elastogear::broadcast(comm, turn);
  elastogear::broadcast(comm, X);
  elastogear::broadcast(comm, sector.mesh.cells.type);
  elastogear::broadcast(comm, sector.mesh.cells.offset);
  elastogear::broadcast(comm, sector.mesh.cells.nodes);
  elastogear::broadcast(comm, sector.region);
  elastogear::broadcast(comm, sector.weight);
  elastogear::broadcast(comm, sector.node_orbits.orbit);
  elastogear::broadcast(comm, sector.node_orbits.sector_index);
  elastogear::broadcast(comm, sector.on_axis);
  sector.turn = turn.front();
  sector.mesh.X = Eigen::Map<const Eigen::Matrix3Xd>(X.data(), 3, static_cast<Eigen::Index>(X.size() / 3));
}

Sector cut_open(const Sector& sector) {
  Sector open = sector;
  int n_free = 0;
  for (int& orbit : open.node_orbits.orbit)
    if (orbit >= 0) orbit = n_free++;
  open.on_axis.assign(static_cast<std::size_t>(n_free), 0);
  return open;
}

Harmonic make_harmonic(const Sector& sector, int k) {
  const int Z = sector.turn.n_sectors;
  const double alpha = 2 * std::numbers::pi / Z;
  Harmonic harmonic{k, Z, k == 0 || 2 * k == Z, {}, {}, {0}};
  for (int j = 0; j < Z; ++j) {
    const Eigen::Matrix3d R = rotation_matrix(alpha * j * sector.turn.axis);
    const std::complex<double> phase = std::polar(1.0, alpha * (static_cast<long>(j) * k % Z));
    harmonic.turned.push_back(harmonic.real ? Eigen::MatrixXd(std::round(phase.real()) * R)
                                            : in_parts(phase * R.cast<std::complex<double>>()));
  }
  const Eigen::MatrixXcd P = directions_on_axis(sector.turn, k);
  harmonic.on_axis = harmonic.real ? Eigen::MatrixXd(P.real()) : in_parts(P);
  for (bool axis : sector.on_axis)
    harmonic.first.push_back(harmonic.first.back() + static_cast<int>(harmonic.at(axis, 0).cols()));
  return harmonic;
}

Eigen::VectorXd unfold(const Harmonic& harmonic, const NodeOrbits& node_orbits,
                       const Eigen::Ref<const Eigen::VectorXd>& z) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(node_orbits.orbit.size()));
  visit_nodes(harmonic, node_orbits, [&](Eigen::Index node, int first, const auto& T) {
    u.segment<3>(3 * node).noalias() = T * z.segment(first, T.cols());
  });
  return u;
}

Eigen::VectorXd project_forces(const Harmonic& harmonic, const NodeOrbits& node_orbits,
                               const Eigen::Ref<const Eigen::VectorXd>& f) {
  Eigen::VectorXd g = Eigen::VectorXd::Zero(harmonic.size());
  visit_nodes(harmonic, node_orbits, [&](Eigen::Index node, int first, const auto& T) {
    g.segment(first, T.cols()) += T.transpose() * f.segment<3>(3 * node);
  });
  return g;
}

Eigen::MatrixXd rigid_fields(const Harmonic& harmonic, const Sector& sector) {
  using Complex = std::complex<double>;
  if (harmonic.k > 1) return Eigen::MatrixXd(harmonic.size(), 0);
  const Eigen::Vector3d e = sector.turn.axis, e_1 = e.unitOrthogonal(), e_2 = e.cross(e_1);
  std::vector<Eigen::Vector3cd> direction;  // a translation along it, and a rotation about it
  if (harmonic.k == 0) {
    direction = {e.cast<Complex>()};
  } else if (harmonic.real) {
    direction = {e_1.cast<Complex>(), e_2.cast<Complex>()};
  } else {
    const Eigen::Vector3cd d = e_1.cast<Complex>() + Complex(0, 1) * e_2.cast<Complex>();
    direction = {d, Complex(0, 1) * d};
  }
  const Eigen::Matrix3Xcd x = first_positions(sector).cast<Complex>();
  Eigen::MatrixXd fields(harmonic.size(), 2 * static_cast<Eigen::Index>(direction.size()));
  Eigen::Index column = 0;
  for (const Eigen::Vector3cd& d : direction) {
    Eigen::Matrix3cd turn;  // conjugates nothing, as Eigen's cross product of complex vectors does
    turn << 0, -d(2), d(1), d(2), 0, -d(0), -d(1), d(0), 0;
    fields.col(column++) = coordinates(harmonic, sector, d.replicate(1, x.cols()));
    fields.col(column++) = coordinates(harmonic, sector, turn * x);
  }
  return fields;
}

Eigen::MatrixXd times_i(const Harmonic& harmonic, int first_orbit,
                        const Eigen::Ref<const Eigen::MatrixXd>& z) {
  Eigen::MatrixXd iz(z.rows(), z.cols());
  const int begin = harmonic.first[first_orbit];
  for (std::size_t orbit = first_orbit; harmonic.first[orbit] - begin < z.rows(); ++orbit) {
    const int at = harmonic.first[orbit] - begin,
              half = (harmonic.first[orbit + 1] - harmonic.first[orbit]) / 2;
    iz.middleRows(at, half) = -z.middleRows(at + half, half);
    iz.middleRows(at + half, half) = z.middleRows(at, half);
  }
  return iz;
}

}  // namespace elastogear::fem
