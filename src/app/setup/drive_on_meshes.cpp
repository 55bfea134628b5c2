#include "app/setup/drive_on_meshes.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "app/console/console.h"
#include "app/setup/drive_input.h"
#include "elastogear/base/error.h"
#include "elastogear/base/number.h"
#include "elastogear/io/describe.h"

namespace elastogear::app {
namespace {

namespace fs = std::filesystem;

std::optional<double> refinement_of(const std::string& body) {
  const auto provenance = io::read_provenance(body);
  const auto found = provenance.find("option_refinement");
  return found == provenance.end() ? std::nullopt : parse<double>(found->second);
}

Options with_bodies_in(const std::string& folder, Options options, const Drive& drive) {
  options.set("refinement", fs::path(folder).filename().string());
  for (const DriveMember& member : drive.members) {
    const std::string file = fs::path(body_file(options, member)).filename().string();
    options.set(member.name + "_file", (fs::path(folder) / file).string());
  }
  return options;
}

// Are all bodies there, of this input?
bool has_all_bodies(const Options& options, const Drive& drive) {
  const Silence silence;
  for (const DriveMember& member : drive.members)
    if (!fs::is_regular_file(body_file(options, member))) return false;
  try {
    require_bodies(options, drive);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

std::string folder_of_meshes(const Options& options) { return drive_stem(options) + "_meshes"; }

std::vector<double> DriveOnMeshes::refinements() const {
  std::vector<double> all;
  for (const DriveOnMesh& mesh : coarser) all.push_back(mesh.refinement);
  all.push_back(refinement);
  return all;
}

DriveOnMeshes drive_on_meshes(const Options& options, const Drive& drive) {
  const std::string folder = folder_of_meshes(options);
  const auto own = refinement_of(body_file(options, drive.members.front()));
  if (!own || !fs::is_directory(folder)) return {};
  DriveOnMeshes meshes{*own};
  for (const auto& entry : fs::directory_iterator(folder)) {
    const auto refinement = parse<double>(entry.path().filename().string());
    if (!refinement || !(*refinement > 0 && *refinement < *own)) continue;
    Options coarser = with_bodies_in(entry.path().string(), options, drive);
    if (has_all_bodies(coarser, drive)) meshes.coarser.push_back({*refinement, std::move(coarser)});
  }
  std::sort(meshes.coarser.begin(), meshes.coarser.end(),
            [](const DriveOnMesh& a, const DriveOnMesh& b) { return a.refinement < b.refinement; });
  return meshes;
}

}  // namespace elastogear::app
