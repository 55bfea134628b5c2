#include "io/hdf5/chunks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "io/hdf5/fletcher32.h"
#include "sample_body.h"

namespace elastogear::chunks_test {
using namespace io;

namespace {

constexpr hsize_t kRows = 23, kColumns = 7;

template <class T>
std::vector<T> some_numbers(hsize_t n) {
  std::vector<T> numbers(n);
  for (hsize_t i = 0; i < n; ++i) numbers[i] = static_cast<T>(0.1 * static_cast<double>(i * i) - 3);
  return numbers;
}

struct Chunks : testing::Test {
  mesh::Folder folder{"chunks"};
  h5::File file = h5::create(folder / "some.h5", folder / "some.h5");

  // Chunks of `rows_per_chunk` rows of `numbers`.
  template <class T>
  h5::Id dataset(const std::string& name, const std::vector<T>& numbers, hsize_t rows_per_chunk) const {
    const h5::Chunked layout{
        {numbers.size() / kColumns, kColumns}, {rows_per_chunk, kColumns}, "1", std::is_same_v<T, float>};
    h5::Id id = h5::create_chunked(file, name, layout);
    H5Dwrite(id, std::is_same_v<T, float> ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL,
             H5P_DEFAULT, numbers.data());
    H5Fflush(file.id, H5F_SCOPE_LOCAL);
    return id;
  }

  // The bytes of the first chunk, its checksum at the end.
  static std::vector<char> stored(hid_t dataset) {
    const hsize_t offset[2] = {0, 0};
    hsize_t bytes = 0;
    std::uint32_t mask = 0;
    H5Dget_chunk_storage_size(dataset, offset, &bytes);
    std::vector<char> chunk(bytes);
    H5Dread_chunk(dataset, H5P_DEFAULT, offset, &mask, chunk.data());
    return chunk;
  }
};

TEST_F(Chunks, has_the_checksum_of_hdf5) {
  std::vector<std::vector<double>> samples;
  for (hsize_t rows : {1, 2, 5, 600, 3000}) samples.push_back(some_numbers<double>(rows * kColumns));
  samples.emplace_back(100 * kColumns, 0.0);
  // All bytes 0xff: each word is 65535, zero modulo 65535.
  double all_ones = 0;
  std::memset(&all_ones, 0xff, sizeof all_ones);
  samples.emplace_back(100 * kColumns, all_ones);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const h5::Id id = dataset("/sample" + std::to_string(i), samples[i], samples[i].size() / kColumns);
    const std::vector<char> chunk = stored(id);
    const std::size_t n = chunk.size() - 4;
    ASSERT_EQ(n, samples[i].size() * sizeof(double));
    std::uint32_t checksum = 0;
    std::memcpy(&checksum, chunk.data() + n, 4);
    EXPECT_EQ(h5::fletcher32(chunk.data(), n), checksum) << i;
  }
}

template <class T>
void expect_all_ranges(const Chunks& test, const std::string& name) {
  const std::vector<T> numbers = some_numbers<T>(kRows * kColumns);
  for (hsize_t rows_per_chunk : {1, 4, 23}) {
    const h5::Id id = test.dataset(name + std::to_string(rows_per_chunk), numbers, rows_per_chunk);
    for (hsize_t first = 0; first < kRows; ++first)
      for (hsize_t n = 1; first + n <= kRows; ++n) {
        std::vector<T> read(n * kColumns + 1, T(-1));
        EXPECT_EQ(h5::read_chunks(id, {first, {n, kColumns}}, read.data()), true);
        EXPECT_TRUE(std::equal(read.begin(), read.end() - 1, numbers.begin() + first * kColumns));
        EXPECT_EQ(read.back(), T(-1)) << "a number behind the rows was written";
      }
  }
}

TEST_F(Chunks, gives_any_rows) {
  expect_all_ranges<double>(*this, "/double");
  expect_all_ranges<float>(*this, "/float");
}

// HDF5 refuses a chunk whose checksum is wrong.
TEST_F(Chunks, are_written_as_hdf5_reads_them) {
  const std::vector<double> numbers = some_numbers<double>(24 * kColumns);
  for (hsize_t rows_per_chunk : {1, 4}) {
    const h5::Id id = h5::create_chunked(file, "/written" + std::to_string(rows_per_chunk),
                                         {{24, kColumns}, {rows_per_chunk, kColumns}, "1"});
    for (hsize_t first : {0, 8, 16})
      EXPECT_EQ(h5::write_chunks(id, {first, {8, kColumns}}, numbers.data() + first * kColumns), true);
    std::vector<double> read(numbers.size());
    EXPECT_GE(H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()), 0);
    EXPECT_EQ(read, numbers);
  }
}

