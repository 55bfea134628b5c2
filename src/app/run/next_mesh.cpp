#include "app/run/next_mesh.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <sstream>

#include "app/console/console.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/petsc.h"
#include "elastogear/evaluation/grid_convergence.h"

namespace elastogear::app {
namespace {

constexpr double kLongest = 1200;  // s, that one more mesh may take
constexpr double kCost = 4;        // power of the refinement that time and memory grow with

// Memory (bytes) and time (s) that one more mesh takes on rank 0, and the memory of its machine.
struct Cost {
  double memory = 0, seconds = 0, machine = 0;
};

bool is_affordable(const Cost& cost) { return cost.seconds <= kLongest && cost.memory <= cost.machine; }

// ratio: of the refinements; seconds: that the coarser mesh took. Collective.
Cost cost_of_finer(double ratio, double seconds) {
  const double times = std::pow(ratio, kCost);
  const double held = number_on_rank_0([] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
  });
  const double machine = number_on_rank_0([] {
    return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  });
  return {times * held, times * seconds, machine};
}

double at(const std::vector<double>& refinements, int mesh) {
  return refinements[static_cast<std::size_t>(mesh)];
}

}  // namespace

double number_on_rank_0(const std::function<double()>& number) {
  double value = 0;
  collectively(PETSC_COMM_WORLD, [&] {
    int rank = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank == 0) value = number();
  });
  MPI_Bcast(&value, 1, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  return value;
}

int finer_mesh(const std::vector<double>& refinements, int mesh, double error, double accuracy,
               double seconds) {
  const double here = at(refinements, mesh), least = evaluation::least_refinement(error, accuracy, here);
  int finer = mesh + 1;
  while (finer + 1 < std::ssize(refinements) && at(refinements, finer) < least &&
         is_affordable(cost_of_finer(at(refinements, finer + 1) / here, seconds)))
    ++finer;
  return finer;
}

std::string obstacle_to_finer(const std::vector<double>& refinements, int mesh, double seconds) {
  if (mesh + 1 == std::ssize(refinements)) return "there is no finer mesh on offer";
  const double next = at(refinements, mesh + 1);
  const Cost cost = cost_of_finer(next / at(refinements, mesh), seconds);
  if (is_affordable(cost)) return "";
  std::ostringstream finer;
  finer << "the next mesh would take about " << duration(cost.seconds) << " and "
        << short_number(1e-9 * cost.memory) << " GB of memory; -refinement " << next << " makes it";
  return finer.str();
}

}  // namespace elastogear::app
