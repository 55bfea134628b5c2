#include "app/setup/drive_on_meshes.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <system_error>

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

// As `run` writes it in the name of a folder; infinite in other names.
double refinement_in(const std::string& name) {
  const auto number = parse<double>(name);
  std::ostringstream text;
  if (number) text << *number;
  return number && *number > 0 && text.str() == name ? *number : INFINITY;
}

// Why the bodies of a coarser mesh do not serve; empty: they do.
std::string obstacle(const Options& own, const Options& coarser, const Drive& drive) {
  const Silence silence;
  try {
    for (const DriveMember& member : drive.members) {
      const std::string file = body_file(coarser, member);
      std::error_code none;
      require(fs::is_regular_file(file, none), file, " is not there");
      const std::string option = differing_option(body_file(own, member), file);
      require(option.empty(), file, " has another ", option);
    }
    require_bodies(coarser, drive);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

// The refinement that the bodies of all gears have in common. There is none where a body does not say it,
// where two differ, or where a gear has a mesh of the user's own.
std::optional<double> own_refinement(const Options& options, const Drive& drive) {
  std::optional<double> own;
  for (const DriveMember& member : drive.members) {
    if (!own_mesh(options, member.name).empty()) return {};
    const auto refinement = refinement_of(body_file(options, member));
    if (!refinement || (own && *own != *refinement)) return {};
    own = refinement;
  }
  return own;
}

}  // namespace

std::string folder_of_meshes(const Options& options) { return drive_stem(options) + "_meshes"; }

std::vector<double> DriveOnMeshes::refinements() const {
  std::vector<double> all;
  for (const DriveOnMesh& mesh : coarser) all.push_back(mesh.refinement);
  all.push_back(refinement);
  return all;
}

std::vector<std::string> DriveOnMeshes::bodies(const Drive& drive) const {
  std::vector<std::string> files;
  for (const DriveOnMesh& mesh : coarser)
    for (const DriveMember& member : drive.members) files.push_back(body_file(mesh.options, member));
  return files;
}

DriveOnMeshes drive_on_meshes(const Options& options, const Drive& drive) {
  const auto own = own_refinement(options, drive);
  if (!own) return {};
  DriveOnMeshes meshes{*own};
  std::map<double, std::string> folders;  // the coarsest first
  std::error_code none;
  for (fs::directory_iterator at(folder_of_meshes(options), none), end; !none && at != end;
       at.increment(none))
    if (const auto refinement = refinement_in(at->path().filename().string()); refinement < *own)
      folders[refinement] = at->path().string();
  for (const auto& [refinement, folder] : folders) {
    Options coarser = with_bodies_in(folder, options, drive);
    const std::string why = obstacle(options, coarser, drive);
    if (why.empty())
      meshes.coarser.push_back({refinement, std::move(coarser)});
    else
      meshes.left_out.push_back(why);
  }
  constexpr std::size_t kUsed = 2;  // by Eq. (10.15) to (10.17), beside the drive's own
  while (meshes.coarser.size() > kUsed) meshes.coarser.erase(meshes.coarser.begin());
  return meshes;
}

}  // namespace elastogear::app
