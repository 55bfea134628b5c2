#pragma once
// The state of a computation as one row of numbers: one function walks over the state in a fixed order and
// serves both ways.

#include <Eigen/Core>
#include <type_traits>
#include <vector>

#include "elastogear/base/error.h"

namespace elastogear {

/// Records what it is shown, or is_loading it back into it, to the bit. Whole numbers up to 2^53 are kept
/// exactly.
class Archive {
 public:
  Archive() = default;  ///< records
  explicit Archive(std::vector<double> numbers) : numbers_(std::move(numbers)), is_loading_(true) {}

  bool is_loading() const { return is_loading_; }
  const std::vector<double>& numbers() const { return numbers_; }
  /// Error unless all has been played.
  void finish() const { require(!is_loading_ || next_ == numbers_.size(), kMisfit); }

  template <class T>
  requires std::is_arithmetic_v<T>
  void operator()(T& x) {
    if (!is_loading_) return numbers_.push_back(static_cast<double>(x));
    require(next_ < numbers_.size(), kMisfit);
    x = static_cast<T>(numbers_[next_++]);
  }
  /// Vectors and matrices with their sizes; those of fixed size must fit.
  template <class Derived>
  void operator()(Eigen::PlainObjectBase<Derived>& M) {
    Eigen::Index rows = M.rows(), cols = M.cols();
    (*this)(rows);
    (*this)(cols);
    require(may_hold(rows * cols), kMisfit);
    require(Derived::RowsAtCompileTime < 0 || rows == M.rows(), kMisfit);
    require(Derived::ColsAtCompileTime < 0 || cols == M.cols(), kMisfit);
    M.resize(rows, cols);
    for (Eigen::Index i = 0; i < M.size(); ++i) (*this)(M.data()[i]);
  }
  template <class T>
  void operator()(std::vector<T>& list) {
    each(list, [&](T& entry) { (*this)(entry); });
  }
  /// A list with its length, its entries by a function.
  template <class T, class Visit>
  void each(std::vector<T>& list, const Visit& visit) {
    auto size = static_cast<Eigen::Index>(list.size());
    (*this)(size);
    require(may_hold(size), kMisfit);
    list.resize(static_cast<std::size_t>(size));
    for (T& entry : list) visit(entry);
  }

 private:
  static constexpr const char* kMisfit = "the stored state does not fit this run";
  bool may_hold(Eigen::Index n) const {
    return !is_loading_ || (n >= 0 && n <= static_cast<Eigen::Index>(numbers_.size() - next_));
  }

  std::vector<double> numbers_;
  std::size_t next_ = 0;
  bool is_loading_ = false;
};

}  // namespace elastogear
