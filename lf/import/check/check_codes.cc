// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/check_codes.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <utility>

#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/pixels/files/image_file.h"

namespace lf {
namespace {

Error Named(const Error& error, const std::string& name) {
  return {error.kind, fmt::format("{}: {}", name, error.message)};
}

Result<void> DecodeAll(std::string_view code, const std::string& name) {
  DecodedPart part;
  if (const Result<void> decoded = DecodeImage(code, &part); !decoded)
    return Named(decoded.error(), name);
  return {};
}

Result<void> DecodeFile(std::string_view bytes, const std::string& name) {
  LF_RETURN_IF_ERROR(ReadImageBytes(bytes, name));
  return {};
}

}  // namespace

CodeChecker::CodeChecker(const LightField& light_field, std::vector<PackedCode> codes,
                         int missing_parts)
    : light_field_(light_field), codes_(std::move(codes)), missing_parts_(missing_parts) {}

Result<std::unique_ptr<CodeChecker>> CodeChecker::Open(const LightField& light_field) {
  LF_ASSIGN_OR_RETURN(std::vector<PackedCode> codes, FindCodes(light_field.folder, light_field));
  LF_ASSIGN_OR_RETURN(const PackedStoreFacts facts, ReadPackedStore(light_field.folder));
  const auto missing_parts = static_cast<int>(facts.part_count - facts.found_parts);
  std::unique_ptr<CodeChecker> checker(
      new CodeChecker(light_field, std::move(codes), missing_parts));
  LF_ASSIGN_OR_RETURN(checker->references_,
                      ReferenceCache::Open(light_field.folder, light_field.encoding.bayer));
  return checker;
}

CodeChecker::Fault CodeChecker::Check(LfImageId id, bool decode) const {
  const PackedCode& code = codes_[id.value];
  const std::string name = light_field_.ImagePath(id).string();
  if (code.is_left_out) return {.is_left_out = true};
  if (code.bytes == 0)
    return {true, fmt::format("{}: is not in the packed store, because it was missing or broken "
                              "when the store was made",
                              name)};
  if (code.missing_parts > missing_parts_)
    return {true, fmt::format("{}: is not completely in the files beside the packed store, which "
                              "were not copied to their end: copy them again",
                              name)};
  const Intrinsics& k = light_field_.intrinsics[light_field_.cameras[id.value].intrinsics_index];
  if (Intersection(code.rect, {0, 0, k.width_px, k.height_px}) != code.rect)
    return {false,
            fmt::format("{}: has pixels in the packed store that lie beyond the {} x {} pixels of "
                        "the calibration",
                        name, k.width_px, k.height_px)};
  if (!decode) return {};
  const Result<void> decoded = Decode(id, name);
  return {false, decoded ? "" : decoded.error().message};
}

Result<void> CodeChecker::DecodeColours(const PackedCode& code, std::string_view bytes,
                                        const std::string& name) const {
  if (code.values == StoredValues::kFile) return DecodeFile(bytes, name);
  if (!references_ || !references_->Concerns(code.id)) return DecodeAll(bytes, name);
  DecodedPart part;
  const PixelRect whole = {0, 0, code.rect.width(), code.rect.height()};
  if (const Result<void> decoded = references_->Decode(code.id, bytes, whole, &part); !decoded)
    return Named(decoded.error(), name);
  return {};
}

Result<void> CodeChecker::Decode(LfImageId id, const std::string& name) const {
  std::optional<PackedCodeReader> reader;
  {
    const std::lock_guard lock(mutex_);
    if (!readers_.empty()) {
      reader = std::move(readers_.back());
      readers_.pop_back();
    }
  }
  if (!reader) {
    LF_ASSIGN_OR_RETURN(reader, PackedCodeReader::Open(light_field_.folder));
  }
  Result<void> result;
  const PackedCode& code = codes_[id.value];
  if (code.missing_parts > 0) {
    // The bytes that are there are only compared with their checksums.
    const auto front = reader->ReadFront(code, code.missing_parts);
    if (!front) result = Named(front.error(), name);
  } else if (const auto bytes = reader->Read(code); !bytes) {
    result = Named(bytes.error(), name);
  } else {
    result = DecodeColours(code, bytes->code, name);
    if (result && !bytes->mask.empty()) result = DecodeAll(bytes->mask, name);
  }
  const std::lock_guard lock(mutex_);
  readers_.push_back(*std::move(reader));
  return result;
}

}  // namespace lf
