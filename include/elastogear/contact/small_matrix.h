#pragma once
// Matrices of any size whose entries lie in the object itself where they are few, so that hundreds of them
// need no memory of their own.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <utility>

namespace elastogear::contact {

/// Takes the place of Eigen::Matrix<Scalar, kRows, kCols>, one of them Eigen::Dynamic: an Eigen::Map of
/// memory of its own, which is in the object up to kRoom entries. Assignments change its size. Entries are
/// not set by resize().
template <class Scalar, int kRows, int kCols, int kRoom>
class SmallMatrix : public Eigen::Map<Eigen::Matrix<Scalar, kRows, kCols>> {
  using Plain = Eigen::Matrix<Scalar, kRows, kCols>;
  using Base = Eigen::Map<Plain>;

 public:
  using Index = Eigen::Index;

  SmallMatrix() : Base(nullptr, kRows == Eigen::Dynamic ? 0 : kRows, kCols == Eigen::Dynamic ? 0 : kCols) {}
  SmallMatrix(Index rows, Index cols) : SmallMatrix() { resize(rows, cols); }
  template <class Derived>
  SmallMatrix(const Eigen::DenseBase<Derived>& other) : SmallMatrix() {  // NOLINT: as Eigen's matrices
    *this = other;
  }
  SmallMatrix(const SmallMatrix& other) : SmallMatrix() { *this = other; }
  SmallMatrix(SmallMatrix&& other) noexcept : SmallMatrix() { *this = std::move(other); }
  ~SmallMatrix() = default;

  SmallMatrix& operator=(const SmallMatrix& other) {
    if (this == &other) return *this;
    resize(other.rows(), other.cols());
    std::copy_n(other.data(), other.size(), this->data());
    return *this;
  }
  SmallMatrix& operator=(SmallMatrix&& other) noexcept {
    if (!other.outside_) return *this = std::as_const(other);  // no memory is taken for so few
    outside_ = std::move(other.outside_);
    room_outside_ = std::exchange(other.room_outside_, 0);
    set(outside_.get(), other.rows(), other.cols());
    other.resize(kRows == Eigen::Dynamic ? 0 : kRows, kCols == Eigen::Dynamic ? 0 : kCols);
    return *this;
  }
  template <class Derived>
  SmallMatrix& operator=(const Eigen::DenseBase<Derived>& other) {
    if (other.rows() == this->rows() && other.cols() == this->cols()) {
      Base::operator=(other.derived());
    } else {
      SmallMatrix value(other.rows(), other.cols());  // may depend on the entries of this one
      value = other;
      *this = std::move(value);
    }
    return *this;
  }

  void resize(Index rows, Index cols) {
    const Index n = rows * cols;
    if (n > kRoom && n > room_outside_) {
      outside_ = std::make_unique<Scalar[]>(static_cast<std::size_t>(n));
      room_outside_ = n;
    }
    set(outside_ ? outside_.get() : room_.data(), rows, cols);
  }
  void resize(Index size) { kRows == Eigen::Dynamic ? resize(size, kCols) : resize(kRows, size); }
  using Base::setZero;
  void setZero(Index rows, Index cols) {  // NOLINT(readability-identifier-naming): as Eigen's matrices
    resize(rows, cols);
    Base::setZero();
  }

 private:
  void set(Scalar* data, Index rows, Index cols) { ::new (static_cast<Base*>(this)) Base(data, rows, cols); }

  std::array<Scalar, kRoom> room_;
  std::unique_ptr<Scalar[]> outside_;  // once there were more entries; null before
  Index room_outside_ = 0;
};

}  // namespace elastogear::contact
