#pragma once
// The body file (HDF5, docs/file_format.md): written by reduction, read by dynamics and recovery.

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "elastogear/io/precision.h"
#include "elastogear/mesh/mesh.h"
#include "elastogear/model/check.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/model/material.h"
#include "elastogear/model/stress_recovery.h"

namespace elastogear::io {

/// Contents of a body file beside the ElasticBody: all that whole-field recovery needs.
struct BodySource {
  mesh::Mesh mesh;
  std::vector<model::MaterialRegion> regions;
  model::Element element = model::Element::incompatible;
  model::ElementMass element_mass = model::ElementMass::compatible;
  std::vector<int> free_dof;  ///< n_free, ascending: dof 3 node + direction that is not restrained
  std::vector<model::Check> checks = {};  ///< of the reduction
  Eigen::Vector3d origin = {0, 0,
                            0};  ///< m, of the body frame in the coordinates of the mesh that was reduced
  model::StressRecovery recovery = {};
};

/// Results of the checks of the modes; empty for a full basis.
struct ModeChecks {
  Eigen::VectorXd residual;  ///< n_modes, |K phi - omega^2 M phi| / |K phi|
  double orthogonality = 0;  ///< largest |phi_i' M phi_j|, i != j
};

/// Writes a body file under a temporary name beside `path`; finish() renames it. Destroyed unfinished:
/// nothing stays.
class BodyWriter {
 public:
  /// n_modes: 0 when the modes are not to be stored in full.
  BodyWriter(const std::string& path, int n_nodes, int n_modes, Precision precision = Precision::float64);
  ~BodyWriter();
  /// Makes room for n modes more than the constructor was told of.
  void add_modes(int n);
  /// Full displacement vector of one mode, 3 n_nodes (node-major), stored as row `index` of /modes/Phi.
  void write_mode(int index, const Eigen::VectorXd& phi);
  /// The next columns of F and G of the body's flexibility, ascending: what would otherwise be written by
  /// finish() need not be in memory as a whole. plan: loaded nodes and evaluation nodes. Error when they are
  /// not finite.
  void write_responses(const model::Flexibility& plan, const Eigen::MatrixXf& F, const Eigen::MatrixXf& G);
  /// Flexibility::read_F of what write_responses() has written, until finish() and as long as this lives.
  std::function<Eigen::MatrixXf(int orbit)> written_responses() const;
  void finish(const model::ElasticBody& body, const BodySource& source, const ModeChecks& checks = {});

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Purpose for which a body is read. `motion` leaves `stress` empty, which may be most of the file.
enum class BodyUse { all, motion };
/// Reads and validates, without flexibility.G; throws Error naming the file and what is wrong with it.
model::ElasticBody read_body(const std::string& path, BodyUse use = BodyUse::all);
/// Node sets whose stresses can be recovered.
std::vector<std::string> read_stress_set_names(const std::string& path);
/// The three columns of flexibility.G that belong to one orbit, 6 n_r x 3, Pa/N.
Eigen::MatrixXf read_stress_responses(const std::string& path, int orbit);
BodySource read_body_source(const std::string& path);
/// Empty when the file holds none.
ModeChecks read_mode_checks(const std::string& path);
/// Returns whether the file holds the modes at all nodes.
bool has_full_modes(const std::string& path);
/// Whole-body displacements Phi Q of k states Q (n_q x k): 3 n_nodes x k, m, node-major, BRF. Streams
/// /modes/Phi (modal) or scatters Q (full). Error with the remedy when the modes are not stored in full.
Eigen::MatrixXd read_displacement_fields(const std::string& path, const Eigen::MatrixXd& Q);
/// The same of one state: 3 x n_nodes.
Eigen::Matrix3Xd read_displacement_field(const std::string& path, const Eigen::VectorXd& q);
/// Calls visit(k, phi) for each of the n_q modes of a modal basis, phi: 3 n_nodes, node-major; one mode is in
/// memory at a time. Error with the remedy when the modes are not stored in full.
void visit_modes(const std::string& path, Eigen::Index n_q,
                 const std::function<void(Eigen::Index k, const Eigen::VectorXd& phi)>& visit);

}  // namespace elastogear::io
