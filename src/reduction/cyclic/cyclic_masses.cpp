#include "reduction/cyclic/cyclic_masses.h"

#include <numeric>

#include "elastogear/base/collectively.h"
#include "elastogear/fem/sector_assembly.h"

namespace elastogear::reduction {
namespace {

constexpr int kRigidHarmonics = 2;   // 0 and 1
constexpr double kRoundoff = 1e-12;  // relative: so little of a motion's momentum is none

}  // namespace

SixDirections cyclic_mobile_masses(MPI_Comm comm, const fem::MeshedBody& body,
                                   const mesh::Repetition& repetition, const fem::MassMoments& moments,
                                   const Eigen::Vector3d& c) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  fem::NodeOrbits node_orbits;
  fem::Sector sector;
  collectively(comm, [&] {
    if (rank != 0) return;
    node_orbits = fem::free_node_orbits(repetition, body.is_free);
    sector = fem::make_sector(body.mesh, repetition, body.region, node_orbits);
  });
  fem::broadcast(comm, sector);
  SixDirections masses = SixDirections::Zero();
  for (int k = 0; k < kRigidHarmonics; ++k) {
    const fem::Harmonic harmonic = fem::make_harmonic(sector, k);
    if (harmonic.size() == 0) continue;
    const UniqueMat M = fem::assemble_mass(comm, sector, harmonic, body.regions, body.formulation);
    UniqueVec layout;
    check(MatCreateVecs(M, layout.out(), nullptr));
    std::vector<int> all(rank == 0 ? harmonic.size() : 0);
    std::iota(all.begin(), all.end(), 0);
    const fem::VectorGather gather(layout, all, harmonic.size());
    masses += inverse_masses(M, [&](int direction, Vec p) {
      Eigen::VectorXd g;
      if (rank == 0) {
        const Eigen::VectorXd momentum = rigid_momentum(moments, c, direction);
        g = fem::project_forces(harmonic, node_orbits, momentum);
        if (g.norm() <= kRoundoff * momentum.norm()) g.setZero();
      }
      gather.scatter(g, p);
    });
  }
  return masses;
}

}  // namespace elastogear::reduction
