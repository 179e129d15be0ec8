// SPDX-License-Identifier: Apache-2.0
// A hash of values that is equal on all machines, to find out whether two runs have the same
// inputs.
#pragma once

#include <fmt/format.h>

#include <string>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/core/hash.h"

namespace lf {

// Hashes a sequence of values. Numbers are hashed as doubles without rounding, so that any
// difference between two numbers changes the hash, except that -0 equals +0.
class ValueHasher {
 public:
  void Add(double value) {
    const double plain = value == 0 ? 0 : value;  // -0 and +0 count as equal
    hasher_.Add({reinterpret_cast<const char*>(&plain), sizeof(plain)});
  }
  void Add(const std::string& text) {
    Add(static_cast<double>(text.size()));
    hasher_.Add(text);
  }
  template <class Matrix>
  void AddMatrix(const Matrix& matrix) {
    for (Eigen::Index row = 0; row < matrix.rows(); ++row)
      for (Eigen::Index column = 0; column < matrix.cols(); ++column) Add(matrix(row, column));
  }
  void Add(const RigidTransform& transform) {
    AddMatrix(transform.rotation);
    AddMatrix(transform.translation);
  }
  void Add(const Intrinsics& k) {
    for (const double value : {k.fx_px, k.fy_px, k.cx_px, k.cy_px, k.skew_px}) Add(value);
    Add(k.width_px);
    Add(k.height_px);
    Add(static_cast<double>(k.distortion.model));
    for (size_t i = 0; i < StoredParameterCount(k.distortion.model); ++i)
      Add(k.distortion.parameters[i]);
    if (!k.vignetting.is_none())
      for (const double v : k.vignetting.v) Add(v);
  }
  std::string Text() const { return fmt::format("{:016x}", hasher_.Hash()); }

 private:
  Hasher hasher_;
};

}  // namespace lf
