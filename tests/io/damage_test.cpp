// Bytes of files that change after they were written: every change is found, or has no effect.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/io/describe.h"
#include "elastogear/io/stress_file.h"
#include "io/hdf5/hdf5_api.h"
#include "sample_body.h"
#include "sample_result.h"

namespace elastogear::damage_test {
using namespace io;
using testing::AllOf;
using testing::HasSubstr;

namespace {

// Everything that a reader gives, as text that differs when one bit does.
using Reading = std::function<std::string(const std::string& path)>;

void add(std::string& all, const double* x, Eigen::Index n) {
  all.append(reinterpret_cast<const char*>(x), static_cast<std::size_t>(n) * sizeof(double));
}
template <class... Matrices>
void add_each(std::string& all, const Matrices&... m) {
  (add(all, Eigen::MatrixXd(m).data(), m.size()), ...);
}

std::string bytes_of(hid_t object, hid_t space, hid_t type, const std::function<herr_t(hid_t, void*)>& fill) {
  std::string bytes(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)) * H5Tget_size(type), '\0');
  EXPECT_GE(fill(type, bytes.data()), 0) << object;
  H5Tclose(type);
  H5Sclose(space);
  return bytes;
}

herr_t add_attribute(hid_t object, const char* name, const H5A_info_t*, void* all) {
  const hid_t id = H5Aopen(object, name, H5P_DEFAULT);
  static_cast<std::string*>(all)->append(
      name + bytes_of(id, H5Aget_space(id), H5Aget_type(id),
                      [id](hid_t type, void* data) { return H5Aread(id, type, data); }));
  H5Aclose(id);
  return 0;
}

herr_t add_object(hid_t file, const char* name, const H5O_info_t* info, void* all) {
  const hid_t id = H5Oopen(file, name, H5P_DEFAULT);
  static_cast<std::string*>(all)->append(name);
  H5Aiterate2(id, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_attribute, all);
  if (info->type == H5O_TYPE_DATASET)
    static_cast<std::string*>(all)->append(bytes_of(
        id, H5Dget_space(id), H5Dget_type(id),
        [id](hid_t type, void* data) { return H5Dread(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data); }));
  H5Oclose(id);
  return 0;
}

// All that a file holds.
std::string contents(const std::string& path) {
  std::string all;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_GE(H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, add_object, &all), 0);
  H5Fclose(file);
  return all;
}

// What was read, written again.
std::string reading_of_body(const std::string& path) {
  const model::ElasticBody body = read_body(path);
  Eigen::MatrixXd modes(3 * read_body_source(path).mesh.n_nodes(), body.n_q());
  for (Eigen::Index k = 0; k < body.n_q(); ++k)
    modes.col(k) = read_displacement_field(path, Eigen::VectorXd::Unit(body.n_q(), k)).reshaped();
  const std::string again = path + ".again";
  BodyWriter writer(again, static_cast<int>(modes.rows() / 3), static_cast<int>(modes.cols()));
  for (Eigen::Index k = 0; k < body.n_q(); ++k) writer.write_mode(static_cast<int>(k), modes.col(k));
  writer.finish(body, read_body_source(path), read_mode_checks(path));
  return contents(again);
}

