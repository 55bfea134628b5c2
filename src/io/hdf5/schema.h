#pragma once
// Attributes that all HDF5 files of the program have: `format` and `version` at the root, and provenance.

#include <string>

#include "elastogear/mesh/mesh.h"
#include "io/hdf5/hdf5.h"

namespace elastogear::io {

/// A kind of file: its name, the version that is written, and the oldest one that is read. Version 2 has
/// checksums and text of fixed length, version 3 of a result the contact forces at nodes, version 3 of a body
/// the relaxing parts of viscoelastic materials, version 4 static responses of its relaxed states.
struct Format {
  const char* name;
  int version = 2, oldest = 1;
};
constexpr Format kBodyFormat{"elastogear body", 4}, kStressFormat{"elastogear stress"};
constexpr Format kResultFormat{"elastogear result", 3}, kLifeFormat{"elastogear life"},
    kWearFormat{"elastogear wear"};
constexpr Format kEvaluationFormat{"elastogear evaluation", 2, 2};

/// Attribute of a body file's root: model::fingerprint.
constexpr const char* kIdentity = "identity";

void write_format(const h5::File& file, const Format& format);
int version(const h5::File& file);
/// Opens a file. Error when it has another format, or a version that this program does not know.
h5::File open_format(const std::string& path, const Format& format);

/// An attribute that is 0 or 1. Error for other values.
bool read_flag(const h5::File& file, const std::string& object, const std::string& key);

/// Names in HDF5 paths; Error when empty or with a slash.
void require_name(const h5::File& file, const std::string& name);

/// Group /mesh of a body file.
void write_mesh(const h5::File& file, const mesh::Mesh& mesh);
mesh::Mesh read_mesh(const h5::File& file);

inline hsize_t extent(Eigen::Index n) { return static_cast<hsize_t>(n); }

inline h5::View<double> view(const Eigen::Matrix3Xd& X) {
  return {{static_cast<hsize_t>(X.cols()), 3}, X.data()};
}
inline h5::View<double> view(const Eigen::VectorXd& x) {
  return {{static_cast<hsize_t>(x.size())}, x.data()};
}
inline h5::View<int> view(const std::vector<int>& v) { return {{v.size()}, v.data()}; }
inline h5::View<double> view(const double& value) { return {{}, &value}; }

Eigen::Matrix3Xd read_points(const h5::File& file, const std::string& name);
Eigen::VectorXd read_vector(const h5::File& file, const std::string& name, hsize_t size = h5::kAny);
/// /time; Error unless it increases strictly.
Eigen::VectorXd read_time(const h5::File& file);

}  // namespace elastogear::io
