// SPDX-License-Identifier: Apache-2.0
// The recorded LF images of a light field, encoded as a densified store keeps them. Internal to
// this folder.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/densify/recorded_values.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/radiance.h"
#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/storage/load/copied_codes.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {

// Returns the kind of the stored values that an encoded image stands for; never kDisplay16 or
// kFile. kInput: the encoded image is damaged.
Result<StoredKind> KindOfCode(const CodedImage& image, const RadianceEncoding& encoding);

class RecordedCodes {
 public:
  // The light field must outlive the result. kInput: its packed store is damaged.
  static Result<std::unique_ptr<RecordedCodes>> Open(const LightField& light_field);

  // Returns an LF image that can be read. An image file is encoded without loss, or kept if that is
  // smaller; the encoded image of a packed store is copied, which loses nothing more. May be called
  // by many threads at the same time. kInput: the LF image cannot be read. kInterrupted:
  // is_interrupted() returned true; it may be empty.
  Result<CodedImage> Of(LfImageId id, const std::function<bool()>& is_interrupted = {}) const;

  // Returns true if LF images that are copied are predicted from others, which must be added first.
  bool ArePredicted() const { return copied_ && copied_->ArePredicted(); }
  // Returns all LF images to add for this one, each after its reference images. The last one is
  // `id` itself.
  std::vector<LfImageId> NeededBy(LfImageId id) const {
    return ArePredicted() ? copied_->NeededBy(id) : std::vector<LfImageId>{id};
  }

  // Sets PackedStorePlan::codec, display_levels and is_predicted.
  void Describe(PackedStorePlan* plan) const;

  // Returns the kind of the stored values of an LF image before it is encoded. kInput: the LF image
  // cannot be read.
  Result<StoredKind> KindOf(LfImageId id) const;

 private:
  explicit RecordedCodes(const LightField& light_field) : light_field_(light_field) {}

  const LightField& light_field_;
  std::unique_ptr<CopiedCodes> copied_;  // null if the light field has image files
};

}  // namespace lf
