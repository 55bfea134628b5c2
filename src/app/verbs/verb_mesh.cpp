// elastogear mesh: gear data -> volume mesh.

#include <algorithm>
#include <filesystem>
#include <numbers>

#include "app/console/console.h"
#include "app/console/outputs.h"
#include "app/gear/design_options.h"
#include "app/gear/drawing.h"
#include "app/gear/drive_options.h"
#include "app/options/verbs.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/text.h"
#include "elastogear/gear/wheel.h"
#include "elastogear/gear/worm.h"
#include "elastogear/mesh/file.h"
#include "elastogear/mesh/quality.h"

namespace elastogear::app {
namespace {

using gear::Design;

constexpr double kDegree = std::numbers::pi / 180;

void print_toothing(const gear::Geometry& g, const gear::Toothing& t) {
  const auto mm = [](double diameter) { return with_unit(2e3 * diameter, "mm"); };
  print_item("pitch / tip / root diameter", mm(t.r) + " / " + mm(t.r_a) + " / " + mm(t.r_f));
  print_item("lead angle", with_unit(g.gamma / kDegree, "deg"));
  print_item("contact ratio", with_unit(g.epsilon, ""));
  print_item("normal backlash", with_unit(1e3 * g.j_n, "mm"));
}

void print_mesh(const mesh::Mesh& mesh) {
  const mesh::Quality quality = mesh::quality(mesh);
  print_item("nodes", std::to_string(mesh.n_nodes()));
  print_item("elements", std::to_string(mesh.cells.size()));
  print_detail("contact faces", std::to_string(mesh::face_set(mesh, "flanks").size()));
  print_detail("smallest scaled Jacobian", with_unit(quality.min_scaled_jacobian, ""));
  print_detail("mean scaled Jacobian", with_unit(quality.mean_scaled_jacobian, ""));
}

template <class Counts>
Counts with_given(Counts counts, const Rows<Counts>& rows, const Options& options) {
  read_rows(options, rows, counts);
  return counts;
}

// A mesh of another program may be the user's only one.
void protect_meshes(const Options& options, const std::vector<Outputs>& outputs) {
  for (const Outputs& output : outputs)
    for (const std::string& file : output.files)
      require(!is_file(file) || std::filesystem::is_empty(file) || mesh::is_written_mesh(file),
              options.label(output.option), ": would overwrite ", file,
              ", a file that elastogear has not written; move it, or give another name by -", output.option);
}

// All members of a drive file.
void mesh_drive(const Options& options) {
  const Drive drive = read_drive(options);
  const MeshDensity density = mesh_density(options);
  std::vector<std::string> paths;
  std::vector<Outputs> outputs;
  for (const DriveMember& member : drive.members) {
    const std::string option = member.name + "_mesh_output";
    paths.push_back(options.given(option) ? options.text(option) : member.name + ".msh");
    outputs.push_back({option, {paths.back()}});
  }
  const std::string drawing = drawing_file(options);
  std::vector<Outputs> all = outputs;
  all.push_back({"drawing", {drawing}});
  protect_inputs(options, all);
  protect_meshes(options, outputs);
  print_drive(drive);
  std::vector<mesh::Mesh> meshes;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const OutputLock lock(paths[i]);
    mesh::ReadReport report;
    meshes.push_back(drive.members[i].mesh(density, report));
    if (own_mesh(options, drive.members[i].name).empty()) print_item("mesh of " + drive.members[i].name, "");
    print_mesh(meshes.back());
    mesh::write_mesh(paths[i], meshes.back());
    print_item("written", paths[i]);
  }
  const OutputLock lock(drawing);
  write_drawing(drawing, join(options.files()), drive, meshes);
  print_item("drawing", drawing);
}

void run_mesh(const Options& given, const std::vector<std::string>&) {
  const Options options = with_gears(given);
  options.reject_unknown();
  if (is_drive(options)) return mesh_drive(options);
  const bool worm = is_worm(options);
  const std::string path = options.text("mesh");
  protect_inputs(options, {{"mesh", {path}}});
  protect_meshes(options, {{"mesh", {path}}});
  const OutputLock lock(path);
  Design d;
  read_rows(options, design_rows(), d);
  const auto [size, order, times] = mesh_density(options);
  const gear::Geometry geometry = gear::derive(d);
  const auto worm_counts = gear::refined(gear::worm_counts(size, d.z1, order), d.z1, times);
  const auto wheel_counts = gear::refined(gear::wheel_counts(size, order), times);
  const mesh::Mesh mesh = worm ? gear::worm_mesh(d, with_given(worm_counts, worm_count_rows(), options))
                               : gear::wheel_mesh(d, with_given(wheel_counts, wheel_count_rows(), options));
  print_toothing(geometry, worm ? geometry.worm : geometry.wheel);
  print_mesh(mesh);
  mesh::write_mesh(path, mesh);
  print_item("written", path);
}

}  // namespace

Verb mesh_verb() {
  OptionTable table = table_of(design_rows(), worm_count_rows(), wheel_count_rows());
  const OptionTable of_drives = drive_table();
  table.insert(table.end(), of_drives.begin(), of_drives.end());
  return {"mesh", "mesh drive.yaml [-option value ...]",
          "gear data -> hexahedral meshes of a drive, or of a worm or its wheel", table, run_mesh};
}

}  // namespace elastogear::app
