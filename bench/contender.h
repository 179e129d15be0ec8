// SPDX-License-Identifier: Apache-2.0
// The measured contenders: our kernels and their peers. A contender adds LF images to its own
// plate.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bench/kernel_case.h"

namespace lf::bench {

// The means and counts of a plate, for comparing contenders.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<float> sums;    // [height][width][3]
  std::vector<float> counts;  // [height][width][3]
};

class Contender {
 public:
  virtual ~Contender() = default;

  // Adds the first `image_count` LF images of the case. This is timed.
  virtual void Collect(int image_count) = 0;

  virtual Picture Develop() const = 0;
};

// Our fast kernels, on a plate that is divided as in the renderer. It also counts the rays.
class OurKernel : public Contender {
 public:
  // Returns the number of rays that the last Collect() accepted: LF pixels with nearest, elements
  // with bilinear.
  virtual uint64_t accepted_count() const = 0;
};

// Make the contenders, which keep a reference to the case.
//   is_weighed  every 8 x 8 elements weigh the rays of each LF image differently
std::unique_ptr<OurKernel> MakeOurKernel(const KernelCase& kernel_case, bool is_weighed = false);

// Makes the contender that evaluates the ray model for every pixel (or element), in double
// precision.
std::unique_ptr<Contender> MakeReference(const KernelCase& kernel_case);

// Make the loop that the thesis describes (4.3.1), with Eigen. The second function makes the loop
// that is compiled for the instruction set of the building machine.
std::unique_ptr<Contender> MakeThesisLoop(const KernelCase& kernel_case);
std::unique_ptr<Contender> MakeThesisLoopNative(const KernelCase& kernel_case);

// Makes the contender that demosaics, and calls warpPerspective and accumulate of OpenCV.
//   is_cubic  true: warpPerspective interpolates between sixteen pixels instead of four
std::unique_ptr<Contender> MakeOpenCv(const KernelCase& kernel_case, bool is_cubic = false);

}  // namespace lf::bench