TEST_F(Chunks, leaves_parts_of_chunks_and_other_layouts_to_hdf5_to_write) {
  const std::vector<double> numbers = some_numbers<double>(kRows * kColumns);
  const h5::Id id = dataset("/some", numbers, 4),
               single = dataset("/single", some_numbers<float>(kColumns), 1);
  EXPECT_EQ(h5::write_chunks(id, {2, {4, kColumns}}, numbers.data()), std::nullopt);
  EXPECT_EQ(h5::write_chunks(id, {20, {3, kColumns}}, numbers.data()), std::nullopt);
  EXPECT_EQ(h5::write_chunks(single, {0, {1, kColumns}}, numbers.data()), std::nullopt);
  h5::write_rows(file, id, {2, {4, kColumns}}, numbers.data());
  std::vector<double> read(4 * kColumns);
  h5::read_rows(file, "/some", {2, {4, kColumns}}, read.data());
  EXPECT_TRUE(std::equal(read.begin(), read.end(), numbers.begin()));
}

TEST_F(Chunks, finds_numbers_that_are_not_finite) {
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    std::vector<double> numbers = some_numbers<double>(kRows * kColumns), read(numbers.size());
    numbers[10 * kColumns + 3] = bad;
    const h5::Id id = dataset(std::isnan(bad) ? "/nan" : "/infinite", numbers, 4);
    EXPECT_EQ(h5::read_chunks(id, {0, {kRows, kColumns}}, read.data()), false);
    EXPECT_EQ(h5::read_chunks(id, {11, {3, kColumns}}, read.data()), true);
  }
}

TEST_F(Chunks, leaves_other_layouts_to_hdf5) {
  const std::vector<double> numbers = some_numbers<double>(kRows * kColumns);
  std::vector<double> read(numbers.size());
  h5::write<double>(file, "/compressed", {{kRows, kColumns}, numbers.data()}, "1", true);
  const h5::Id compressed(H5Dopen2(file.id, "/compressed", H5P_DEFAULT)),
      single = dataset("/single", some_numbers<float>(kRows * kColumns), 4);
  EXPECT_EQ(h5::read_chunks(compressed, {0, {kRows, kColumns}}, read.data()), std::nullopt);
  EXPECT_EQ(h5::read_chunks(single, {0, {kRows, kColumns}}, read.data()), std::nullopt);
  EXPECT_EQ(h5::read_chunks(single, {kRows, {1, kColumns}}, read.data()), std::nullopt);
}

TEST_F(Chunks, visits_all_rows_of_any_layout) {
  const std::vector<double> numbers = some_numbers<double>(30'000 * kColumns);  // more than one chunk
  for (bool compressed : {false, true}) {
    const std::string name = compressed ? "/compressed" : "/plain";
    h5::write<double>(file, name, {{30'000, kColumns}, numbers.data()}, "1", compressed);
    hsize_t next = 0, wrong = 0;
    h5::visit_rows(file, name, [&](hsize_t row, const double* values) {
      wrong += row != next++ || !std::equal(values, values + kColumns, numbers.data() + row * kColumns);
    });
    EXPECT_EQ(next, 30'000u);
    EXPECT_EQ(wrong, 0u);
  }
}

}  // namespace
}  // namespace elastogear::chunks_test