std::string reading_of_result(const std::string& path) {
  std::string all = describe(path);
  add_each(all, read_times(path));
  for (const char* name : {"wheel", "ground"}) {
    const BodyHistory h = read_body_history(path, name);
    add_each(all, h.q, h.q_dot, h.q_ddot, h.s, h.s_dot, h.s_ddot, h.r_WB, h.R_WB);
    const model::ForceHistory f = read_contact_forces(path, name, sample_surface());
    for (int node : f.node) all += std::to_string(node) + " ";
    add_each(all, f.force);
  }
  const PairHistory p = read_pair_history(path, "wheel:ground");
  add_each(all, p.force, p.torque, p.count.cast<double>(), p.penetration, p.area, p.pressure, p.sliding_speed,
           p.friction_power, p.damping_power, p.group_force[0], p.group_force[1]);
  const EnergyHistory e = read_energies(path);
  add_each(all, e.kinetic, e.elastic, e.contact, e.dissipated, e.work, e.balance, e.bushing);
  for (const char* name : {"left", "right"}) {
    const BushingHistory b = read_bushing_history(path, name);
    add_each(all, b.displacement, b.angle, b.force, b.torque);
  }
  const SensorHistory s = read_sensor_history(path, "tip");
  add_each(all, s.position, s.velocity, s.acceleration, s.rotation, s.angular_velocity);
  for (const auto& contacts : read_contacts(path, "wheel:ground"))
    for (const model::ContactRecord& c : contacts)
      add_each(all, Eigen::Vector3d(c.f), Eigen::Vector3d(c.slip),
               Eigen::Vector4d(c.xi, c.eta, c.g_n, c.pressure),
               Eigen::Vector3d(c.slave_side, c.slave_node, c.face));
  return all;
}

std::string reading_of_stress(const std::string& path) {
  const StressFile history = read_stress(path);
  std::string all = describe(path);
  add_each(all, history.time);
  for (const StressSet& set : history.sets) {
    all += set.body + set.set;
    for (int node : set.node) all += std::to_string(node);
    add_each(all, set.stress, set.von_mises, set.rankine, set.X, set.error, set.peak_error);
  }
  return all;
}

struct Damage : testing::Test {
  mesh::Folder folder{"damage"};
  std::string path = folder / "a.h5", whole, reading;
  Reading read;

  void use(Reading reader) {
    read = std::move(reader);
    whole = read_file(path);
    reading = read(path);
  }
  // With the byte changed as the exponent of a number may be.
  void change(std::size_t byte) const {
    std::string content = whole;
    content[byte] = static_cast<char>(content[byte] ^ 0x10);
    write_file(path, content);
  }
  // Found, or without effect.
  bool harmless() const { return found() || read(path) == reading; }
  bool found() const {
    try {
      read(path);
      return false;
    } catch (const Error&) {
      return true;
    }
  }
  void expect_all_found() const {
    constexpr std::size_t kPlaces = 200;
    std::size_t n_found = 0;
    for (std::size_t i = 0; i < kPlaces; ++i) {
      const std::size_t byte = (2 * i + 1) * whole.size() / (2 * kPlaces);
      change(byte);
      const bool was_found = found();
      EXPECT_TRUE(was_found || read(path) == reading) << "byte " << byte << " of " << whole.size();
      n_found += was_found;
    }
    EXPECT_GE(n_found, kPlaces / 2);  // the rest lies between objects
  }
};

void make_body(const std::string& path) {
  model::ElasticBody body = sample_modal_body();
  body.provenance = {{"elastogear", "0.1.0"}};
  write_modal(path, body, sample_modes());
}

void make_stress(const std::string& path) {
  const auto random = [](int rows, int columns) {
    return Eigen::MatrixXd(Eigen::MatrixXd::Random(rows, columns));
  };
  StressFile history{Eigen::Vector2d(0, 1e-6), {}, {{"elastogear", "0.1.0"}}};
  history.sets = {{"worm",
                   "root",
                   {4, 7},
                   random(12, 2),
                   random(2, 2),
                   random(2, 2),
                   random(3, 2),
                   random(2, 2),
                   random(2, 1)}};
  write_stress(path, history);
}

TEST_F(Damage, of_any_byte_of_a_body_is_found) {
  make_body(path);
  use(reading_of_body);
  expect_all_found();
}

TEST_F(Damage, of_any_byte_of_a_result_is_found) {
  write_result(path, sample_snapshots(10));
  use(reading_of_result);
  expect_all_found();
}

