#include "elastogear/contact/stiffness.h"

#include "elastogear/base/error.h"
#include "elastogear/contact/topology.h"

namespace elastogear::contact {
namespace {

double mean_stiffness(const model::Surface& surface, char name) {
  const auto n_f = surface.face.cols();
  require(surface.c_f.size() == n_f && (surface.c_f.array() > 0).all() && surface.c_f.allFinite(),
          "contact: surface ", name,
          " has no positive stiffness c_f for each face: give the penalty stiffness");
  return surface.c_f.mean();
}

}  // namespace

double default_stiffness(const Settings& settings, const model::Surface& a, const model::Surface& b) {
  const double stiffness = 1 / (1 / mean_stiffness(a, 'a') + 1 / mean_stiffness(b, 'b'));
  if (settings.penalty == Penalty::per_area) return stiffness;
  const model::Surface& slave = settings.slave == 0 ? a : b;
  return stiffness * node_areas(slave.X, slave.face).mean();
}

Eigen::VectorXd node_stiffness(const Settings& settings, const model::Surface& slave) {
  const double c_p = settings.two_pass ? 0.5 * settings.stiffness : settings.stiffness;
  if (settings.penalty == Penalty::per_node) return Eigen::VectorXd::Constant(slave.X.cols(), c_p);
  return c_p * node_areas(slave.X, slave.face);
}

}  // namespace elastogear::contact
