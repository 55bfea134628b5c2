#include "app/console/environment.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "app/console/blas_kernels.h"

namespace elastogear::app {

std::vector<std::pair<std::string, std::string>> missing_settings(const std::string& verb) {
  std::vector<std::pair<std::string, std::string>> settings;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty() && !std::getenv(name)) settings.emplace_back(name, value);
  };
  add(kBlasVariable, blas_setting());
  // Pages of 2 MB for the C library's large blocks: matrices of gigabytes are filled once, and of each small
  // page the first touch costs as much as filling it.
  if (verb == "reduce") add("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1");
  return settings;
}

void start_with_settings(const std::string& verb, char** argv) {
  const auto settings = missing_settings(verb);
  std::error_code none;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", none);
  if (settings.empty() || none) return;
  for (const auto& [name, value] : settings)
    if (setenv(name.c_str(), value.c_str(), 1) != 0) return;
  execv(program.c_str(), argv);  // returns where it fails, and all stays as it is
}

}  // namespace elastogear::app
