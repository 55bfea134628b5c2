#pragma once
// The pitches of a run in time, by which its figures are told over the speed (docs/theory, section 10.5).

#include <Eigen/Core>
#include <vector>

namespace elastogear::evaluation {

/// Times i of one whole pitch: begin <= i <= end, the end of a pitch is the begin of the next.
struct PitchOfRun {
  Eigen::Index begin = 0, end = 0;
};
/// The whole pitches of a run in which the drive's first gear turns on in one sense, each with at least four
/// times; roll: pitches.
std::vector<PitchOfRun> whole_pitches(const Eigen::VectorXd& roll);

}  // namespace elastogear::evaluation
