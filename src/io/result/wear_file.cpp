#include "elastogear/io/wear_file.h"

#include "elastogear/base/file.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

void check_worn(const h5::File& file, const WornGear& gear, Eigen::Index n_steps) {
  require_name(file, gear.body);
  const auto has_steps = [&](const Eigen::VectorXd& course) {
    return course.size() == n_steps && course.allFinite();
  };
  const auto fits = [&](const Eigen::MatrixXd& depth) {
    return depth.rows() == gear.roll.size() && depth.cols() == gear.z.size() && depth.allFinite();
  };
  require(fits(gear.left) && fits(gear.right) && gear.diameter.size() == gear.roll.size() &&
              has_steps(gear.largest) && has_steps(gear.mass) &&
              (gear.largest_mesh_error.size() == 0 ||
               (has_steps(gear.largest_mesh_error) && has_steps(gear.mass_mesh_error))),
          file.path, ": wear of ", gear.body, " does not have ", n_steps, " finite steps and ",
          gear.roll.size(), " x ", gear.z.size(), " cells");
}

// Rows are those of the profile.
void write_depth(const h5::File& file, const std::string& name, const Eigen::MatrixXd& depth) {
  const Eigen::MatrixXd rows = depth.transpose();
  h5::write<double>(file, name, {{extent(depth.rows()), extent(depth.cols())}, rows.data()}, "m");
}

}  // namespace

void write_wear(const std::string& path, const WearFile& wear) {
  PendingFile pending(path);
  h5::File file = h5::create(path, pending.temporary());
  write_format(file, kWearFormat);
  h5::write_map(file, "/provenance", wear.provenance);
  h5::write<double>(file, "/revolutions", view(wear.revolutions), "1");
  for (const WornGear& gear : wear.gears) {
    require(gear.body != "revolutions" && gear.body != "provenance", path, ": a body must not be called '",
            gear.body, "'");
    check_worn(file, gear, wear.revolutions.size());
    const std::string group = "/" + gear.body;
    h5::write<double>(file, group + "/diameter", view(gear.diameter), "m");
    h5::write<double>(file, group + "/roll", view(gear.roll), "m");
    h5::write<double>(file, group + "/z", view(gear.z), "m");
    write_depth(file, group + "/left", gear.left);
    write_depth(file, group + "/right", gear.right);
    h5::write<double>(file, group + "/largest_depth", view(gear.largest), "m");
    h5::write<double>(file, group + "/mass", view(gear.mass), "kg");
    if (gear.largest_mesh_error.size() == 0) continue;
    h5::write<double>(file, group + "/largest_depth_mesh_error", view(gear.largest_mesh_error), "m");
    h5::write<double>(file, group + "/mass_mesh_error", view(gear.mass_mesh_error), "kg");
  }
  h5::close(file);
  pending.commit();
}

}  // namespace elastogear::io
