#include "reduction/job/waiting_modes.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <vector>

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
  std::map<Index, io::CheckpointReader> part = {};  // of closed rows, by the first one of each
  Index n_rows = 0, first = 0;                      // of all; of those that are being written
  std::vector<Index> row = {};                      // of each mode

  std::string next() const { return kWaiting + std::to_string(part.size()); }
  Eigen::VectorXd read(Index k) const {
    const Index at = row[static_cast<std::size_t>(k)];
    const auto& [begin, reader] = *std::prev(part.upper_bound(at));
    return reader.read_row(kField, static_cast<int>(at - begin));
  }

  ~Data() {
    writer.reset();
    part.clear();
    store.clear();
  }
};

WaitingModes::WaitingModes(const std::string& folder)
    : data_(new Data{io::CheckpointStore(folder, kWaiting)}) {
  data_->store.clear();  // of a run that was killed
}

WaitingModes::~WaitingModes() = default;

void WaitingModes::add(int k, const Eigen::VectorXd& phi) {
  if (!data_->writer) {
    data_->writer = std::make_unique<io::CheckpointWriter>(data_->store, data_->next());
    data_->first = data_->n_rows;
  }
  data_->writer->append(kField, phi);
  if (k == static_cast<int>(data_->row.size())) data_->row.push_back(0);
  data_->row.at(static_cast<std::size_t>(k)) = data_->n_rows++;
}

void WaitingModes::close() {
  if (!data_->writer) return;
  data_->writer->commit();
  data_->writer.reset();
  data_->part.try_emplace(data_->first, data_->store, data_->next());
}

Index WaitingModes::size() const { return static_cast<Index>(data_->row.size()); }

Index WaitingModes::block_width(Index n_dofs) const {
  return std::clamp<Index>(static_cast<Index>(kBlockBytes / (8. * static_cast<double>(n_dofs))), 1,
                           std::max<Index>(1, size()));
}

MatrixXd WaitingModes::block(Index first, Index count) const {
  MatrixXd Phi;
  for (Index k = 0; k < count; ++k) {
    const Eigen::VectorXd phi = data_->read(first + k);
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
