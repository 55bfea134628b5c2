#pragma once
// The result file (HDF5, docs/file_format.md): written by simulate, read by recover, compare, info and
// scripts.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/model/elastic_body.h"
#include "elastogear/model/result.h"

namespace elastogear::io {

/// Appends snapshots to parts in the folder `path`.partial; finish() joins them to the file. Each part
/// appears under its name only when whole and is never changed again. Destroyed unfinished: what was appended
/// since the last checkpoint is lost, the rest stays in the folder. A write that fails (WriteFailure) is the
/// last one: all that follow fail likewise, and what was written at the last checkpoint stays.
class ResultWriter {
 public:
  /// goes_on: after the last checkpoint of an earlier run; otherwise what that left is removed.
  ResultWriter(const std::string& path, const model::ResultHeader& header, bool goes_on = false);
  ~ResultWriter();
  /// Error when the time does not increase, numbers are not finite, or sizes differ from the header or the
  /// first snapshot.
  void append(const model::Snapshot& snapshot);
  /// Ends a part. From here on a killed run can go on from `state`.
  void checkpoint(const std::vector<double>& state);
  int n_times() const;  ///< appended, in earlier runs too
  /// Joins the parts into the file; nothing can be appended afterwards. When not complete, the parts stay
  /// beside the file, to go on from. Error when nothing was appended.
  void finish(bool complete = true);

 private:
  struct Part;
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Provenance and state that a run that did not end left in the folder `path`.partial.
struct UnfinishedRun {
  std::map<std::string, std::string> provenance;
  std::vector<double> state;  ///< of its last checkpoint
  double time = 0;            ///< s, last that it wrote before
};
/// Reads the last checkpoint of an unfinished run; nothing when there is none. Error when it is damaged.
std::optional<UnfinishedRun> read_unfinished_run(const std::string& path);

/// Histories of one body, one column per output time.
struct BodyHistory {
  Eigen::MatrixXd q, q_dot, q_ddot;  ///< n_q x n_t
  Eigen::MatrixXd s, s_dot, s_ddot;  ///< n_s x n_t, joint coordinates
  Eigen::MatrixXd r_WB;              ///< 3 x n_t
  Eigen::MatrixXd R_WB;              ///< 9 x n_t, row-major rotation matrix
  Eigen::MatrixXd w = {};        ///< n_q n_p x n_t, part by part, of viscoelastic bodies: model::BodyState
  Eigen::MatrixXd q_error = {};  ///< n_q x n_t, of q by the steps in time; empty: none is known
};

/// Histories of one pair, one column per output time. Forces on body b in the world frame, see
/// model::PairState.
struct PairHistory {
  Eigen::MatrixXd force;           ///< 3 x n_t, N
  Eigen::MatrixXd torque;          ///< 3 x n_t, N m, about the world origin
  Eigen::VectorXi count;           ///< n_t
  Eigen::VectorXd penetration;     ///< n_t, m
  Eigen::VectorXd area, pressure;  ///< n_t, m^2, Pa; these and the following: model::ContactFigures
  Eigen::VectorXd sliding_speed, friction_power, damping_power;  ///< n_t, m/s, W
  std::vector<std::string> group_name[2];                        ///< face groups of surface a, b
  Eigen::MatrixXd group_force[2];                                ///< 3 n_g x n_t, N, rows 3 g .. 3 g + 2
};

/// n_t each, J; see model::Energies.
struct EnergyHistory {
  Eigen::VectorXd kinetic, elastic, contact, dissipated, work, balance;
  Eigen::VectorXd bushing;     ///< zero in a run without bushings
  Eigen::VectorXd relaxation;  ///< zero in a run without viscoelastic materials
};

/// Histories of one bushing, 3 x n_t each; see model::BushingState.
struct BushingHistory {
  Eigen::MatrixXd displacement, angle, force, torque;
};

/// Histories of one sensor, 3 x n_t each but for the rotation, 9 x n_t: row-major matrix.
struct SensorHistory {
  Eigen::MatrixXd position, velocity, acceleration, rotation, angular_velocity;
};

/// Readers throw Error naming the file and what is missing or wrong. Bodies and pairs go by name.
model::ResultHeader read_result_header(const std::string& path);
/// Did the run reach its end? Files that do not say so are taken to be complete.
bool is_complete(const std::string& path);
Eigen::VectorXd read_times(const std::string& path);
/// What a result, or stresses of one, are the outcome of; nothing where the file does not say it.
std::optional<model::RunInput> read_run_input(const std::string& path);
/// What the times of a result are, or of what was made of it.
struct TimeAxis {
  std::string name, unit;  ///< "time", "s"; "roll angle", "pitches"; "load factor", "1"
  /// "roll angle 0.25 pitches", "load factor 1", "t = 0.1 s".
  std::string at(double value) const;
};
/// That of a motion where nothing is known.
TimeAxis time_axis(const std::optional<model::RunInput>& input);
BodyHistory read_body_history(const std::string& path, const std::string& body);
/// History of a body without its elastic coordinates, of which a full basis has many.
BodyHistory read_joint_history(const std::string& path, const std::string& body);
/// Contact forces on a body with this surface, over all output times. Files of version 1 and 2 hold contact
/// points only: forces are taken to act along the facets' shape functions, without the couples of smoothed
/// surfaces and the forces at their free boundaries. Error when a node or face is named that the surface does
/// not have.
model::ForceHistory read_contact_forces(const std::string& path, const std::string& body,
                                        const model::Surface& surface);
PairHistory read_pair_history(const std::string& path, const std::string& pair);
EnergyHistory read_energies(const std::string& path);
BushingHistory read_bushing_history(const std::string& path, const std::string& bushing);
SensorHistory read_sensor_history(const std::string& path, const std::string& sensor);
/// The active contacts of a pair, one list per output time.
std::vector<std::vector<model::ContactRecord>> read_contacts(const std::string& path,
                                                             const std::string& pair);

}  // namespace elastogear::io
