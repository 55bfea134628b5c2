#include "app/run/next_mesh.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "app/console/console.h"
#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/petsc.h"
#include "elastogear/evaluation/grid_convergence.h"
#include "elastogear/io/record_file.h"

namespace elastogear::app {
namespace {

constexpr double kLongest = 1200;  // s, that one more mesh may take
constexpr double kCost = 4;        // power of the refinement that time and memory grow with

double memory_held() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

// Bytes of memory that the machine has, or that ulimit allows where that is less.
double memory_there() {
  double most = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  for (const auto resource : {RLIMIT_RSS, RLIMIT_AS}) {
    rlimit limit{};
    if (getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
      most = std::min(most, static_cast<double>(limit.rlim_cur));
  }
  return most;
}

// Collective.
bool is_affordable(const Cost& cost) {
  return cost.seconds <= kLongest && cost.memory <= number_on_rank_0(memory_there);
}

// ratio: of the refinements; cost: of the coarser mesh.
Cost cost_of_finer(double ratio, const Cost& cost) {
  const double times = std::pow(ratio, kCost);
  return {times * cost.seconds, times * cost.memory};
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

Cost known_cost(const std::string& file) {
  const auto number = [&](std::size_t i) -> double {
    try {
      const io::StoredRecord record = io::read_record(file);
      return record.numbers.size() == 2 ? record.numbers[i] : INFINITY;
    } catch (const Error&) {
      return INFINITY;
    }
  };
  return {number_on_rank_0([&] { return number(0); }), number_on_rank_0([&] { return number(1); })};
}

Cost cost_of(const std::string& file, bool of_bodies, const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  const Cost now{number_on_rank_0([&] { return taken.count(); }), number_on_rank_0(memory_held)},
      known = of_bodies ? Cost{0, 0} : known_cost(file);
  if (!std::isfinite(known.seconds)) return now;
  const Cost most{std::max(now.seconds, known.seconds), std::max(now.memory, known.memory)};
  number_on_rank_0([&] {
    std::filesystem::create_directories(std::filesystem::path(file).parent_path());
    io::write_record(file, {{}, {most.seconds, most.memory}});
    return 0;
  });
  return most;
}

int finer_mesh(const std::vector<double>& refinements, int mesh, double error, double accuracy,
               const Cost& cost) {
  const double here = at(refinements, mesh), least = evaluation::least_refinement(error, accuracy, here);
  int finer = mesh + 1;
  while (finer + 1 < std::ssize(refinements) && at(refinements, finer) < least &&
         is_affordable(cost_of_finer(at(refinements, finer + 1) / here, cost)))
    ++finer;
  return finer;
}

std::string obstacle_to_finer(const std::vector<double>& refinements, int mesh, const Cost& of_mesh) {
  if (mesh + 1 == std::ssize(refinements)) return "there is no finer mesh on offer";
  const double next = at(refinements, mesh + 1);
  const Cost cost = cost_of_finer(next / at(refinements, mesh), of_mesh);
  if (is_affordable(cost)) return "";
  std::ostringstream finer;
  finer << "the next mesh would take about " << duration(cost.seconds) << " and "
        << short_number(1e-9 * cost.memory) << " GB of memory; -refinement " << next << " makes it";
  return finer.str();
}

}  // namespace elastogear::app
