#include "app/run/loaded_sides.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "app/evaluate/cases.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/petsc.h"
#include "elastogear/gear/flank.h"
#include "elastogear/io/result_file.h"

namespace elastogear::app {
namespace {

constexpr int kLeft = 1, kRight = 2;  // bits

// Sides of a pair's gears that carry a force at one time at least.
std::array<int, 2> sides_of_pair(const Drive& drive, const drive::Pair& pair, const std::string& result) {
  const io::PairHistory history = io::read_pair_history(result, drive::pair_name(drive, pair));
  const std::array<int, 2> member{pair.first, pair.second};
  std::array<int, 2> sides{};
  for (std::size_t s : {0, 1})
    for (std::size_t g = 0; g < history.group_name[s].size(); ++g) {
      const auto& toothing = drive.members[static_cast<std::size_t>(member[s])].toothing;
      const std::optional<gear::Flank> flank = gear::flank_of(toothing, history.group_name[s][g]);
      if (flank && !history.group_force[s].middleRows<3>(3 * static_cast<Eigen::Index>(g)).isZero(0))
        sides[s] |= flank->side > 0 ? kLeft : kRight;
    }
  return sides;
}

std::vector<int> sides_of_members(const Drive& drive, const std::string& result) {
  std::vector<int> sides(drive.members.size(), 0);
  for (const Case& of : read_cases(result))
    for (const drive::Pair& pair : drive.pairs) {
      const std::array<int, 2> of_pair = sides_of_pair(drive, pair, of.file);
      sides[static_cast<std::size_t>(pair.first)] |= of_pair[0];
      sides[static_cast<std::size_t>(pair.second)] |= of_pair[1];
    }
  return sides;
}

}  // namespace

RunOnMesh with_loaded_sides(RunOnMesh of, const Drive& drive, const std::string& result) {
  std::vector<int> sides(drive.members.size(), 0);
  collectively(PETSC_COMM_WORLD, [&] {
    int rank = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank == 0) sides = sides_of_members(drive, result);
  });
  MPI_Bcast(sides.data(), static_cast<int>(sides.size()), MPI_INT, 0, PETSC_COMM_WORLD);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const std::string option = drive.members[i].name + "_loaded";
    if (sides[i] != kLeft && sides[i] != kRight) continue;
    if (of.reduce.given("loaded") || of.reduce.given(option)) continue;
    for (Options* options : {&of.reduce, &of.simulate, &of.evaluate})
      options->set(option, sides[i] == kLeft ? "left" : "right");
  }
  return of;
}

}  // namespace elastogear::app
