#include "io/result/contact_forces.h"

#include "elastogear/base/error.h"
#include "elastogear/io/result_file.h"
#include "elastogear/model/face_point.h"

namespace elastogear::io {
namespace {

// Calls add(node, f) for the forces of one contact, N, on the nodes of a body, in the world frame. face: of
// the body's surface, if the contact's master is the body.
template <class Add>
void visit_forces(const model::ContactRecord& contact, int side, const Eigen::Matrix4Xi& face,
                  const Add& add) {
  if (contact.slave_side == side) return add(contact.slave_node, contact.f);
  const Eigen::Vector4d N = model::face_shares(contact.xi, contact.eta);
  for (int i = 0; i < 4; ++i) add(face(i, contact.face), Eigen::Vector3d(-N[i] * contact.f));
}

}  // namespace

std::vector<NodalForce> forces_of_points(const std::string& path, const std::string& body,
                                         const model::Surface& surface) {
  const model::ResultHeader header = read_result_header(path);
  const Eigen::MatrixXd R_WB = read_joint_history(path, body).R_WB;
  std::vector<NodalForce> all;
  for (const auto& pair : header.pairs)
    for (int side : {0, 1}) {
      if (header.bodies[pair.body[side]].name != body) continue;
      const auto contacts = read_contacts(path, pair.name);
      for (Eigen::Index step = 0; step < R_WB.cols(); ++step) {
        const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(R_WB.col(step).data());
        for (const model::ContactRecord& contact : contacts[static_cast<std::size_t>(step)]) {
          require(contact.slave_side == side || (contact.face >= 0 && contact.face < surface.face.cols()),
                  path, ": a contact names face ", contact.face, " of '", body, "', whose surface has 0..",
                  surface.face.cols() - 1, ": is this the body file of the run?");
          visit_forces(contact, side, surface.face, [&](int node, const Eigen::Vector3d& f) {
            all.push_back({step, node, R.transpose() * f});
          });
        }
      }
    }
  return all;
}

}  // namespace elastogear::io
