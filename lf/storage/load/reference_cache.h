// SPDX-License-Identifier: Apache-2.0
// Decodes the predicted LF images of a packed store (pixels/codec/predicted_image.h), and keeps
// decoded reference images for later calls.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/light_field/model/radiance.h"
#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/reference_table.h"

namespace lf {

// The pixels of an LF image follow from the bytes of the store alone. They depend neither on the
// memory nor on the order of calls or their threads. LF images are counted by their ids in the
// store, and pixels are those of encoded images: (0, 0) is the corner of PackedCode::rect.
//
// One call decodes each LF image that it needs at most once, and only the tiles that it needs. It
// holds the decoded pixels of at most kMostNeededImages LF images
// (storage/packed/reference_table.h) besides those that are kept. Threads that need the same
// reference image at the same time decode it once. All functions but Limit() may be called by many
// threads at the same time.
class ReferenceCache {
 public:
  static constexpr uint64_t kMostBytes = uint64_t{256} << 20;  // kept unless Limit() is called

  // Opens a store. Takes 40 to 60 bytes of memory for each of its LF images. Returns null if no LF
  // image is predicted. kInput as ReadReferences().
  //   bayer  RadianceEncoding::bayer of the store
  static Result<std::unique_ptr<ReferenceCache>> Open(const std::filesystem::path& store,
                                                      BayerPattern bayer);

  // Returns true if Decode() must decode this LF image: it is predicted, or the reference image of
  // another one, whose pixels are then kept for that.
  bool Concerns(uint32_t id) const { return references_.IsPredicted(id) || IsReference(id); }
  const ReferenceTable& references() const { return references_; }

  // Returns the bytes of the decoded pixels of all reference images together.
  uint64_t AllBytes() const;
  // Returns how many times a reference image was decoded, for tests and measurements.
  uint64_t decoded_count() const;
  // Sets the greatest number of bytes of decoded pixels that are kept between calls.
  void Limit(uint64_t most_bytes);

  // Decodes at least the pixels `wanted`, which contains a pixel of the image, of an LF image that
  // has an encoded image of numbers, as DecodePredicted() does. Reuses the memory of `part`.
  //   code  encoded image of the LF image, which PackedCodeReader::Read() has returned
  // kInput: the LF image is damaged (the message does not name it), or a reference image is damaged
  // or missing (the message names that one). kOutput: the disk or the memory fails.
  Result<void> Decode(uint32_t id, std::string_view code, const PixelRect& wanted,
                      DecodedPart* part);
  // Reads and decodes all pixels of an LF image. Errors are those of Decode(), and name the store
  // if the encoded image cannot be read.
  Result<std::shared_ptr<const DecodedPart>> Whole(uint32_t id);

 private:
  using Part = std::shared_ptr<const DecodedPart>;
  // One of the LF images that a call decodes.
  struct Step {
    uint32_t id = 0;
    PixelRect wanted = {};       // empty: no pixel is needed
    std::string bytes = {};      // encoded image, if this call has read it
    std::string_view code = {};  // encoded image; empty until it is needed
    Part part = nullptr;         // set if pixels were kept, or are decoded
    size_t last_use = 0;         // index of the last step that needs `part`
  };
  using Steps = std::vector<Step>;
  // An LF image that a thread decodes. Others wait for it only while that thread waits for nobody.
  struct Pending {
    Part part = nullptr;
    bool is_done = false;
  };
  struct Kept {
    uint32_t id;
    Part part;
  };

  class SpareParts;

  ReferenceCache(std::filesystem::path store, BayerPattern bayer, ReferenceTable references,
                 std::vector<PackedCode> codes);

  bool IsReference(uint32_t id) const { return references_.IsReference(id); }
  Result<std::string> Read(uint32_t id) const;
  Result<void> PlanStep(size_t index, Steps* steps);
  Result<Steps> Plan(uint32_t id, std::string_view code, const PixelRect& wanted);
  Result<void> DecodeStep(const Step& step, const Steps& steps, DecodedPart* part) const;
  Result<Part> Obtain(const Step& step, const Steps& steps);
  Result<void> Run(Steps* steps, DecodedPart* part);
  Error OfReference(uint32_t id, const Error& error) const;

  // The following functions require the mutex.
  Part Find(uint32_t id, const PixelRect& wanted);
  void Keep(uint32_t id, const Part& part);
  void DropBeyond(uint64_t most_bytes);

  const std::filesystem::path store_;
  const BayerPattern bayer_;
  const ReferenceTable references_;
  const std::vector<PackedCode> codes_;
  const std::shared_ptr<SpareParts> spares_;

  mutable std::mutex mutex_;            // guards all members below
  std::condition_variable is_decoded_;  // notified when a Pending is done
  std::unordered_map<uint32_t, std::shared_ptr<Pending>> pending_;
  std::list<Kept> kept_;  // the most recently used first
  std::unordered_map<uint32_t, std::list<Kept>::iterator> kept_of_;
  // Pixels that some call uses now, or that are kept. Others may use them also if they are not
  // kept.
  std::unordered_map<uint32_t, std::weak_ptr<const DecodedPart>> used_;
  uint64_t kept_bytes_ = 0;
  uint64_t decoded_count_ = 0;
  uint64_t most_bytes_ = kMostBytes;
  mutable std::vector<PackedCodeReader> readers_;  // open readers that no call uses now
};

}  // namespace lf
