// SPDX-License-Identifier: Apache-2.0
// Encodes the LF images of a group relative to each other (thesis 6.2). Internal to this folder.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/distribute/compress/code_quality.h"
#include "lf/distribute/compress/compress_source.h"
#include "lf/distribute/compress/image_coder.h"
#include "lf/distribute/compress/image_use.h"
#include "lf/selection/reference_groups.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {

// An LF image as the store keeps it.
struct CodedMember {
  LfImageId id;
  CodedImage image;
  CodeError lost;
  uint64_t pixel_bytes = 0;  // size of the pixels, in the number type of the file
  bool is_rounded = false;   // RecordedImage::is_rounded
};

struct CodedGroup {
  struct Unreadable {
    LfImageId id;
    Error error;
  };
  std::vector<CodedMember> members;  // reference images stand before those that need them
  std::vector<Unreadable> unreadable;
  uint64_t bytes = 0;  // size of the encoded images of `members`
  // About the size of each of `members`, if it were encoded by itself with the error of the group.
  std::vector<uint64_t> bytes_alone;
};

// Thresholds of a group, as factors of the threshold of the settings. Errors of anchors pass into
// the images that are predicted from them, so that finer ones pay.
struct GroupSteps {
  double key = 0.5;
  double anchors = 0.7;
  double others = 1.2;
  // The noise of few anchors, passed on to all, would not average out in frames.
  static GroupSteps ForNoise() { return {1, 1, 1}; }
  double Of(size_t rank, size_t group_size) const {
    return rank == 0 ? key : rank < AnchorCount(group_size) ? anchors : others;
  }
};

// Returns an estimate of the noise of an image, as the standard deviation of its brightness
// (pixels/prediction/brightness.h): how much the smoothest of its blocks differ from a plane. It is
// up to a quarter too low.
double NoiseOf(const Image<uint8_t>& brightness);

// A predicted image that has more than this share of the bytes of the image encoded by itself is
// not worth its longer decoding.
inline constexpr double kMostPredicted = 0.9;

class GroupCoder {
 public:
  // The arguments must outlive the object.
  //   is_interrupted  called by all threads that call the GroupCoder
  GroupCoder(const CompressSource& source, const ImageCoder& coder, const ThresholdFactors& factors,
             std::function<bool()> is_interrupted);

  // Encodes all LF images of a group. An LF image is predicted if that saves a tenth of its bytes.
  // All are encoded by themselves, with the threshold of the settings, if the group saves nothing
  // against them at equal error of LF images: it saves about a tenth at equal error of frames,
  // because the errors of predicted images average out better (doc/codec.md). Each LF image is read
  // once; the decoded anchors, one LF image as it was recorded and all encoded images are in memory
  // together. The result depends on the LF images of the group and the settings alone.
  // kInterrupted, or the first error that is no fault of an LF image.
  //   encoded   called when one more LF image is done; may be empty
  //   left_out  bits of ranks in the group that are treated as LF images that cannot be read
  Result<CodedGroup> Encode(std::span<const GroupMember> group,
                            const std::function<void()>& encoded = {}, uint32_t left_out = 0) const;

 private:
  struct Work;
  struct Candidate {
    CodedImage image;
    DecodedPart decoded;  // its pixels
  };
  Result<std::optional<Candidate>> Predicted(const RecordedImage& image, const GroupMember& member,
                                             double factor, Work* work) const;
  Result<Candidate> Single(const RecordedImage& image, double factor) const;
  GroupSteps StepsFor(const RecordedImage& image) const;
  Result<std::optional<Candidate>> BestOf(const RecordedImage& image, const GroupMember& member,
                                          double of_use, size_t alone_bytes, Work* work) const;
  Result<void> Add(const GroupMember& member, Work* work) const;

  const CompressSource& source_;
  const ImageCoder& coder_;
  const ThresholdFactors& factors_;
  const std::function<bool()> is_interrupted_;
};

}  // namespace lf
