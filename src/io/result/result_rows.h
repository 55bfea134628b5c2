#pragma once
// Snapshots as rows of the result file's histories. Private to module io.

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "elastogear/model/result.h"
#include "io/hdf5/hdf5.h"

namespace elastogear::io {

constexpr const char* kSide[2] = {"a", "b"};    ///< the two bodies of a pair, as groups of the file
constexpr const char* kTimeError = "/q_error";  ///< by the steps in time: model::BodyState::q_error
constexpr const char* kRelaxed = "/q_relaxed";  ///< of a viscoelastic body: model::BodyState::w
constexpr const char* kRelaxationLoss = "/energy/relaxation";

/// Rows of the histories that come before a part of them.
struct RowCount {
  double last_time = -std::numeric_limits<double>::infinity();  ///< s
  int times = 0;                                                ///< before
  std::vector<double> contacts;                                 ///< before, by pair
  std::vector<double> forces;                                   ///< before, at nodes, by body
};

/// Appends to a file with a header; both must outlive it.
class ResultRows {
 public:
  ResultRows(const h5::File& file, const model::ResultHeader& header, RowCount before);
  /// Error when the snapshot does not fit the header or those before.
  void append(const model::Snapshot& snapshot);
  /// Writes what is buffered; no more can be appended.
  void close();
  bool empty() const { return series_.empty(); }
  const RowCount& count() const { return count_; }

 private:
  h5::Series& series_at(const std::string& name, const h5::Item& item);
  void append(const std::string& name, double value, const std::string& unit, bool integer = false);
  void append(const std::string& name, const Eigen::VectorXd& value, const std::string& unit);
  void append_rotation(const std::string& name, const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>& R);
  void append_offset(const std::string& group, double& count, std::size_t n);
  void append_body(std::size_t index, const model::BodyState& body);
  void append_forces(const std::string& group, const model::ContactForces& forces);
  void append_pair(std::size_t index, const model::PairState& pair);
  void append_total(const std::string& group, const model::ContactFigures& total);
  void append_areas(const std::string& group, std::vector<model::ContactFigures> areas, std::size_t n);
  void append_contacts(const std::string& group, const std::vector<model::ContactRecord>& contacts);
  void append_energy(const model::Energies& energy);
  void append_bushing(const std::string& group, const model::BushingState& bushing);
  void append_sensor(const std::string& group, const model::SensorState& sensor);
  void check(const model::Snapshot& snapshot) const;

  const h5::File& file_;
  const model::ResultHeader& header_;
  RowCount count_;
  bool first_;
  std::map<std::string, h5::Series> series_;
};

}  // namespace elastogear::io
