#pragma once

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab::python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Shape = std::vector<py::ssize_t>;

/// Arguments of one vectorised call, broadcast against each other by NumPy's rules. The last axes of an argument, its
/// item, are those of one value: none of numbers, (6,) of a motion.
class Rows {
 public:
  /// @param call for messages, "contacts" @throws InputError where a number is not finite
  explicit Rows(std::string call) : call_(std::move(call)) {}

  /// @return the argument's place, for row()
  std::size_t add(const char* name, const Doubles& array, const Shape& item = {}) {
    const auto axes = static_cast<py::ssize_t>(item.size());
    const Shape shape(array.shape(), array.shape() + array.ndim());
    if (array.ndim() < axes || !std::equal(item.begin(), item.end(), shape.end() - axes)) {
      throw input_error(call_, fmt::format("{} of another shape", name),
                        fmt::format("{} numbers along its last axis", item.empty() ? 1 : item.front()));
    }
    const double* const data = array.data();
    for (py::ssize_t i = 0; i < array.size(); ++i) {
      if (std::isfinite(data[i])) continue;
      throw input_error(call_, fmt::format("{} = {} (number {} in memory)", name, data[i], i), "finite numbers");
    }
    columns_.push_back({array, Shape(shape.begin(), shape.end() - axes), item, nullptr, 0});
    return columns_.size() - 1;
  }

  /// After the last add(): the shape that all arguments have together. @throws ValueError (NumPy's) where they have
  /// none
  void broadcast() {
    const py::module_ numpy = py::module_::import("numpy");
    py::tuple shapes(columns_.size());
    for (std::size_t i = 0; i < columns_.size(); ++i) shapes[i] = py::tuple(py::cast(columns_[i].shape));
    shape_ = py::cast<Shape>(numpy.attr("broadcast_shapes")(*shapes));
    count_ = 1;
    for (const py::ssize_t length : shape_) count_ *= length;
    for (Column& column : columns_) {
      py::ssize_t step = 1;
      for (const py::ssize_t length : column.item) step *= length;
      const bool one = column.array.size() == step;
      if (!one && column.shape != shape_) {
        column.array = Doubles(numpy.attr("broadcast_to")(column.array, py::tuple(py::cast(with(column.item)))));
      }
      column.data = column.array.data();
      column.step = one ? 0 : step;
    }
  }

  [[nodiscard]] py::ssize_t count() const noexcept { return count_; }
  [[nodiscard]] const std::string& call() const noexcept { return call_; }
  [[nodiscard]] const double* row(std::size_t argument, py::ssize_t i) const noexcept {
    return columns_[argument].data + i * columns_[argument].step;
  }
  [[nodiscard]] double value(std::size_t argument, py::ssize_t i) const noexcept { return *row(argument, i); }

  /// An array for results of that item.
  template <class T = double>
  [[nodiscard]] py::array_t<T> result(const Shape& item = {}) const {
    return py::array_t<T>(with(item));
  }

 private:
  struct Column {
    Doubles array;
    Shape shape, item;
    const double* data;
    py::ssize_t step;
  };
  [[nodiscard]] Shape with(const Shape& item) const {
    Shape all = shape_;
    all.insert(all.end(), item.begin(), item.end());
    return all;
  }

  std::string call_;
  std::vector<Column> columns_;
  Shape shape_;
  py::ssize_t count_ = 0;
};

}  // namespace railtab::python
