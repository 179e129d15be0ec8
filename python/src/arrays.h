// SPDX-License-Identifier: Apache-2.0
// Arrays of NumPy that share the memory of C++ objects.
#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <utility>
#include <vector>

#include "lf/core/image.h"

namespace lf::python {

// Returns an array of the values of an image, [height][width][channels] or, if `is_flat` is true,
// [height][width]. The array owns the values, which are not copied.
template <class T>
pybind11::array_t<T> ArrayOf(Image<T> image, bool is_flat = false) {
  auto owned = std::make_unique<Image<T>>(std::move(image));
  T* const data = owned->pixels().data();
  std::vector<pybind11::ssize_t> shape = {owned->height(), owned->width()};
  if (!is_flat) shape.push_back(owned->channels());
  const pybind11::capsule owner(owned.release(), [](void* p) { delete static_cast<Image<T>*>(p); });
  return pybind11::array_t<T>(shape, data, owner);
}

// Returns an array that shows values inside of an object, and keeps the object alive. The array
// cannot be written to.
//   strides  distances in bytes between values along each axis
template <class T>
pybind11::array_t<T> ReadOnlyView(const T* data, std::vector<pybind11::ssize_t> shape,
                                  std::vector<pybind11::ssize_t> strides, pybind11::handle owner) {
  pybind11::array_t<T> view(std::move(shape), std::move(strides), data, owner);
  pybind11::detail::array_proxy(view.ptr())->flags &=
      ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return view;
}

}  // namespace lf::python
