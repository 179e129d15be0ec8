// How much a ray counts (doc/ray.md, "What is added").
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

namespace lf {

// Weights are integers, the part of the lens that the ray's LF camera stands for: sum += weight v,
// count += weight. A ray of weight 0 adds nothing.
inline constexpr uint32_t kMaxWeight = 255;

// Elements [8 i, 8 i + 8) x [8 j, 8 j + 8) of the plate have one weight.
inline constexpr int kWeightBlock = 8;

// What the rays of one LF image count in one frame.
class RayWeights {
 public:
  // The same all over the plate, at most kMaxWeight.
  RayWeights(uint32_t weight = 1) : same_(weight) {}  // NOLINT: a number is such weights
  // By element (x, y), at most kMaxWeight; asked for one element of each block.
  explicit RayWeights(std::function<uint32_t(int x, int y)> of_element)
      : of_element_(std::move(of_element)) {}

  bool are_same() const { return of_element_ == nullptr; }
  uint32_t same() const { return same_; }
  uint32_t At(int x, int y) const {
    return are_same()
               ? same_
               : of_element_(x / kWeightBlock * kWeightBlock, y / kWeightBlock * kWeightBlock);
  }

 private:
  uint32_t same_ = 1;
  std::function<uint32_t(int x, int y)> of_element_;
};

}  // namespace lf
