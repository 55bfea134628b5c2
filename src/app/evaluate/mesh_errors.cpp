#include "app/evaluate/mesh_errors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "elastogear/base/error.h"
#include "elastogear/base/number.h"
#include "elastogear/evaluation/grid_convergence.h"
#include "elastogear/io/describe.h"
#include "elastogear/model/fingerprint.h"

namespace elastogear::app {
namespace {

using io::EvaluationItem;

constexpr const char *kErrorEnd = "_mesh_error", *kContactErrorEnd = "_contact_error";
constexpr const char* kRootTension = "/largest_tension";

constexpr const char* kLargestShare = "teeth/largest_share";
// The largest of means over strips of a face: it changes with their width, to the first order.
constexpr const char* kFaceLoad = "line_load/KHbeta";
constexpr const char* kAmplitudes = "transmission_error/amplitude";
constexpr double kOrder = 2, kFaceOrder = 1;
constexpr double kSame = 1e-12;  // share: what the figures of two meshes may differ by from roundoff

// Figures that the mesh changes, beside those of roots and stiffnesses per width.
constexpr const char* kOfMesh[] = {"transmission_error/mean",
                                   "transmission_error/peak_to_peak",
                                   "stiffness/secant_mean",
                                   "stiffness/secant_peak_to_peak",
                                   "stiffness/tangent_mean",
                                   "teeth/contact_ratio",
                                   kLargestShare,
                                   kFaceLoad,
                                   "pressure/hertz_peak",
                                   "losses/loss_factor"};
constexpr const char* kOfRoots[] = {kRootTension, "/largest_von_mises", "/range"};
constexpr const char *kMean = "_mean", *kPerWidth = "_per_width";  // of a stiffness

// The class of a figure, whose errors are of a kind: one stress at all roots, or the rest. Empty: the mesh
// does not change the figure.
std::string class_of(const EvaluationItem& item) {
  if (!item.shape.empty() || !item.words.empty()) return "";
  if (item.path.starts_with("root/"))
    for (const char* end : kOfRoots)
      if (item.path.ends_with(end)) return end;
  const bool found = std::find(std::begin(kOfMesh), std::end(kOfMesh), item.path) != std::end(kOfMesh);
  return found ? "drive" : "";
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

void require_pair(const CoarserMesh& mesh, const std::string& group) {
  const bool found = std::any_of(mesh.evaluation.items.begin(), mesh.evaluation.items.end(),
                                 [&](const EvaluationItem& item) { return item.path.starts_with(group); });
  require(found, mesh.file, ": has no figures of ", group.substr(0, group.size() - 1));
}

// Estimated errors by the mesh of the values of one figure; empty where a coarser mesh has not the figure, or
// has another number of values.
std::vector<double> errors_of(const std::vector<CoarserMesh>& coarser, const std::string& path,
                              const std::vector<double>& finest, double refinement, double order) {
  std::vector<std::vector<double>> value(finest.size());
  std::vector<double> refinements;
  for (const CoarserMesh& mesh : coarser) {
    const EvaluationItem* item = find_item(mesh.evaluation.items, path);
    if (!item || item->value.size() != finest.size()) return {};
    for (std::size_t i = 0; i < finest.size(); ++i) value[i].push_back(item->value[i]);
    refinements.push_back(mesh.refinement);
  }
  refinements.push_back(refinement);
  std::vector<double> errors;
  for (std::size_t i = 0; i < finest.size(); ++i) {
    value[i].push_back(finest[i]);
    errors.push_back(evaluation::mesh_error(value[i], refinements, order));
  }
  return errors;
}

// Figures of a class and their errors.
struct Class {
  std::vector<const EvaluationItem*> item;
  std::vector<double> figure, error;
};

EvaluationItem error_item(const EvaluationItem& item, std::vector<double> error) {
  return {item.path + kErrorEnd, item.unit, "estimated error by the mesh, from coarser ones", item.shape,
          std::move(error),      {}};
}

// Amplitudes of orders. None is taken for more accurate than the median of the lowest, which may have changed
// little by chance.
void add_amplitudes(const std::vector<CoarserMesh>& coarser, const std::string& group,
                    const std::vector<EvaluationItem>& items, double refinement,
                    std::vector<EvaluationItem>& errors) {
  constexpr std::size_t kLowest = 5;
  const EvaluationItem* item = find_item(items, kAmplitudes);
  if (!item) return;
  std::vector<double> error = errors_of(coarser, group + item->path, item->value, refinement, kOrder);
  if (error.empty()) return;
  std::vector<double> lowest(error.begin(),
                             error.begin() + static_cast<std::ptrdiff_t>(std::min(kLowest, error.size())));
  const auto median = lowest.begin() + std::ssize(lowest) / 2;
  std::nth_element(lowest.begin(), median, lowest.end());
  for (double& e : error) e = std::max(e, *median);
  errors.push_back(error_item(*item, std::move(error)));
}

// A stiffness per width is one over the face width: its error is as large a share.
void add_per_width(const std::vector<EvaluationItem>& items, std::vector<EvaluationItem>& errors) {
  for (const EvaluationItem& item : items) {
    if (!item.path.ends_with(kPerWidth)) continue;
    const std::string mean = item.path.substr(0, item.path.size() - std::strlen(kPerWidth)) + kMean;
    const EvaluationItem *whole = find_item(items, mean), *error = find_item(errors, mean + kErrorEnd);
    if (whole && error && whole->value[0] != 0)
      errors.push_back(error_item(item, {error->value[0] * item.value[0] / whole->value[0]}));
  }
}

// Estimated errors of the figures of a pair of gears, whose path in coarser files is `group`. A share that
// all meshes have alike is that of a single pair of teeth, and exact.
std::vector<EvaluationItem> error_items(const std::vector<CoarserMesh>& coarser, const std::string& group,
                                        const std::vector<EvaluationItem>& items, double refinement) {
  for (const CoarserMesh& mesh : coarser) require_pair(mesh, group);
  std::map<std::string, Class> classes;
  for (const EvaluationItem& item : items) {
    const std::string name = class_of(item);
    if (name.empty()) continue;
    const double order = item.path == kFaceLoad ? kFaceOrder : kOrder;
    const auto error = errors_of(coarser, group + item.path, item.value, refinement, order);
    if (error.empty() || (item.path == kLargestShare && error[0] <= kSame)) continue;
    Class& of = classes[name];
    of.item.push_back(&item), of.figure.push_back(item.value[0]), of.error.push_back(error[0]);
  }
  std::vector<EvaluationItem> errors;
  for (auto& [name, of] : classes) {
    evaluation::raise_to_median(of.figure, of.error);
    for (std::size_t i = 0; i < of.item.size(); ++i) errors.push_back(error_item(*of.item[i], {of.error[i]}));
  }
  add_per_width(items, errors);
  add_amplitudes(coarser, group, items, refinement, errors);
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

namespace {

// over: takes paths of largest tensions.
double root_error_over(const io::EvaluationFile& evaluation,
                       const std::function<bool(const std::string&)>& over) {
  using CaseAndGear = std::pair<std::string, std::string>;
  std::map<CaseAndGear, const EvaluationItem*> largest;  // of all pairs of a gear
  std::map<std::string, double> of_gear;                 // Pa, over all cases
  for (const EvaluationItem& item : evaluation.items) {
    if (!item.path.ends_with(kRootTension) || !over(item.path)) continue;
    const std::string gear = item.path.substr(item.path.find("/root/"));
    const EvaluationItem*& known = largest[{item.path.substr(0, item.path.find('/')), gear}];
    if (!known || item.value[0] > known->value[0]) known = &item;
    of_gear[gear] = std::max(of_gear[gear], item.value[0]);
  }
  double worst = -1;
  for (const auto& [of, item] : largest) {
    const EvaluationItem* by_mesh = find_item(evaluation.items, item->path + kErrorEnd);
    if (!by_mesh || !(item->value[0] > 0)) continue;
    const double error = std::max(by_mesh->value[0], whole_error(evaluation.items, item->path));
    worst = std::max(worst, error / of_gear.at(of.second));
  }
  return worst;
}

// Are the bodies of a result those of the evaluation's results?
bool has_bodies_of(const io::EvaluationFile& evaluation, const std::string& result) {
  const auto of_result = io::read_provenance(result);
  return std::ranges::all_of(of_result, [&](const auto& entry) {
    if (!entry.first.starts_with(model::identity_key(""))) return true;
    const auto known = evaluation.provenance.find(entry.first);
    return known != evaluation.provenance.end() && known->second == entry.second;
  });
}

// The case that was read off a result; empty: there is none.
std::string case_of(const io::EvaluationFile& evaluation, const std::string& result) {
  constexpr const char* kResult = "/result";
  for (const EvaluationItem& item : evaluation.items) {
    std::error_code error;
    if (item.path.ends_with(kResult) && item.words.size() == 1 &&
        std::filesystem::equivalent(item.words[0], result, error))
      return item.path.substr(0, item.path.size() - std::strlen(kResult));
  }
  return "";
}

}  // namespace

double root_error(const std::string& file) {
  return root_error_over(io::read_evaluation(file), [](const std::string&) { return true; });
}

double root_error_of(const std::string& file, const std::string& result, const std::string& gear) {
  const io::EvaluationFile evaluation = io::read_evaluation(file);
  const std::string of = case_of(evaluation, result);
  if (of.empty() || !has_bodies_of(evaluation, result)) return -1;
  return root_error_over(evaluation, [&](const std::string& path) {
    return path.starts_with(of + "/") && path.ends_with("/root/" + gear + kRootTension);
  });
}

}  // namespace elastogear::app
