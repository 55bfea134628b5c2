// Uses an installed elastogear as any other program would: meshes the reference wheel and weighs it.
#include <cmath>
#include <cstdio>

#include "elastogear/base/petsc.h"
#include "elastogear/base/version.h"
#include "elastogear/fem/inertia.h"
#include "elastogear/gear/wheel.h"

int main(int argc, char** argv) {
  namespace eg = elastogear;
  const eg::Session session(argc, argv);
  const eg::mesh::Mesh wheel = eg::gear::wheel_mesh({}, eg::gear::wheel_counts(eg::gear::Size::tiny));
  const auto moments = eg::fem::mass_moments(wheel, {{"", {.E = 210e9, .nu = 0.3, .rho = 7850}}});
  const eg::model::Inertia inertia = eg::fem::rigid_inertia(wheel, moments);
  std::printf("elastogear %s: the wheel has %d nodes, %.4g kg and %.4g kg m^2 about its axis\n",
              eg::version(), wheel.n_nodes(), inertia.m, inertia.J(2, 2));
  return std::isfinite(inertia.m) && inertia.m > 0 ? 0 : 1;
}
