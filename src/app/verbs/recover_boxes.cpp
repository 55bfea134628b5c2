#include "app/verbs/recover_boxes.h"

#include "app/console/console.h"
#include "elastogear/io/polydata_file.h"
#include "elastogear/recovery/boxes.h"

namespace elastogear::app {
namespace {

constexpr const char *kBoxes = "kdops", *kOverlaps = "overlaps";  // in the names of files

std::string box_path(const std::string& prefix, const std::string& body, const char* kind) {
  return prefix + "_" + body + "_" + kind + ".vtp";
}

void write_boxes(const std::string& path, const recovery::Boxes& boxes) {
  io::write_polydata(path, boxes.points, boxes.polygons,
                     {{"level", boxes.level}, {"overlaps", boxes.overlaps}});
  print_item("written", path);
}

}  // namespace

std::vector<std::string> box_files(const std::string& prefix, const std::string& body) {
  return {box_path(prefix, body, kBoxes), box_path(prefix, body, kOverlaps)};
}

void write_trees(const RecoverSettings& settings, const std::vector<recovery::RecoveredBody>& bodies,
                 Eigen::Index step) {
  if (settings.box_levels.empty()) return;
  std::vector<contact::Bvh> trees;
  for (const recovery::RecoveredBody& body : bodies) {
    const model::Surface surface = read_elastic_body(body.run).surface;
    const recovery::FieldState state = state_of_run(body.run, step);
    Eigen::Matrix3Xd x = surface.X;
    Eigen::Map<Eigen::VectorXd>(x.data(), x.size()) += model::multiply(surface.Phi, state.q);
    x = ((state.R_WB * x).colwise() + state.r_WB).eval();
    trees.push_back(recovery::fitted_tree(surface, x, settings.box_kdop));
    write_boxes(box_path(settings.fields, body.run.name, kBoxes),
                recovery::boxes_at_levels(trees.back(), settings.box_levels));
  }
  if (trees.size() != 2) return;
  for (int i : {0, 1})
    write_boxes(box_path(settings.fields, bodies[i].run.name, kOverlaps),
                recovery::overlapping_boxes(trees[i], trees[1 - i]));
}

}  // namespace elastogear::app
