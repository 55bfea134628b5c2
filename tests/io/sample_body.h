#pragma once
// Bodies with arbitrary but valid numbers, for the tests of files.

#include "../mesh/box_mesh.h"
#include "elastogear/io/body_file.h"

namespace elastogear::io {

inline BodySource sample_source() {
  BodySource source;
  source.mesh = mesh::box_mesh_with_sets({2, 1, 1});
  source.regions = {{"", {2.1e11, 0.3, 7850}}, {"even", {1.1e11, 0.34, 8800}}};
  source.element = model::Element::plain;
  source.element_mass = model::ElementMass::condensed;
  for (int dof = 12; dof < 3 * source.mesh.n_nodes(); ++dof) source.free_dof.push_back(dof);
  return source;
}

inline void add_surface_and_stress(model::ElasticBody& body, const mesh::Mesh& mesh) {
  body.surface.node = {0, 1, 3, 4, 6};
  body.surface.X = mesh.X(Eigen::all, body.surface.node);
  body.surface.face.resize(4, 2);
  body.surface.face << 0, 1, 1, 2, 2, 3, 3, 4;
  body.surface.group = {1, 0};
  body.surface.group_name = {"tooth_01_left", "tooth_01_right"};
  body.surface.c_f = Eigen::Vector2d(1.5e13, 1.7e13);
  body.stress.node = {2, 5};
  body.stress.X = mesh.X(Eigen::all, body.stress.node);
  body.stress.sets = {{"root", {0, 1}}, {"one", {1}}};
}

inline void add_inertia(model::ElasticBody& body, Eigen::Index n_q) {
  body.inertia.m = 1.0 / 3;
  body.inertia.c = Eigen::Vector3d(0.1, 0.2, 0.3);
  body.inertia.J << 3, 0.1, 0.2, 0.1, 4, 0.3, 0.2, 0.3, 5;
  body.inertia.C_l = Eigen::MatrixXd::Random(n_q, 3);
  body.inertia.C_r = Eigen::MatrixXd::Random(n_q, 3);
  body.inertia.S_1 = Eigen::MatrixXd::Random(9, n_q);
}

inline model::ElasticBody sample_modal_body(Eigen::Index n_q = 3) {
  model::ElasticBody body;
  body.name = "worm";
  body.frequency = Eigen::VectorXd::LinSpaced(n_q, 1000.0 / 3, 9000);
  const Eigen::VectorXd omega = 2 * M_PI * body.frequency;
  body.M_r = Eigen::MatrixXd::Identity(n_q, n_q).sparseView();
  body.K_r = Eigen::MatrixXd(omega.cwiseAbs2().asDiagonal()).sparseView();
  body.alpha = 0.1;
  body.beta = 1e-7;
  body.zeta = Eigen::VectorXd::LinSpaced(n_q, 0.01, 0.03);
  add_inertia(body, n_q);
  add_surface_and_stress(body, sample_source().mesh);
  body.surface.Phi = model::DenseRows(model::DenseRows::Random(15, n_q));
  body.stress.Psi = model::DenseRows(model::DenseRows::Random(12, n_q));
  body.markers = {{"bearing", {1, 2, 3}, true, model::DenseRows::Random(6, n_q)},
                  {"line", {4, 5, 6}, false, model::DenseRows::Random(6, n_q)}};
  body.provenance = {{"options", std::string(100000, 'x')}, {"elastogear", "0.1.0"}};
  return body;
}

inline model::ElasticBody sample_full_body() {
  const BodySource source = sample_source();
  const auto n_q = static_cast<Eigen::Index>(source.free_dof.size());
  model::ElasticBody body = sample_modal_body(n_q);
  body.basis = model::Basis::full;
  body.assembled_M = false;
  body.frequency.resize(0);
  body.zeta.resize(0);
  body.K_r.coeffRef(0, 1) = body.K_r.coeffRef(1, 0) = -1.0 / 7;
  model::SparseRows Phi(15, n_q), Psi(12, n_q);
  Phi.insert(12, 6) = 1;
  Phi.insert(13, 7) = 1;
  Psi.insert(3, 5) = 1e11 / 3;
  body.surface.Phi = Phi;
  body.stress.Psi = Psi;
  for (model::Marker& marker : body.markers)
    marker.Phi = model::SparseRows(std::get<model::DenseRows>(marker.Phi).sparseView());
  return body;
}

/// n_q vectors of 3 n_nodes.
inline Eigen::MatrixXd sample_modes(Eigen::Index n_q = 3) {
  return Eigen::MatrixXd::Random(3 * sample_source().mesh.n_nodes(), n_q);
}

inline void write_modal(const std::string& path, const model::ElasticBody& body,
                        const Eigen::MatrixXd& modes) {
  BodyWriter writer(path, static_cast<int>(modes.rows() / 3), static_cast<int>(modes.cols()));
  for (int k = 0; k < modes.cols(); ++k) writer.write_mode(k, modes.col(k));
  writer.finish(body, sample_source());
}

inline void write_full(const std::string& path, const model::ElasticBody& body) {
  BodyWriter(path, sample_source().mesh.n_nodes(), 0).finish(body, sample_source());
}

}  // namespace elastogear::io
