#include "io/body/row_bounds_group.h"

#include <cinttypes>
#include <cstdio>
#include <memory>
#include <utility>

#include "elastogear/model/row_bounds.h"

namespace elastogear::io {
namespace {

const std::string kRows = "/surface/Phi";
const std::string kBounds = "/surface/bounds";
constexpr std::size_t kDigits = 16;  // of a word

std::string words(const std::array<std::uint64_t, 4>& digest) {
  std::string text;
  for (std::uint64_t word : digest) {
    char digits[kDigits + 1];
    std::snprintf(digits, sizeof digits, "%016" PRIx64, word);
    text += digits;
  }
  return text;
}

std::array<std::uint64_t, 4> parse_words(const h5::File& file, const std::string& text) {
  require(text.size() == 4 * kDigits && text.find_first_not_of("0123456789abcdef") == std::string::npos,
          file.path, ": ", kBounds, ": attribute digest must be ", 4 * kDigits, " hexadecimal digits");
  std::array<std::uint64_t, 4> digest{};
  for (std::size_t i = 0; i < digest.size(); ++i)
    digest[i] = std::stoull(text.substr(i * kDigits, kDigits), nullptr, 16);
  return digest;
}

model::RowBounds read_bounds(const h5::File& file, hsize_t n_s, hsize_t n_q) {
  const auto vector = [&](const char* name, hsize_t n) {
    Eigen::VectorXd x = read_vector(file, kBounds + name, n);
    require((x.array() >= 0).all(), file.path, ": ", kBounds, name, " must not be negative");
    return x;
  };
  return {vector("/compliance", n_s), vector("/mobility", n_s),
          vector("/square", n_s),     vector("/largest", n_q),
          vector("/strain", 1)[0],    parse_words(file, h5::string_attribute(file, kBounds, "digest"))};
}

}  // namespace

void write_row_bounds(const h5::File& file, const model::ElasticBody& body) {
  const std::optional<model::RowBounds> bounds = model::row_bounds(body);
  if (!bounds) return;
  h5::make_group(file, kBounds);
  h5::write<double>(file, kBounds + "/compliance", view(bounds->compliance), "m/N");
  h5::write<double>(file, kBounds + "/mobility", view(bounds->mobility), "1/kg");
  h5::write<double>(file, kBounds + "/square", view(bounds->square), "1/kg");
  h5::write<double>(file, kBounds + "/largest", view(bounds->largest), "kg^-1/2");
  h5::write<double>(file, kBounds + "/strain", {{1}, &bounds->strain}, "1/J");
  h5::set_attribute(file, kBounds, "digest", words(bounds->digest));
}

bool has_row_bounds(const h5::File& file) { return h5::exists(file, kBounds); }

model::LazyRows lazy_rows(const h5::File& file, const model::ElasticBody& body) {
  const std::optional<model::RowWeights> weights = model::row_weights(body);
  require(weights.has_value(), file.path, ": ", kBounds,
          " belongs to diagonal and positive reduced matrices");
  const hsize_t n_s = extent(body.surface.X.cols()), n_q = extent(body.n_q());
  require(h5::shape(file, kRows) == h5::Shape{n_s, 3, n_q}, file.path, ": ", kRows, " must have the shape ",
          n_s, " x 3 x ", n_q);
  model::RowBounds bounds = read_bounds(file, n_s, n_q);
  const auto kept = std::make_shared<const h5::File>(open_format(file.path, kBodyFormat));
  const auto known = std::make_shared<const model::RowBounds>(bounds);
  const auto read = [=](Eigen::Index first, Eigen::Index n, double* rows) {
    h5::read_rows(*kept, kRows, {extent(first), {extent(n), 3, n_q}}, rows);
    require(model::are_bounds_of(*known, *weights, first, n, rows), kept->path, ": ", kBounds,
            " is not that of ", kRows, ": reduce the body again");
  };
  return {std::move(bounds), static_cast<Eigen::Index>(h5::rows_together(file, kRows)), read};
}

}  // namespace elastogear::io
