#include "reduction/nested/elimination_tree.h"

#include <utility>

#include "elastogear/base/sort_unique.h"
#include "reduction/nested/csr_view.h"
#include "reduction/nested/dissection.h"

namespace elastogear::reduction {
namespace {

using ByColumn = Eigen::SparseMatrix<double>;

void append(const std::vector<int>& from, std::vector<int>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

// Border and wanted rows of a part whose children have theirs.
void find_ties(const CsrView& K, const ByColumn& P, EliminationTree& tree, TreePart& part) {
  for (int child : {part.left, part.right}) {
    if (child < 0) continue;
    append(tree.part[child].border, part.border);
    append(tree.part[child].row, part.row);
  }
  for (int i = part.first; i < part.end; ++i) {
    const int row = tree.at[i];
    K.visit_row(row, [&](int column, double) { part.border.push_back(tree.position[column]); });
    for (ByColumn::InnerIterator it(P, row); it; ++it) part.row.push_back(static_cast<int>(it.row()));
  }
  std::erase_if(part.border, [&](int i) { return i < part.end; });
  sort_unique(part.border);
  sort_unique(part.row);
}

}  // namespace

EliminationTree make_tree(Mat K, const ByColumn& P, int largest_leaf, const std::vector<int>& kept) {
  EliminationTree tree;
  for (Part& part : dissect(K, largest_leaf, kept)) {
    const auto first = static_cast<int>(tree.at.size());
    append(part.row, tree.at);
    tree.part.push_back({first, static_cast<int>(tree.at.size()), part.left, part.right});
  }
  append(kept, tree.at);
  tree.position.resize(tree.at.size());
  for (std::size_t i = 0; i < tree.at.size(); ++i) tree.position[tree.at[i]] = static_cast<int>(i);
  const CsrView rows(K);
  for (TreePart& part : tree.part) find_ties(rows, P, tree, part);
  return tree;
}

}  // namespace elastogear::reduction
