#include "reduction/cyclic/harmonic_checkpoints.h"

#include <algorithm>
#include <cstdio>

#include "elastogear/base/collectively.h"

namespace elastogear::reduction {
namespace {

constexpr const char* kName = "harmonic_";

std::string checkpoint_name(int k) {
  char digits[16];
  std::snprintf(digits, sizeof digits, "%06d", k);
  return kName + std::string(digits);
}

std::string on_all_ranks(MPI_Comm comm, std::string text) {
  int length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, comm);
  text.resize(length);
  MPI_Bcast(text.data(), length, MPI_CHAR, 0, comm);
  return text;
}

bool holds(const io::CheckpointStore& store, const std::string& name) {
  return std::binary_search(store.names().begin(), store.names().end(), name);
}

}  // namespace

HarmonicCheckpoints::HarmonicCheckpoints(MPI_Comm comm, const std::string& folder,
                                         const std::string& fingerprint)
    : comm_(comm) {
  const std::string text = on_all_ranks(comm, fingerprint);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  for (const bool first : {true, false})  // rank 0 has cleaned the folder up before the others look
    collectively(comm, [&] {
      if ((rank == 0) == first) store_.emplace(folder, text);
    });
  n_known_ = static_cast<int>(store_->names().size());
}

std::optional<HarmonicModes> HarmonicCheckpoints::read(int k, double cutoff) const {
  const std::string name = checkpoint_name(k);
  if (!holds(*store_, name)) return {};
  const io::CheckpointReader checkpoint(*store_, name);
  HarmonicModes modes;
  modes.k = k;
  modes.cutoff = checkpoint.read("cutoff")(0);
  modes.iterations = static_cast<int>(checkpoint.read("iterations")(0));
  modes.eigenvalue = checkpoint.read("eigenvalue");
  modes.residual = checkpoint.read("residual");
  modes.orthogonality = checkpoint.read("orthogonality")(0);
  modes.z = checkpoint.read("z");
  if (modes.cutoff != cutoff) return {};
  return modes;
}

void HarmonicCheckpoints::write(const HarmonicModes& modes) {
  io::CheckpointWriter checkpoint(*store_, checkpoint_name(modes.k));
  checkpoint.write("cutoff", Eigen::VectorXd::Constant(1, modes.cutoff));
  checkpoint.write("iterations", Eigen::VectorXd::Constant(1, modes.iterations));
  checkpoint.write("eigenvalue", modes.eigenvalue);
  checkpoint.write("residual", modes.residual);
  checkpoint.write("orthogonality", Eigen::VectorXd::Constant(1, modes.orthogonality));
  checkpoint.write("z", modes.z);
  checkpoint.commit();
}

void HarmonicCheckpoints::clear() {
  store_->clear();
  MPI_Barrier(comm_);
  store_->clear();  // the folder goes only when the last rank's checkpoints are gone
}

}  // namespace elastogear::reduction