TEST_F(Damage, of_any_byte_of_a_stress_file_is_found) {
  make_stress(path);
  use(reading_of_stress);
  expect_all_found();
}

// Where the numbers of a dataset lie in the file; nothing for those in its header.
struct Place {
  std::string dataset;
  haddr_t address;
  hsize_t bytes;
};

herr_t add_places(hid_t file, const char* name, const H5O_info_t* info, void* found) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT), properties = H5Dget_create_plist(dataset),
              space = H5Dget_space(dataset);
  if (H5Pget_layout(properties) == H5D_CHUNKED) {
    hsize_t n = 0;
    EXPECT_GE(H5Dget_num_chunks(dataset, space, &n), 0);
    for (hsize_t i = 0; i < n; ++i) {
      hsize_t offset[H5S_MAX_RANK];
      unsigned mask = 1;
      Place place{"/" + std::string(name), 0, 0};
      EXPECT_GE(H5Dget_chunk_info(dataset, space, i, offset, &mask, &place.address, &place.bytes), 0);
      EXPECT_EQ(mask, 0u) << name;  // no filter was left out
      static_cast<std::vector<Place>*>(found)->push_back(place);
    }
  } else {
    const bool one_number =
        H5Pget_layout(properties) == H5D_COMPACT && H5Sget_simple_extent_ndims(space) == 0;
    EXPECT_TRUE(one_number || H5Sget_simple_extent_npoints(space) == 0) << name << " has no checksum";
  }
  H5Sclose(space);
  H5Pclose(properties);
  H5Dclose(dataset);
  return 0;
}

std::vector<Place> places(const std::string& path) {
  std::vector<Place> found;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_GE(H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, add_places, &found), 0);
  H5Fclose(file);
  return found;
}

bool hdf5_reads(const std::string& path, const std::string& name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
              dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT), space = H5Dget_space(dataset),
              type = H5Dget_type(dataset);
  std::vector<char> buffer(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)) * H5Tget_size(type));
  const bool good = H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer.data()) >= 0;
  H5Tclose(type);
  H5Sclose(space);
  H5Dclose(dataset);
  H5Fclose(file);
  return good;
}

TEST_F(Damage, of_the_numbers_of_every_dataset_is_found) {
  const std::vector<std::pair<std::function<void(const std::string&)>, Reading>> kinds = {
      {make_body, reading_of_body},
      {[](const std::string& file) { write_result(file, sample_snapshots(10)); }, reading_of_result},
      {make_stress, reading_of_stress}};
  for (const auto& [make, reader] : kinds) {
    make(path);
    use(reader);
    const std::vector<Place> all = places(path);
    EXPECT_GE(all.size(), 5u);
    for (const Place& place : all) {
      change(place.address + place.bytes / 3);
      EXPECT_FALSE(hdf5_reads(path, place.dataset)) << place.dataset;
      EXPECT_TRUE(harmless()) << place.dataset;
    }
  }
}

TEST_F(Damage, is_named_with_file_and_dataset) {
  make_body(path);
  use(reading_of_body);
  for (const Place& place : places(path)) {
    if (place.dataset != "/reduced/K") continue;
    change(place.address + 3);
    try {
      read_body(path);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr(path), HasSubstr("damaged: checksum of /reduced/K")));
    }
  }
}

TEST_F(Damage, of_times_that_a_checksum_misses_is_found) {
  std::vector<model::Snapshot> snapshots = sample_snapshots(10);
  write_result(path, snapshots);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT),
              time = H5Dopen2(file, "/time", H5P_DEFAULT);
  std::vector<double> times(10);
  for (int i = 0; i < 10; ++i) times[i] = i == 8 ? 3e-6 : 1e-6 * i;
  H5Dwrite(time, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, times.data());
  H5Dclose(time);
  H5Fclose(file);
  try {
    read_energies(path);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/time does not increase"));
  }
}

}  // namespace
}  // namespace elastogear::damage_test
