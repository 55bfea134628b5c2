#include "elastogear/model/lazy_rows.h"

#include <algorithm>
#include <utility>

#include "elastogear/base/memory.h"

namespace elastogear::model {

// Memory that nothing has been read to is not touched.
LazyRows::LazyRows(RowBounds bounds, Eigen::Index n_at_once, Read read)
    : state_(std::make_shared<State>(State{std::move(bounds), n_at_once, std::move(read), {}, {}})) {
  const Eigen::Index n_groups = (rows() / 3 + n_at_once - 1) / n_at_once;
  state_->rows.resize(rows(), cols());
  state_->is_read.assign(static_cast<std::size_t>(n_groups), false);
}

void LazyRows::read(Eigen::Index group, Eigen::Index end) const {
  const Eigen::Index first = group * state_->n_at_once, last = std::min(end * state_->n_at_once, rows() / 3);
  state_->read(first, last - first, state_->rows.data() + 3 * first * cols());
  std::fill(state_->is_read.begin() + group, state_->is_read.begin() + end, true);
}

const DenseRows& LazyRows::all() const {
  const std::vector<bool>& is_read = state_->is_read;
  if (std::find(is_read.begin(), is_read.end(), true) == is_read.end())
    use_large_pages(state_->rows.data(), sizeof(double) * static_cast<std::size_t>(state_->rows.size()));
  for (auto at = std::find(is_read.begin(), is_read.end(), false); at != is_read.end();
       at = std::find(at, is_read.end(), false))
    read(at - is_read.begin(), std::find(at, is_read.end(), true) - is_read.begin());
  return state_->rows;
}

}  // namespace elastogear::model
