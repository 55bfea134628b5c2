#include "reduction/static_response/nested_response.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace elastogear::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;
using ByRow = model::SparseRows;

constexpr int kLargestLeaf = 250;     // rows of K, where there are separators
constexpr std::size_t kGroup = 1024;  // loads that go through the parts together
constexpr Index kBalanced = 64;       // of them, that are balanced together

// P with rows for the inertia forces of rigid motions below.
ByRow with_inertia(const ByRow& P, const MatrixXd& M_R) {
  const ByRow rigid = M_R.transpose().sparseView(0, 0);
  ByRow all(P.rows() + rigid.rows(), P.cols());
  all.topRows(P.rows()) = P;
  all.bottomRows(rigid.rows()) = rigid;
  return all;
}

template <class T>
Contributions<T> terms(const EliminationTask& task, KeptRows* left,
                       const std::function<void(double)>& progress) {
  Contributions<T> contributions = eliminate<T>(task, left, progress);
  const Eigen::VectorXd scale = row_scales(contributions, static_cast<int>(task.P.rows()));
  for (Contribution<T>& c : contributions)
    if (c.is_ordered) order_rows(scale, c);
  return contributions;
}

}  // namespace

// Nested: separators by the square of the unknowns, leaves by their rows, products of wanted rows and loads,
// of loads with each other half of them, by the size of the largest separator, of whose columns some are left
// out. Whole: factor and solutions after nested dissection (docs/performance.md).
ResponseFlops response_flops(double unknowns, double wanted, double n_loads) {
  constexpr double kSeparators = 14, kLeafRow = 0.4e6, kProducts = 0.6, kEntries = 17, kFactor = 8;
  const double squared = unknowns * unknowns;
  return {kSeparators * squared + kLeafRow * unknowns +
              kProducts * (2 * wanted - n_loads) * n_loads * std::pow(unknowns, 2. / 3),
          kFactor * squared + 4 * kEntries * std::pow(unknowns, 4. / 3) * n_loads};
}

NestedResponse::NestedResponse(Mat K, const ByRow& P, const std::vector<int>& loads, const RigidFields& rigid,
                               int largest_leaf, std::function<void(double)> progress)
    : n_rows_(P.rows() + rigid.M_R.cols()), progress_(std::move(progress)) {
  if (largest_leaf == 0) {
    const auto [nested, whole] = response_flops(static_cast<double>(P.cols()), static_cast<double>(P.rows()),
                                                static_cast<double>(loads.size()));
    largest_leaf = nested < whole ? kLargestLeaf : static_cast<int>(P.cols());
  }
  std::vector<int> all = loads;
  for (Index i = P.rows(); i < n_rows_; ++i) all.push_back(static_cast<int>(i));
  if (rigid.M_R.cols() > 0)
    contributions_ =
        terms<double>({K, with_inertia(P, rigid.M_R), all, largest_leaf}, nullptr, report_elimination());
  else
    contributions_ = terms<float>({K, P, all, largest_leaf}, nullptr, report_elimination());
  group(loads);
  if (rigid.M_R.cols() > 0) balance(P, rigid);
}

NestedResponse::NestedResponse(Mat K, const ByRow& P, const std::vector<int>& loads,
                               const std::vector<int>& kept, KeptRows& left,
                               std::function<void(double)> progress)
    : n_rows_(P.rows()), progress_(std::move(progress)) {
  contributions_ = terms<double>({K, P, loads, kLargestLeaf, kept}, &left, report_elimination());
  group(loads);
}

std::function<void(double)> NestedResponse::report_elimination() {
  return [this](double share) {
    eliminated_ = share;
    if (progress_) progress_(share);
  };
}

// With the inertia forces M R of unit rigid accelerations:
// drift = P K^-1 M R - P R (M R)' K^-1 M R.
void NestedResponse::balance(const ByRow& P, const RigidFields& rigid) {
  std::vector<int> inertia(static_cast<std::size_t>(rigid.M_R.cols()));
  std::iota(inertia.begin(), inertia.end(), static_cast<int>(P.rows()));
  const MatrixXd to_inertia = plain<double>(inertia);
  P_R_ = P * rigid.R;
  drift_ = to_inertia.topRows(P.rows()) - P_R_ * to_inertia.bottomRows(rigid.M_R.cols());
}

// Loads that the same parts feel come together: they are
// ordered by the first part that feels them.
void NestedResponse::group(std::vector<int> loads) {
  std::vector<int> first(static_cast<std::size_t>(n_rows_), -1);
  const auto find_first = [&](const auto& contributions) {
    for (int i = static_cast<int>(contributions.size()) - 1; i >= 0; --i)
      for (int row : contributions[i].row) first[row] = i;
  };
  std::visit(find_first, contributions_);
  std::stable_sort(loads.begin(), loads.end(), [&](int a, int b) { return first[a] < first[b]; });
  for (std::size_t begin = 0; begin < loads.size(); begin += kGroup)
    groups_.emplace_back(loads.begin() + static_cast<std::ptrdiff_t>(begin),
                         loads.begin() + static_cast<std::ptrdiff_t>(std::min(begin + kGroup, loads.size())));
}

template <class T>
Dense<T> NestedResponse::plain(const std::vector<int>& loads) const {
  Dense<T> all = Dense<T>::Zero(n_rows_, static_cast<Index>(loads.size()));
  std::vector<int> column(static_cast<std::size_t>(n_rows_), -1);
  for (std::size_t j = 0; j < loads.size(); ++j) column[loads[j]] = static_cast<int>(j);
  for (const Contribution<T>& c : std::get<Contributions<T>>(contributions_)) add_responses(c, column, all);
  return all;
}

MatrixXf NestedResponse::balanced(const std::vector<int>& loads) const {
  const MatrixXd all = plain<double>(loads), P_R_load = P_R_(loads, Eigen::all);
  const Index n = P_R_.rows();
  return (all.topRows(n) - P_R_ * all.bottomRows(n_rows_ - n) - drift_ * P_R_load.transpose()).cast<float>();
}

MatrixXf NestedResponse::next() {
  const std::vector<int>& loads = groups_.at(next_++);
  MatrixXf Y = P_R_.size() > 0 ? balanced(loads)
               : std::holds_alternative<Contributions<float>>(contributions_)
                   ? plain<float>(loads)
                   : MatrixXf(plain<double>(loads).cast<float>());
  std::vector<char> done(static_cast<std::size_t>(n_rows_), 0);
  for (int load : loads) done[load] = 1;
  std::visit(
      [&](auto& contributions) {
        for (auto& c : contributions) remove_rows(done, c);
      },
      contributions_);
  const double share = static_cast<double>(next_) / static_cast<double>(groups_.size());
  if (progress_) progress_(eliminated_ + (1 - eliminated_) * share);
  return Y;
}

}  // namespace elastogear::reduction
