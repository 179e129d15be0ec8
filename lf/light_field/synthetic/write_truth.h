// SPDX-License-Identifier: Apache-2.0
// Writes the frames that a lens would record of the scene itself: the ground truth with which
// renders of its light field are compared.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "lf/camera/render_camera.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/synthetic/photograph.h"
#include "lf/light_field/synthetic/scene.h"

namespace lf {

// Returns the file of a frame: folder/frame_0001.exr for number 1.
std::filesystem::path TruthPath(const std::filesystem::path& folder, size_t number);

// Writes the frames TruthPath(folder, first_frame), ..., one for each camera: R, G, B as floats,
// linear light, and Z, the depths that are seen through the lens centre (DepthsSeen()). If
// `instants` is above 1, a frame is the mean of this many consecutive cameras
// (CameraPath::instants), and Z is that of the middle one. If surroundings are transparent, R, G
// and B are multiplied by alpha, and A is written, too.
//   instants    number of `cameras` is a multiple of it
//   keep_going  called after every frame; returns false to stop the work. May be empty
// kOutput: a folder or file cannot be written. kInterrupted: the work was stopped; written frames
// are complete.
Result<void> WriteTruth(const Scene& scene, std::span<const RenderCamera> cameras,
                        const LensSampling& sampling, const std::filesystem::path& folder,
                        ThreadPool& pool, Surroundings surroundings = Surroundings::kShown,
                        const std::function<bool(size_t frames_done)>& keep_going = {},
                        size_t instants = 1, uint32_t first_frame = 1);

}  // namespace lf
