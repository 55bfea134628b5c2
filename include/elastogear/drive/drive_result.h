#pragma once
// Result files of a drive, with its bodies, as the pairs of gears that evaluation takes.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "elastogear/drive/drive_system.h"
#include "elastogear/evaluation/evaluate.h"
#include "elastogear/io/result_file.h"
#include "elastogear/model/elastic_body.h"
#include "elastogear/recovery/static_response.h"

namespace elastogear::drive {

/// Surfaces and stress bases of body files, which many results share, by file.
class BodyFiles {
 public:
  /// Reads the file where it has not been read. Throws Error when it is not the body of the result.
  const model::ElasticBody& get(const std::string& file, const std::string& body, const std::string& result,
                                const std::string& identity);
  /// 1/Pa, surface_compliance of a file that has been read.
  double compliance(const std::string& file);

 private:
  struct Known {
    model::ElasticBody body;
    std::string identity;
    std::optional<double> compliance = {};
  };
  std::map<std::string, std::unique_ptr<Known>> known_;
};

/// What is the same for all results of a drive.
struct DriveOfResults {
  Drive drive;                                        ///< at the roll angle 0
  bool coasts = false;                                ///< as the drive's Start
  std::vector<std::vector<Bearing>> bearings = {};    ///< as its Operation
  std::map<std::string, std::string> body_file = {};  ///< by body, where a result names another place
  std::optional<double> speed =
      {};  ///< rad/s, of the first gear, for equilibria without friction: they have none
};

/// What is read off a result besides contact.
struct ReadSettings {
  std::optional<double> from = {}, to = {};  ///< s, span of a motion
  bool roots = true;                         ///< recover stresses at the roots
  recovery::Acceleration mode_acceleration = recovery::Acceleration::automatic;
  bool error_estimate = true;  ///< of these stresses
};

/// A result file of a drive, with the times that count.
struct DriveResult {
  std::string path;
  model::ResultHeader header;
  model::Analysis analysis = model::Analysis::sweep;
  Eigen::VectorXd time;    ///< all
  std::vector<int> steps;  ///< of them, that count
};

/// All times in the span of a motion, the last one of a static analysis, and all roll angles of a sweep.
/// Throws Error for a file that does not say its analysis, for other analyses and for spans without times.
DriveResult open_result(const std::string& path, const ReadSettings& settings);

/// A pair with its name in the result.
struct NamedPair {
  std::string name;
  evaluation::PairOfRun run;
};

/// What a bearing of a gear bears and how far it gives way, n_t each.
struct BearingOfRun {
  std::string name, gear;
  Eigen::VectorXd radial_load, axial_load;  ///< N, size across the gear's axis; along it, on the bearing
  Eigen::VectorXd tilting_moment;           ///< N m, size across the axis
  Eigen::VectorXd radial_deflection, axial_deflection, tilt;  ///< m, m, rad, of the gear against the housing
};

/// What evaluation takes of a result.
struct DriveRun {
  std::vector<NamedPair> pairs;
  std::vector<BearingOfRun> bearings;
  std::map<std::string, Eigen::MatrixXd> sensors;  ///< by name, n_t x 3, m/s^2; of a motion
  std::vector<std::string> notes;                  ///< what is not known, and why
};

/// Does force pass at every position or time?
bool touches_always(const evaluation::PairOfRun& pair);

/// Transmission errors by pair, m, at the roll angles of a result; of pairs that touch at all of them.
using TransmissionErrors = std::map<std::string, Eigen::VectorXd>;

/// unloaded: of the same roll angles; empty: not known, but for exact flanks in place. Throws Error where the
/// result is not of this drive.
DriveRun read_result(const DriveOfResults& of, const ReadSettings& settings, const DriveResult& result,
                     BodyFiles& bodies, const TransmissionErrors& unloaded);

TransmissionErrors transmission_errors(const DriveOfResults& of, const DriveResult& result,
                                       BodyFiles& bodies);

/// The body file of a gear of a result.
std::string body_file(const DriveOfResults& of, const DriveResult& result, const std::string& gear);

}  // namespace elastogear::drive
