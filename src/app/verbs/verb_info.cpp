// elastogear info: what a file holds.

#include <cstdio>

#include "app/options/verbs.h"
#include "elastogear/base/error.h"
#include "elastogear/base/text.h"
#include "elastogear/io/describe.h"

namespace elastogear::app {
namespace {

void run_info(const Options& options, const std::vector<std::string>& files) {
  options.reject_unknown();
  require(!files.empty(), "no file given: elastogear info FILE ...");
  for (const std::string& file : files) std::fputs(printable(io::describe(file)).c_str(), stdout);
}

}  // namespace

Verb info_verb() {
  return {.name = "info",
          .usage = "info FILE ...",
          .summary = "what a mesh, body, result or stress file holds",
          .table = {},
          .run = run_info,
          .configured = false};
}

}  // namespace elastogear::app
