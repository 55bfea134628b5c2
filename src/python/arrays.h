#pragma once
// Numbers of the library as arrays of numpy: views that keep their owner alive, and checked arguments.

#include <pybind11/numpy.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "elastogear/base/error.h"

namespace elastogear::python {

namespace py = pybind11;

using Shape = std::vector<py::ssize_t>;

/// A view of numbers that lie one behind the other, the last index running fastest. It cannot be written to.
/// owner: keeps the numbers.
template <class T>
py::array view(const T* data, const Shape& shape, const py::handle& owner) {
  py::array_t<T> array(shape, data, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// A view that alone owns these numbers.
template <class Owned>
py::array owning_view(Owned&& numbers, const Shape& shape) {
  auto* kept = new std::remove_cvref_t<Owned>(std::forward<Owned>(numbers));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::remove_cvref_t<Owned>*>(p); });
  return view(kept->data(), shape, owner);
}

/// A matrix of histories, one column per time, with the time as the first index: rows x n_t becomes
/// (n_t, rows), or (n_t, rows / parts..., parts...).
inline py::array history(Eigen::MatrixXd&& matrix, const Shape& parts = {}) {
  Shape shape{matrix.cols()};
  py::ssize_t rest = matrix.rows();
  for (py::ssize_t part : parts) rest /= part;
  if (parts.empty() || rest != 1) shape.push_back(rest);
  shape.insert(shape.end(), parts.begin(), parts.end());
  return owning_view(std::move(matrix), shape);
}

inline py::array vector(Eigen::VectorXd&& numbers) {
  const Shape shape{numbers.size()};
  return owning_view(std::move(numbers), shape);
}

/// An argument as an array of doubles, whatever it was. Throws Error, beginning with `what`, for other kinds
/// of objects, another number of dimensions and values that are not finite.
inline py::array_t<double> numbers_of(const py::object& argument, int dimensions, const std::string& what) {
  using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
  Array array;
  try {
    array = Array(argument);
  } catch (const py::error_already_set&) {
    fail(what, ": must be an array of numbers, not ", std::string(py::str(py::type::of(argument))));
  }
  require(array.ndim() == dimensions, what, ": must have ", dimensions, " dimension(s), not ", array.ndim());
  for (py::ssize_t i = 0; i < array.size(); ++i)
    require(std::isfinite(array.data()[i]), what, ": the number at ", i, " is ", array.data()[i],
            ", must be finite");
  return array;
}

}  // namespace elastogear::python
