// SPDX-License-Identifier: Apache-2.0
// The reference images of the predicted LF images of a packed store: which LF images must be
// decoded before another one (pixels/codec/predicted_image.h; doc/formats/packed_store.md,
// "Predicted LF images").
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "lf/core/result.h"

namespace lf {

// Most reference images of one LF image: kMostReferences of pixels/prediction/predict.h.
inline constexpr size_t kMostReferenceIds = 4;
// Most other LF images that one LF image needs, as reference images of its own or of those. It
// limits the time and memory for one LF image, whatever a store says.
inline constexpr size_t kMostNeededImages = 32;

// Ids count the LF images of the store. No LF image needs itself.
class ReferenceTable {
 public:
  // A table without predicted LF images.
  ReferenceTable() = default;

  // Returns true if no LF image is predicted.
  bool empty() const { return predicted_count_ == 0; }
  size_t predicted_count() const { return predicted_count_; }
  bool IsPredicted(uint32_t id) const { return !Of(id).empty(); }
  // Returns true if the LF image is a reference image of another one.
  bool IsReference(uint32_t id) const { return id < is_reference_.size() && is_reference_[id]; }
  // Returns the reference images of an LF image, in their order in its encoded image; none if it is
  // not predicted.
  std::span<const uint32_t> Of(uint32_t id) const {
    if (size_t{id} + 1 >= begins_.size()) return {};
    return std::span(ids_).subspan(begins_[id], begins_[id + 1] - begins_[id]);
  }
  // Returns all LF images that must be decoded for this one, each after its own reference images.
  // The last one is `id` itself.
  std::vector<uint32_t> NeededBy(uint32_t id) const;

 private:
  friend class ReferenceTableBuilder;
  std::vector<uint32_t> begins_;  // [id]: index in ids_ of its first reference image
  std::vector<uint32_t> ids_;
  std::vector<bool> is_reference_;  // [id]
  size_t predicted_count_ = 0;
};

// Reads the reference images of all LF images of a store. kInput as ReadPackedStore(), and if an LF
// image cannot be decoded: an LF image has more than kMostReferenceIds reference images, or needs
// more than kMostNeededImages others, or itself, or one that has no encoded image or is kept as a
// file.
Result<ReferenceTable> ReadReferences(const std::filesystem::path& path);

}  // namespace lf
