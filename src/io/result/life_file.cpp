#include "elastogear/io/life_file.h"

#include "elastogear/base/file.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

void check_life(const h5::File& file, const LifeSet& set, Eigen::Index n_blocks) {
  require_name(file, set.body);
  require_name(file, set.set);
  const auto n = static_cast<Eigen::Index>(set.node.size());
  require(static_cast<Eigen::Index>(set.tooth.size()) == n && set.X.cols() == n && set.damage.size() == n &&
              set.amplitude.size() == n && set.block_damage.rows() == n &&
              set.block_damage.cols() == n_blocks && set.history.cols() == n_blocks &&
              set.history.rows() == set.roll.size() && set.critical >= 0 && set.critical < n,
          file.path, ": damage of ", set.body, "/", set.set, " does not have ", n, " nodes and ", n_blocks,
          " blocks");
  require(set.damage_with_error.size() == 0 ||
              (set.damage_with_error.size() == n && !set.damage_with_error.hasNaN()),
          file.path, ": damage of ", set.body, "/", set.set, " with the estimated error does not have ", n,
          " numbers");
  require(set.damage.allFinite() && set.block_damage.allFinite() && set.amplitude.allFinite() &&
              set.history.allFinite(),
          file.path, ": damage of ", set.body, "/", set.set, " is not finite");
}

void write_life_set(const h5::File& file, const LifeSet& set) {
  const std::string group = "/" + set.body + "/" + set.set, critical = group + "/critical";
  const hsize_t n = set.node.size(), n_blocks = extent(set.block_damage.cols());
  h5::write<int>(file, group + "/nodes", view(set.node), "1");
  h5::write<int>(file, group + "/tooth", view(set.tooth), "1");
  h5::write<double>(file, group + "/X", view(set.X), "m");
  h5::write<double>(file, group + "/damage", view(set.damage), "1");
  h5::write<double>(file, group + "/block_damage", {{n_blocks, n}, set.block_damage.data()}, "1");
  h5::write<double>(file, group + "/amplitude", view(set.amplitude), "Pa");
  if (set.damage_with_error.size() > 0)
    h5::write<double>(file, group + "/damage_with_error", view(set.damage_with_error), "1");
  h5::write<double>(file, critical + "/roll", view(set.roll), "1");
  h5::write<double>(file, critical + "/history", {{n_blocks, extent(set.roll.size())}, set.history.data()},
                    "Pa");
  const CycleTable& cycles = set.cycles;
  h5::write<int>(file, critical + "/cycles/block", view(cycles.block), "1");
  h5::write<double>(file, critical + "/cycles/range", view(cycles.range), "Pa");
  h5::write<double>(file, critical + "/cycles/mean", view(cycles.mean), "Pa");
  h5::write<double>(file, critical + "/cycles/amplitude", view(cycles.amplitude), "Pa");
  h5::write<double>(file, critical + "/cycles/count", view(cycles.count), "1");
  h5::write<double>(file, critical + "/cycles/damage", view(cycles.damage), "1");
  h5::set_attribute(file, critical, "node", set.node[static_cast<std::size_t>(set.critical)]);
  h5::set_attribute(file, group, "frame", "body");
}

}  // namespace

void write_life(const std::string& path, const LifeFile& life) {
  PendingFile pending(path);
  h5::File file = h5::create(path, pending.temporary());
  write_format(file, kLifeFormat);
  h5::write_map(file, "/provenance", life.provenance);
  h5::write<double>(file, "/duty_cycle/torque", view(life.torque), "N m");
  h5::write<double>(file, "/duty_cycle/revolutions", view(life.revolutions), "1");
  h5::write<double>(file, "/duty_cycle/time", view(life.time), "s");
  for (const LifeSet& set : life.sets) {
    require(set.body != "duty_cycle" && set.body != "provenance", path, ": a body must not be called '",
            set.body, "'");
    check_life(file, set, life.torque.size());
    write_life_set(file, set);
  }
  h5::close(file);
  pending.commit();
}

}  // namespace elastogear::io
