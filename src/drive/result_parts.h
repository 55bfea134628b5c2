#pragma once
// Parts of a result of a drive (elastogear/drive/drive_result.h).

#include "elastogear/drive/drive_result.h"

namespace elastogear::drive {

/// Throws Error where the drive has none of this name.
const Member& member_of(const Drive& drive, const std::string& name, const std::string& path);

Eigen::Matrix3d rotation_at(const io::BodyHistory& history, int step);

const model::ElasticBody& elastic_body(const DriveOfResults& of, const DriveResult& result,
                                       const std::string& gear, BodyFiles& bodies);

/// A pair of the result at its times, without stresses and unloaded transmission error.
evaluation::PairOfRun read_pair(const DriveOfResults& of, const DriveResult& result,
                                const model::ResultHeader::Pair& of_pair, BodyFiles& bodies);

/// Stresses at the roots of each elastic gear, by name.
std::map<std::string, io::StressSet> recover_roots(const DriveOfResults& of, const ReadSettings& settings,
                                                   const DriveResult& result, BodyFiles& bodies,
                                                   std::vector<std::string>& notes);

std::vector<BearingOfRun> read_bearings(const DriveOfResults& of, const DriveResult& result);

}  // namespace elastogear::drive
