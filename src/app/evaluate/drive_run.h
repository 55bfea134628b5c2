#pragma once
// A run of a drive, with its bodies, as the pairs of gears that evaluation takes.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/evaluate/evaluate_options.h"
#include "app/gear/drive.h"
#include "elastogear/evaluation/evaluate.h"
#include "elastogear/io/result_file.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::app {

/// Surfaces and stress bases of body files, which many cases share, by file.
class Bodies {
 public:
  /// Reads the file where it has not been read. Throws Error when it is not the body of the run.
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

/// What is the same for all cases of a drive.
struct DriveOfRun {
  const Options& options;
  Drive drive;  ///< at the roll angle 0
  EvaluateSettings settings;
};

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

/// The run of a case.
struct CaseRun {
  std::vector<NamedPair> pairs;
  std::vector<BearingOfRun> bearings;
  std::map<std::string, Eigen::MatrixXd> sensors;  ///< by name, n_t x 3, m/s^2; of a run in time
  std::vector<std::string> notes;                  ///< what is not known, and why
};

/// Reads a result file. unloaded: transmission errors by pair, of the same roll angles; empty: not known, but
/// for exact flanks in place.
CaseRun read_case_run(const DriveOfRun& of, Bodies& bodies, const std::string& result,
                      const std::map<std::string, Eigen::VectorXd>& unloaded);

/// Transmission errors of a result file by pair, m, at its roll angles.
std::map<std::string, Eigen::VectorXd> transmission_errors(const DriveOfRun& of, Bodies& bodies,
                                                           const std::string& result);

}  // namespace elastogear::app
