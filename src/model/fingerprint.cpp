#include "elastogear/model/fingerprint.h"

#include "elastogear/base/fingerprint.h"

namespace elastogear::model {
namespace {

// Stored zeros do not count: files of dense matrices lose them.
template <class Sparse>
void add_sparse(Fingerprint& f, const Sparse& A) {
  f.add_all(std::vector<double>{double(A.rows()), double(A.cols())});
  for (int j = 0; j < A.outerSize(); ++j)
    for (typename Sparse::InnerIterator it(A, j); it; ++it)
      if (it.value() != 0) f.add_all(std::vector<double>{double(it.row()), double(it.col()), it.value()});
}

void add(Fingerprint& f, const BasisRows& rows) {
  if (const RowBounds* bounds = known_bounds(rows))
    return f.add_block(bounds->digest, static_cast<std::size_t>(row_count(rows) * column_count(rows)));
  if (const auto* dense = std::get_if<DenseRows>(&rows))
    return f.add_block(dense->data(), static_cast<std::size_t>(dense->size()));
  add_sparse(f, std::get<SparseRows>(rows));
}

void add(Fingerprint& f, const Inertia& inertia) {
  f.add(inertia.m);
  for (const Eigen::MatrixXd& M :
       {Eigen::MatrixXd(inertia.c), Eigen::MatrixXd(inertia.J), Eigen::MatrixXd(inertia.C_l),
        Eigen::MatrixXd(inertia.C_r), Eigen::MatrixXd(inertia.S_1)})
    f.add_all(M.reshaped());
  for (const BasisRows& rows : inertia.S_2) add(f, rows);
}

void add(Fingerprint& f, const Surface& surface) {
  f.add_all(surface.X.reshaped());
  f.add_all(surface.c_f);
  f.add_all(surface.node);
  f.add_all(surface.face.reshaped());
  if (surface.side.cols() > 0) f.add_all(surface.side.reshaped());
  f.add_all(surface.group);
  add(f, surface.Phi);
}

void add(Fingerprint& f, const RelaxingPart& part) {
  f.add_all(part.g);
  f.add_all(part.tau);
  add_sparse(f, part.K);
}

}  // namespace

std::string fingerprint(const ElasticBody& body) {
  Fingerprint f;
  f.add_all(std::vector<double>{double(body.floating), body.alpha, body.beta});
  add(f, body.inertia);
  add_sparse(f, body.M_r);
  add_sparse(f, body.K_r);
  add(f, body.surface);
  f.add_all(body.zeta);
  f.add_all(body.flexibility.node);
  f.add_all(body.flexibility.self);
  for (const RelaxedResponse& relaxed : body.flexibility.relaxed) f.add_all(relaxed.self);
  for (const Marker& marker : body.markers) {
    f.add_all(marker.X);
    add(f, marker.Phi);
    if (!marker.area) continue;
    f.add_all(marker.area->sum);
    f.add_all(marker.area->moment);
  }
  for (const RelaxingPart& part : body.relaxing) add(f, part);
  return f.text();
}

std::string identity_key(const std::string& body) { return "identity_" + body; }

std::string rigid_key(const std::string& body) { return "rigid_" + body; }

}  // namespace elastogear::model
