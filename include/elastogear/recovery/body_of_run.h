#pragma once
// Bodies of a result file, with their histories and their body files.

#include <map>
#include <string>
#include <vector>

#include "elastogear/io/result_file.h"
#include "elastogear/model/elastic_body.h"

namespace elastogear::recovery {

struct BodyOfRun {
  std::string result;    ///< file
  std::string name;      ///< there
  std::string file;      ///< body file; empty: a rigid body without one
  std::string identity;  ///< model::fingerprint of the body file in the run; empty: not known
  io::BodyHistory history;
  bool rigid = false;  ///< without elastic coordinates in the run, and not for want of modes in its file
};

/// All bodies of a result file, in its order. files: by the body's name, body files that are no longer where
/// the result says.
std::vector<BodyOfRun> read_bodies_of_run(const std::string& result,
                                          const std::map<std::string, std::string>& files = {});

/// Throws Error unless `elastic`, from the body's file, is what the run was made with.
void require_body_of_run(const model::ElasticBody& elastic, const BodyOfRun& body);

/// Reads the body file. Error when there is none, or when it is not that of the run.
model::ElasticBody read_elastic_body(const BodyOfRun& body);

}  // namespace elastogear::recovery
