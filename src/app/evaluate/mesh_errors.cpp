#include "app/evaluate/mesh_errors.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "elastogear/base/error.h"
#include "elastogear/base/number.h"
#include "elastogear/evaluation/grid_convergence.h"

namespace elastogear::app {
namespace {

using io::EvaluationItem;

constexpr const char *kErrorEnd = "_mesh_error", *kContactErrorEnd = "_contact_error";
constexpr const char* kRootTension = "/largest_tension";

// Figures that the mesh changes, beside those of roots.
constexpr const char* kOfMesh[] = {"transmission_error/mean",       "transmission_error/peak_to_peak",
                                   "stiffness/secant_mean",         "stiffness/secant_per_width",
                                   "stiffness/secant_peak_to_peak", "stiffness/tangent_mean",
                                   "stiffness/tangent_per_width",   "teeth/contact_ratio",
                                   "teeth/largest_share",           "line_load/KHbeta",
                                   "pressure/hertz_peak",           "losses/loss_factor"};
constexpr const char* kOfRoots[] = {kRootTension, "/largest_von_mises", "/range"};

bool depends_on_mesh(const std::string& path) {
  if (path.starts_with("root/"))
    return std::any_of(std::begin(kOfRoots), std::end(kOfRoots),
                       [&](const char* end) { return path.ends_with(end); });
  return std::find(std::begin(kOfMesh), std::end(kOfMesh), path) != std::end(kOfMesh);
}

double refinement_of(const io::EvaluationFile& evaluation, const std::string& file) {
  const auto found = evaluation.provenance.find("option_refinement");
  const auto number = found == evaluation.provenance.end() ? std::nullopt : parse<double>(found->second);
  require(number.has_value(), file, ": does not say how fine its meshes are; evaluate the run anew");
  return *number;
}

struct CoarserMesh {
  std::string file;
  double refinement = 1;
  io::EvaluationFile evaluation;
};

double value_on(const CoarserMesh& mesh, const std::string& path) {
  const EvaluationItem* item = find_item(mesh.evaluation.items, path);
  require(item && item->value.size() == 1, mesh.file, ": has no figure ", path);
  return item->value[0];
}

double error_of(const std::vector<CoarserMesh>& coarser, const std::string& path, double finest,
                double refinement) {
  std::vector<double> value, refinements;
  for (const CoarserMesh& mesh : coarser) {
    value.push_back(value_on(mesh, path));
    refinements.push_back(mesh.refinement);
  }
  value.push_back(finest);
  refinements.push_back(refinement);
  return evaluation::mesh_error(value, refinements);
}

// Of the figures of a pair of gears; group: the path of the pair in coarser files.
std::vector<EvaluationItem> error_items(const std::vector<CoarserMesh>& coarser, const std::string& group,
                                        const std::vector<EvaluationItem>& items, double refinement) {
  std::vector<EvaluationItem> errors;
  std::vector<double> figure, error;
  for (const EvaluationItem& item : items) {
    if (!item.shape.empty() || !item.words.empty() || !depends_on_mesh(item.path)) continue;
    figure.push_back(item.value[0]);
    error.push_back(error_of(coarser, group + item.path, item.value[0], refinement));
    errors.push_back(
        {item.path + kErrorEnd, item.unit, "estimated error by the mesh, from coarser ones", {}, {}, {}});
  }
  evaluation::raise_to_median(figure, error);
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i].value = {error[i]};
  return errors;
}

// Replaces the item that has the same path, or appends a new one.
void set_item(std::vector<EvaluationItem>& items, EvaluationItem item) {
  const auto found = std::find_if(items.begin(), items.end(),
                                  [&](const EvaluationItem& other) { return other.path == item.path; });
  if (found == items.end())
    items.push_back(std::move(item));
  else
    *found = std::move(item);
}

}  // namespace

void add_mesh_errors(const std::vector<std::string>& files, double refinement,
                     std::vector<CaseFigures>& cases) {
  if (files.empty()) return;
  std::vector<CoarserMesh> coarser;
  for (const std::string& file : files) {
    io::EvaluationFile evaluation = io::read_evaluation(file);
    const double of_file = refinement_of(evaluation, file);
    coarser.push_back({file, of_file, std::move(evaluation)});
  }
  for (CaseFigures& of : cases)
    for (PairFigures& pair : of.pairs) {
      const std::string group = of.of.name + "/" + pair.pair + "/";
      for (EvaluationItem& error : error_items(coarser, group, pair.items, refinement)) {
        // Meshes resolve the contact as finely as the body: the change between them has both.
        const std::string figure = error.path.substr(0, error.path.size() - std::strlen(kErrorEnd));
        std::erase_if(pair.items,
                      [&](const EvaluationItem& item) { return item.path == figure + kContactErrorEnd; });
        set_item(pair.items, std::move(error));
      }
    }
}

double root_error(const std::string& file) {
  const io::EvaluationFile evaluation = io::read_evaluation(file);
  double largest = -1;
  for (const EvaluationItem& item : evaluation.items) {
    if (!item.path.ends_with(kRootTension)) continue;
    const EvaluationItem* by_mesh = find_item(evaluation.items, item.path + kErrorEnd);
    if (!by_mesh || !(item.value[0] > 0)) continue;
    const double error = std::max(by_mesh->value[0], whole_error(evaluation.items, item.path));
    largest = std::max(largest, error / item.value[0]);
  }
  return largest;
}

}  // namespace elastogear::app
