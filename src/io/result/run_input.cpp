#include "io/result/run_input.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "elastogear/base/text.h"
#include "elastogear/io/result_file.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {
namespace {

const std::string kRun = "/provenance/run", kDrive = kRun + "/drive", kInexact = kRun + "/inexact";

model::Analysis read_analysis(const h5::File& file) {
  const std::vector<std::string>& names = model::analysis_names();
  const std::string name = h5::string_attribute(file, kRun, "analysis");
  const auto found = std::find(names.begin(), names.end(), name);
  require(found != names.end(), file.path, ": ", kRun, ": attribute analysis = '", name, "', must be one of ",
          join(names));
  return static_cast<model::Analysis>(found - names.begin());
}

model::DriveInput read_drive(const h5::File& file) {
  const auto number = [&](const char* name) {
    const double value = h5::number_attribute(file, kDrive, name);
    require(std::isfinite(value), file.path, ": ", kDrive, ": attribute ", name, " = ", value,
            ", must be finite");
    return value;
  };
  return {number("roll"), number("torque"), number("speed")};
}

}  // namespace

void write_run_input(const h5::File& file, const std::optional<model::RunInput>& input) {
  if (!input) return;
  h5::make_group(file, kRun);
  h5::set_attribute(file, kRun, "analysis",
                    model::analysis_names()[static_cast<std::size_t>(input->analysis)]);
  h5::set_attribute(file, kRun, "creeps", input->creeps ? 1 : 0);
  if (!input->inexact.empty()) h5::write_strings(file, kInexact, input->inexact);
  if (!input->drive) return;
  h5::make_group(file, kDrive);
  h5::set_attribute(file, kDrive, "roll", input->drive->roll);
  h5::set_attribute(file, kDrive, "torque", input->drive->torque);
  h5::set_attribute(file, kDrive, "speed", input->drive->speed);
}

std::optional<model::RunInput> read_run_input(const h5::File& file) {
  if (!h5::exists(file, kRun)) return {};
  model::RunInput input{read_analysis(file), read_flag(file, kRun, "creeps")};
  if (h5::exists(file, kDrive)) input.drive = read_drive(file);
  if (h5::exists(file, kInexact)) input.inexact = h5::read_strings(file, kInexact);
  return input;
}

std::optional<model::RunInput> read_run_input(const std::string& path) {
  return read_run_input(h5::open(path));
}

}  // namespace elastogear::io
