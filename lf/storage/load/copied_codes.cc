// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/copied_codes.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {

Result<std::unique_ptr<CopiedCodes>> CopiedCodes::Open(const LightField& light_field) {
  std::unique_ptr<CopiedCodes> copied(new CopiedCodes(light_field));
  LF_ASSIGN_OR_RETURN(copied->codec_, ReadCodecSettings(light_field.folder));
  LF_ASSIGN_OR_RETURN(copied->codes_, FindCodes(light_field.folder, light_field));
  LF_ASSIGN_OR_RETURN(copied->reader_, PackedCodeReader::Open(light_field.folder));
  if (std::any_of(copied->codes_.begin(), copied->codes_.end(),
                  [](const PackedCode& code) { return code.values == StoredValues::kDisplay16; })) {
    LF_ASSIGN_OR_RETURN(copied->display_levels_, ReadDisplayLevels(light_field.folder));
  }
  LF_RETURN_IF_ERROR(copied->OpenReferences());
  return copied;
}

Result<void> CopiedCodes::OpenReferences() {
  LF_ASSIGN_OR_RETURN(decoded_,
                      ReferenceCache::Open(light_field_.folder, light_field_.encoding.bayer));
  if (!decoded_) return {};
  references_ = decoded_->references();
  for (uint32_t id = 0; id < codes_.size(); ++id) {
    if (!codes_[id].is_listed()) continue;
    if (codes_[id].id >= ids_.size()) ids_.resize(size_t{codes_[id].id} + 1, kNoWholeId);
    ids_[codes_[id].id] = id;
  }
  return {};
}

std::vector<LfImageId> CopiedCodes::ReferencesOf(LfImageId id) const {
  std::vector<LfImageId> found;
  for (const uint32_t reference : references_.Of(codes_[id.value].id)) {
    if (reference >= ids_.size() || ids_[reference] == kNoWholeId) return {};
    found.push_back({ids_[reference]});
  }
  return found;
}

std::vector<LfImageId> CopiedCodes::NeededBy(LfImageId id) const {
  // The depth of the search is limited, because an LF image needs at most kMostNeededImages.
  std::vector<LfImageId> needed;
  const auto visit = [&](const auto& self, LfImageId image) -> void {
    for (const LfImageId reference : ReferencesOf(image))
      if (std::find(needed.begin(), needed.end(), reference) == needed.end()) self(self, reference);
    needed.push_back(image);
  };
  visit(visit, id);
  return needed;
}

// Replaces the encoded image by one without reference images, of the same decoded pixels.
Result<void> CopiedCodes::EncodeAlone(LfImageId id, CodedImage* image) const {
  LF_ASSIGN_OR_RETURN(const CodeInfo info, ReadCodeInfo(image->code));
  DecodedPart part;
  LF_RETURN_IF_ERROR(
      decoded_->Decode(codes_[id.value].id, image->code, {0, 0, info.width, info.height}, &part));
  CodecSettings settings;
  settings.profile = CodecProfile::kLossless;
  settings.levels = info.levels;
  settings.entropy = info.entropy;
  image->code = EncodeImage(part.pixels, info.layout, settings);
  return {};
}

Result<CodedImage> CopiedCodes::Of(LfImageId id) const {
  const PackedCode& code = codes_[id.value];
  const std::string name = light_field_.ImagePath(id).string();
  if (code.bytes == 0)
    return InputError(
        fmt::format("{}: is not in the packed store, because it was {} when the store was made",
                    name, code.is_left_out ? "left out" : "missing or broken"));
  std::unique_lock lock(mutex_);
  const Result<PackedCodeReader::Bytes> bytes = reader_->Read(code);
  if (!bytes) return Error{bytes.error().kind, fmt::format("{}: {}", name, bytes.error().message)};
  CodedImage image = {code.values, code.rect, std::string(bytes->code), std::string(bytes->mask),
                      code.bytes};
  lock.unlock();
  image.references = ReferencesOf(id);
  if (image.references.empty() && references_.IsPredicted(code.id))
    if (const Result<void> alone = EncodeAlone(id, &image); !alone)
      return Error{alone.error().kind, fmt::format("{}: {}", name, alone.error().message)};
  if (image.mask.empty() && image.references.empty() && image.values != StoredValues::kFile) {
    LF_ASSIGN_OR_RETURN(image.front_ends, FrontEndsOf(image.code));
  }
  return image;
}

void CopiedCodes::Describe(PackedStorePlan* plan) const {
  plan->codec = codec_;
  plan->display_levels = display_levels_;
  plan->is_predicted = ArePredicted();
}

}  // namespace lf
