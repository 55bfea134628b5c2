#include "elastogear/base/file.h"
#include "elastogear/io/result_file.h"
#include "io/hdf5/schema.h"
#include "io/result/result_parts.h"
#include "io/result/result_rows.h"
#include "io/result/run_input.h"

namespace elastogear::io {
namespace {

// Their order in the snapshots is that of the attribute `number`.
void write_names(const h5::File& file, const std::string& group, const std::vector<std::string>& names) {
  if (names.empty()) return;
  h5::make_group(file, group);
  for (std::size_t i = 0; i < names.size(); ++i) {
    require_name(file, names[i]);
    h5::make_group(file, group + "/" + names[i]);
    h5::set_attribute(file, group + "/" + names[i], "number", static_cast<int>(i));
  }
}

void write_header(const h5::File& file, const model::ResultHeader& header) {
  write_format(file, kResultFormat);
  h5::write_map(file, "/provenance", header.provenance);
  write_run_input(file, header.input);
  h5::make_group(file, "/bodies");
  for (std::size_t i = 0; i < header.bodies.size(); ++i) {
    const auto& body = header.bodies[i];
    require_name(file, body.name);
    h5::make_group(file, "/bodies/" + body.name);
    h5::set_attribute(file, "/bodies/" + body.name, "number", static_cast<int>(i));
    h5::set_attribute(file, "/bodies/" + body.name, "file", body.file);
    h5::set_attribute(file, "/bodies/" + body.name, "joint", body.joint);
  }
  h5::make_group(file, "/contact");
  for (std::size_t i = 0; i < header.pairs.size(); ++i) {
    const auto& pair = header.pairs[i];
    require_name(file, pair.name);
    const std::string group = "/contact/" + pair.name;
    h5::make_group(file, group);
    h5::set_attribute(file, group, "number", static_cast<int>(i));
    h5::set_attribute(file, group, "body", std::vector{pair.body[0], pair.body[1]});
    if (!pair.law.empty()) h5::set_attribute(file, group, "law", pair.law);
    if (pair.strips > 0) h5::set_attribute(file, group, "strips", pair.strips);
    h5::set_attribute(file, group, "friction", pair.friction);
    for (int side : {0, 1})
      h5::write_strings(file, group + "/groups/" + kSide[side] + "/name", pair.group_name[side]);
  }
  write_names(file, "/bushings", header.bushings);
  write_names(file, "/sensors", header.sensors);
}

void mark(const h5::File& file, bool complete) { h5::set_attribute(file, "/", "complete", complete ? 1 : 0); }

}  // namespace

// A part in the making.
struct ResultWriter::Part {
  PendingFile pending;
  h5::File file;
  ResultRows rows;

  Part(const std::string& path, const model::ResultHeader& header, const RowCount& before)
      : pending(path), file(h5::create(path, pending.temporary())), rows(file, header, before) {
    write_header(file, header);
    if (before.times > 0) h5::set_attribute(file, "/", kTimesBefore, before.times);
  }
  void commit() {
    rows.close();
    h5::close(file);
    pending.commit();
  }
};

struct ResultWriter::Data {
  std::string path;
  model::ResultHeader header;
  ResultParts parts;
  std::unique_ptr<Part> part = {};
  std::string failure = {};  // that ended the writing

  // Nothing is written after what could not be: the last checkpoint stays as it is.
  template <class Write>
  void guard(const Write& write) {
    if (!failure.empty()) throw WriteFailure(failure);
    try {
      write();
    } catch (const WriteFailure& error) {
      failure = error.what();
      part.reset();
      throw;
    }
  }
  void finish(bool complete);
  void begin_part(const RowCount& before) {
    part = std::make_unique<Part>(parts.path_of_next(), header, before);
  }
  RowCount end_part() {
    const RowCount count = part->rows.count();
    part->commit();
    part.reset();
    parts.add();
    return count;
  }
  void join(bool complete) const;
};

void ResultWriter::Data::join(bool complete) const {
  const std::string joined = parts.path("result.h5");
  PendingFile pending(joined);
  h5::File file = h5::create(path, pending.temporary());
  write_header(file, header);
  mark(file, complete);
  parts.append_to(file);
  h5::close(file);
  pending.commit();
  parts.publish(joined);
}

ResultWriter::ResultWriter(const std::string& path, const model::ResultHeader& header, bool goes_on) {
  place_of_output(path);  // an Error where nothing can be written
  data_.reset(new Data{path, header, ResultParts(path, goes_on)});
  data_->begin_part(data_->parts.count());
}

ResultWriter::~ResultWriter() {
  if (!data_) return;
  data_->part.reset();
  data_->parts.remove_if_empty();
}

int ResultWriter::n_times() const { return data_->part ? data_->part->rows.count().times : 0; }

void ResultWriter::append(const model::Snapshot& snapshot) {
  data_->guard([&] { data_->part->rows.append(snapshot); });
}

void ResultWriter::checkpoint(const std::vector<double>& state) {
  data_->guard([&] {
    const RowCount count = data_->end_part();
    data_->parts.write_state(state, count);
    data_->begin_part(count);
  });
}

void ResultWriter::Data::finish(bool complete) {
  require(part->rows.count().times > 0, path, ": there is no snapshot to write");
  if (parts.size() == 0) {  // the only part is the result
    const std::string only = parts.path_of_next();
    mark(part->file, complete);
    end_part();
    parts.publish(only);
    parts.remove();
  } else {
    end_part();
    join(complete);
    if (complete) parts.remove();
  }
}

void ResultWriter::finish(bool complete) {
  data_->guard([&] { data_->finish(complete); });
  data_.reset();
}

}  // namespace elastogear::io
