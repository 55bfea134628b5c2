#include "contact/search/surface_checks.h"

#include "elastogear/base/error.h"

namespace elastogear::contact {
namespace {
constexpr const char* kSurfaceName[2] = {"contact: surface a", "contact: surface b"};
}  // namespace

void validate(const model::Surface& surface, int side) {
  const auto n_s = surface.X.cols();
  require(surface.face.cols() > 0, kSurfaceName[side], " has no faces");
  require(surface.X.allFinite(), kSurfaceName[side], " has a node at a position that is not finite");
  require(surface.face.minCoeff() >= 0 && surface.face.maxCoeff() < n_s, kSurfaceName[side],
          " has a face with node ",
          surface.face.minCoeff() < 0 ? surface.face.minCoeff() : surface.face.maxCoeff(),
          ", allowed is 0 to ", n_s - 1);
}

void validate(const SurfaceState& state, const model::Surface& surface, int side) {
  require(state.x_B.cols() == surface.X.cols(), kSurfaceName[side], ": positions of ", state.x_B.cols(),
          " nodes given, the surface has ", surface.X.cols());
  require(state.r_WB.allFinite() && state.R_WB.allFinite(), kSurfaceName[side],
          ": the body's placement is not finite");
  if (state.x_B.allFinite()) return;
  for (Eigen::Index i = 0; i < state.x_B.cols(); ++i)
    require(state.x_B.col(i).allFinite(), kSurfaceName[side], ": position of node ", i, " is not finite");
}

void validate(const SurfaceMotion& motion, const model::Surface& surface, int side) {
  const Eigen::Index n_q = model::column_count(surface.Phi);
  require(motion.q.size() == n_q, kSurfaceName[side], ": ", motion.q.size(),
          " elastic coordinates given, the surface has ", n_q);
  require(motion.q_dot.size() == 0 || motion.q_dot.size() == n_q, kSurfaceName[side], ": ",
          motion.q_dot.size(), " elastic velocities given, the surface has ", n_q);
  require(motion.q.allFinite() && motion.r_WB.allFinite() && motion.R_WB.allFinite(), kSurfaceName[side],
          ": the body's placement or its elastic coordinates are not finite");
  require(motion.q_dot.allFinite() && motion.v_WB_B.allFinite() && motion.w_WB_B.allFinite(),
          kSurfaceName[side], ": the body's velocities are not finite");
}

}  // namespace elastogear::contact
