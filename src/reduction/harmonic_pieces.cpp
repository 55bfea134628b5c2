#include "harmonic_pieces.h"

#include <algorithm>
#include <cstdio>

#include "elastogear/base/agree.h"

namespace elastogear::reduction {
namespace {

constexpr const char* kName = "harmonic_";

std::string piece_name(int k) {
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

bool holds(const io::PieceStore& store, const std::string& name) {
  return std::binary_search(store.names().begin(), store.names().end(), name);
}

}  // namespace

HarmonicPieces::HarmonicPieces(MPI_Comm comm, const std::string& folder, const std::string& fingerprint)
    : comm_(comm) {
  const std::string text = on_all_ranks(comm, fingerprint);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  for (const bool first : {true, false})  // rank 0 has cleaned the folder up before the others look
    agree(comm, [&] {
      if ((rank == 0) == first) store_.emplace(folder, text);
    });
  n_known_ = static_cast<int>(store_->names().size());
}

std::optional<HarmonicModes> HarmonicPieces::read(int k, double cutoff) const {
  const std::string name = piece_name(k);
  if (!holds(*store_, name)) return {};
  const io::PieceReader piece(*store_, name);
  HarmonicModes modes;
  modes.k = k;
  modes.cutoff = piece.read("cutoff")(0);
  modes.iterations = static_cast<int>(piece.read("iterations")(0));
  modes.eigenvalue = piece.read("eigenvalue");
  modes.residual = piece.read("residual");
  modes.orthogonality = piece.read("orthogonality")(0);
  modes.z = piece.read("z");
  if (modes.cutoff != cutoff) return {};
  return modes;
}

void HarmonicPieces::write(const HarmonicModes& modes) {
  io::PieceWriter piece(*store_, piece_name(modes.k));
  piece.write("cutoff", Eigen::VectorXd::Constant(1, modes.cutoff));
  piece.write("iterations", Eigen::VectorXd::Constant(1, modes.iterations));
  piece.write("eigenvalue", modes.eigenvalue);
  piece.write("residual", modes.residual);
  piece.write("orthogonality", Eigen::VectorXd::Constant(1, modes.orthogonality));
  piece.write("z", modes.z);
  piece.commit();
}

void HarmonicPieces::clear() {
  store_->clear();
  MPI_Barrier(comm_);
  store_->clear();  // the folder goes only when the last rank's pieces are gone
}

}  // namespace elastogear::reduction
