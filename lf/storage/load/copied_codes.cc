// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/copied_codes.h"

#include <fmt/format.h>

#include <algorithm>

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
  return copied;
}

Result<CodedImage> CopiedCodes::Of(LfImageId id) const {
  const PackedCode& code = codes_[id.value];
  const std::string name = light_field_.ImagePath(id).string();
  if (code.bytes == 0)
    return InputError(
        fmt::format("{}: is not in the packed store, because it was {} when the store was made",
                    name, code.is_left_out ? "left out" : "missing or broken"));
  const std::lock_guard lock(mutex_);
  const Result<PackedCodeReader::Bytes> bytes = reader_->Read(code);
  if (!bytes) return Error{bytes.error().kind, fmt::format("{}: {}", name, bytes.error().message)};
  CodedImage image = {code.values, code.rect, std::string(bytes->code), std::string(bytes->mask),
                      code.bytes};
  if (image.mask.empty() && image.values != StoredValues::kFile) {
    LF_ASSIGN_OR_RETURN(image.front_ends, FrontEndsOf(image.code));
  }
  return image;
}

void CopiedCodes::Describe(PackedStorePlan* plan) const {
  plan->codec = codec_;
  plan->display_levels = display_levels_;
}

}  // namespace lf
