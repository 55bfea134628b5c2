#include "elastogear/recovery/body_of_run.h"

#include "elastogear/base/error.h"
#include "elastogear/io/body_file.h"
#include "elastogear/model/fingerprint.h"

namespace elastogear::recovery {
namespace {

// A body of static responses alone has no elastic coordinates, either, and is not rigid: results say so.
bool is_rigid(const BodyOfRun& body, const std::map<std::string, std::string>& of_run) {
  if (body.history.q.rows() > 0) return false;
  const auto said = of_run.find(model::rigid_key(body.name));
  return said == of_run.end() || said->second == "true";
}

}  // namespace

std::vector<BodyOfRun> read_bodies_of_run(const std::string& result,
                                          const std::map<std::string, std::string>& files) {
  const model::ResultHeader header = io::read_result_header(result);
  std::vector<BodyOfRun> bodies;
  for (const auto& body : header.bodies) {
    const auto moved = files.find(body.name);
    const auto identity = header.provenance.find(model::identity_key(body.name));
    bodies.push_back({result, body.name, moved == files.end() ? body.file : moved->second,
                      identity == header.provenance.end() ? "" : identity->second,
                      io::read_body_history(result, body.name)});
    bodies.back().rigid = is_rigid(bodies.back(), header.provenance);
  }
  return bodies;
}

void require_body_of_run(const model::ElasticBody& elastic, const BodyOfRun& body) {
  const Eigen::Index n_q = body.history.q.rows();
  const std::string remedy =
      "name the body file of the run by option -" + body.name + "_file, or run simulate with this one";
  require(body.rigid || elastic.n_q() == n_q, body.file, ": ", elastic.n_q(), " elastic coordinates, body '",
          body.name, "' of ", body.result, " has ", n_q, ": ", remedy);
  require(body.rigid || body.history.w.rows() == n_q * static_cast<Eigen::Index>(elastic.relaxing.size()),
          body.file, ": has ", elastic.relaxing.size(), " parts that relax, body '", body.name, "' of ",
          body.result, " has others: ", remedy);
  require(body.identity.empty() || model::fingerprint(elastic) == body.identity, body.file,
          ": is not the body '", body.name, "' of ", body.result,
          ": mesh, material, restraint, surface, markers or basis differ, and its elastic coordinates mean "
          "something else: ",
          remedy);
}

model::ElasticBody read_elastic_body(const BodyOfRun& body) {
  require(!body.file.empty(), "body '", body.name, "' of ", body.result,
          " is rigid and has no file: it has no stresses and no fields");
  model::ElasticBody elastic = io::read_body(body.file);
  require_body_of_run(elastic, body);
  return elastic;
}

}  // namespace elastogear::recovery
