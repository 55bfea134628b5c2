#include "app/sweep/sweep_units.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "elastogear/base/error.h"
#include "elastogear/io/record_file.h"

namespace elastogear::app {
namespace {

namespace fs = std::filesystem;

std::size_t chunk_count(std::size_t n_positions) { return (n_positions + kUnitLength - 1) / kUnitLength; }

void visit(dynamics::RunSummary& run, Archive& archive) {
  for (int* n : {&run.steps, &run.rejected_steps, &run.newton_iterations, &run.most_contacts}) archive(*n);
  for (double* x : {&run.unbalanced, &run.wall_time}) archive(*x);
  archive.each(run.pair, [&](dynamics::PairSummary& pair) {
    for (double* x : {&pair.peak_force, &pair.peak_time, &pair.penetration}) archive(*x);
    archive(pair.patch_nodes);
  });
}

void visit(UnitResult& result, Archive& archive) {
  visit(result.summary.run, archive);
  archive(result.summary.restarts);
  archive.each(result.summary.missing,
               [&](dynamics::MissingPosition& missing) { archive(missing.position); });
  archive.each(result.snapshots, [&](model::Snapshot& snapshot) { io::serialize(snapshot, archive); });
}

constexpr const char* kUnit = "unit_";  // file names begin so

// Reads a record of an earlier sweep. Error with the remedy where another version of the program wrote it, or
// where it is damaged.
template <class Take>
auto read_left(const std::string& file, const Take& take) {
  try {
    return take(io::read_record(file));
  } catch (const Error& error) {
    const std::string why = error.what();
    fail(why.starts_with(file) ? "" : file + ": ", why, "; -resume discard begins anew");
  }
}

std::string why_key(std::size_t i) { return "why_" + std::to_string(i); }

}  // namespace

std::vector<SweepUnit> sweep_units(std::size_t n_cases, std::size_t n_positions) {
  std::vector<SweepUnit> units;
  for (std::size_t number = 0; number < n_cases; ++number)
    for (std::size_t chunk = 0; chunk < chunk_count(n_positions); ++chunk) units.push_back({number, chunk});
  return units;
}

dynamics::SweepSettings unit_settings(const SweepUnit& unit, const std::vector<double>& positions) {
  const std::size_t first = unit.chunk * kUnitLength, end = std::min(first + kUnitLength, positions.size());
  dynamics::SweepSettings settings;
  settings.positions.assign(positions.begin() + static_cast<std::ptrdiff_t>(first),
                            positions.begin() + static_cast<std::ptrdiff_t>(end));
  if (first > 0) settings.lead_in = positions[first - 1];
  return settings;
}

UnitStore::UnitStore(const std::string& output) : folder_(output + ".partial") {}

std::string UnitStore::path(const SweepUnit& unit) const {
  char name[64];
  std::snprintf(name, sizeof name, "%s%07zu_%07zu.h5", kUnit, unit.number + 1, unit.chunk + 1);
  return (fs::path(folder_) / name).string();
}

std::string UnitStore::input_path() const { return (fs::path(folder_) / "sweep.h5").string(); }

std::optional<std::map<std::string, std::string>> UnitStore::earlier_input() const {
  if (!fs::is_regular_file(input_path())) return {};
  return read_left(input_path(), [](io::StoredRecord record) { return std::move(record.text); });
}

void UnitStore::begin(const std::map<std::string, std::string>& input) const {
  remove();
  std::error_code error;
  fs::create_directories(folder_, error);
  require(!error, folder_, ": the folder for parts of the result cannot be made: ", error.message());
  io::write_record(input_path(), {input, {}});
}

bool UnitStore::has(const SweepUnit& unit) const { return fs::is_regular_file(path(unit)); }

bool UnitStore::has_units() const {
  std::error_code error;
  const fs::directory_iterator files(folder_, error);
  return std::any_of(fs::begin(files), fs::end(files), [](const fs::directory_entry& entry) {
    return entry.path().extension() == ".h5" && entry.path().filename().string().starts_with(kUnit);
  });
}

void UnitStore::write(const SweepUnit& unit, UnitResult& result) const {
  Archive archive;
  visit(result, archive);
  io::StoredRecord record{{}, archive.numbers()};
  for (std::size_t i = 0; i < result.summary.missing.size(); ++i)
    record.text[why_key(i)] = result.summary.missing[i].why;
  io::write_record(path(unit), record);
}

UnitResult UnitStore::read(const SweepUnit& unit) const {
  return read_left(path(unit), [](io::StoredRecord record) {
    Archive archive(std::move(record.numbers));
    UnitResult result;
    visit(result, archive);
    archive.finish();
    for (std::size_t i = 0; i < result.summary.missing.size(); ++i)
      result.summary.missing[i].why = record.text[why_key(i)];
    return result;
  });
}

void UnitStore::remove() const {
  std::error_code error;
  std::vector<fs::path> doomed;
  for (const auto& entry : fs::directory_iterator(folder_, error)) {
    const std::string name = entry.path().filename().string();
    const bool own = name.starts_with(kUnit) || name.starts_with("sweep.h5");
    if (own && name.find(".h5") != std::string::npos) doomed.push_back(entry.path());
  }
  for (const fs::path& file : doomed) fs::remove(file, error);
  fs::remove(folder_, error);  // fails when it holds other files
}

}  // namespace elastogear::app
