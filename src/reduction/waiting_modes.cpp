#include "reduction/waiting_modes.h"

#include <algorithm>
#include <optional>

#include "elastogear/io/checkpoint_store.h"

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kBlockBytes = 5e8;  // of a block of modes in memory, of which there are two
constexpr const char *kWaiting = "modes", *kField = "phi";

}  // namespace

struct WaitingModes::Data {
  io::CheckpointStore store;
  std::unique_ptr<io::CheckpointWriter> writer = {};
  std::optional<io::CheckpointReader> reader = {};
  Index size = 0;

  ~Data() {
    writer.reset();
    reader.reset();
    store.clear();
  }
};

WaitingModes::WaitingModes(const std::string& folder)
    : data_(new Data{io::CheckpointStore(folder, kWaiting)}) {
  data_->store.clear();  // of a run that was killed
  data_->writer = std::make_unique<io::CheckpointWriter>(data_->store, kWaiting);
}

WaitingModes::~WaitingModes() = default;

void WaitingModes::add(const Eigen::VectorXd& phi) {
  data_->writer->append(kField, phi);
  ++data_->size;
}

void WaitingModes::close() {
  data_->writer->commit();
  data_->reader.emplace(data_->store, kWaiting);
}

Index WaitingModes::size() const { return data_->size; }

Index WaitingModes::block_width(Index n_dofs) const {
  return std::clamp<Index>(static_cast<Index>(kBlockBytes / (8. * static_cast<double>(n_dofs))), 1,
                           std::max<Index>(1, data_->size));
}

MatrixXd WaitingModes::block(Index first, Index count) const {
  MatrixXd Phi;
  for (Index k = 0; k < count; ++k) {
    const Eigen::VectorXd phi = data_->reader->read_row(kField, static_cast<int>(first + k));
    if (k == 0) Phi.resize(phi.size(), count);
    Phi.col(k) = phi;
  }
  return Phi;
}

MatrixXd project(const WaitingModes& modes, const model::SparseRows& K) {
  const Index n_q = modes.size(), width = modes.block_width(K.rows());
  MatrixXd K_r(n_q, n_q);
  for (Index l = 0; l < n_q; l += width) {
    const MatrixXd K_Phi = K * modes.block(l, std::min(width, n_q - l));
    for (Index k = 0; k < n_q; k += width) {
      const MatrixXd Phi = modes.block(k, std::min(width, n_q - k));
      K_r.block(k, l, Phi.cols(), K_Phi.cols()).noalias() = Phi.transpose() * K_Phi;
    }
  }
  return (K_r + K_r.transpose()) / 2;
}

}  // namespace elastogear::reduction
