// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/verify_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "lf/distribute/compress/compress.h"
#include "lf/distribute/compress/image_coder.h"
#include "lf/storage/load/recorded_image.h"
#include "lf/storage/load/reference_cache.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace fs = std::filesystem;

namespace {

// Returns true if the store has these reference images of an LF image.
bool HasReferences(const ReferenceCache* cache, uint32_t id,
                   const std::vector<LfImageId>& references) {
  if (cache == nullptr) return references.empty();
  const std::span<const uint32_t> found = cache->references().Of(id);
  return std::equal(found.begin(), found.end(), references.begin(), references.end(),
                    [](uint32_t a, LfImageId b) { return a == b.value; });
}

}  // namespace

Result<void> CheckStoreFacts(const CompressSource& source, const VerifyOptions& options) {
  LF_ASSIGN_OR_RETURN(const PackedStoreFacts facts, ReadPackedStore(options.store));
  if (facts.whole != source.whole)
    return InputError(fmt::format(
        "{}: is a packed store of another light field: give the light field that it was made from",
        options.store.string()));
  if (const std::string& asked = options.plan.codec; facts.codec != asked)
    return InputError(fmt::format(
        "{}: was made with the encoding \"{}\", but the options ask for \"{}\": give the "
        "options that the store was made with",
        options.store.string(), facts.codec, asked));
  return CheckIsOfPlan(options.store, source.light_field, options.plan, options.any_shards);
}

Result<size_t> VerifyStore(const CompressSource& source, const VerifyOptions& options,
                           ThreadPool& pool, const std::function<void(size_t)>& progress) {
  LF_RETURN_IF_ERROR(CheckStoreFacts(source, options));
  const LightField& light_field = source.light_field;
  LF_ASSIGN_OR_RETURN(const std::vector<PackedCode> codes, FindCodes(options.store, light_field));

  LF_ASSIGN_OR_RETURN(const std::unique_ptr<ReferenceCache> references,
                      ReferenceCache::Open(options.store, light_field.encoding.bayer));
  const ImageCoder coder(light_field.encoding, options.settings, options.files,
                         options.is_interrupted);
  std::mutex mutex;
  std::vector<std::unique_ptr<PackedCodeReader>> readers;
  size_t done = 0, verified = 0;
  const std::vector<LfImageId> ids = source.CompressedIds();
  std::vector<std::optional<std::string>> faults(ids.size());
  const auto reader_of_thread = [&]() -> Result<std::unique_ptr<PackedCodeReader>> {
    {
      const std::lock_guard lock(mutex);
      if (!readers.empty()) {
        std::unique_ptr<PackedCodeReader> reader = std::move(readers.back());
        readers.pop_back();
        return reader;
      }
    }
    LF_ASSIGN_OR_RETURN(PackedCodeReader reader, PackedCodeReader::Open(options.store));
    return std::make_unique<PackedCodeReader>(std::move(reader));
  };
  // Encodes an LF image as it must be in the store. kInput: it cannot be read.
  const auto encode = [&](LfImageId id) -> Result<CodedImage> {
    if (options.copied) return options.copied->Of(id);
    const PixelRect rect = RectToRecord(light_field, id, source.rects[id.value]);
    LF_ASSIGN_OR_RETURN(const RecordedImage image, ReadRecordedImage(light_field, id, rect));
    return coder.CodeOrFile(light_field, id, image, options.factors.Of(id.value));
  };
  // Checks an LF image and its encoded image. The error says what is wrong with them.
  const auto check = [&](LfImageId id) -> Result<void> {
    const PackedCode& code = codes[id.value];
    const Result<CodedImage> made = encode(id);
    if (!made && made.error().kind == ErrorKind::kInterrupted) return made.error();
    if (code.bytes == 0) {
      if (made)
        return InputError(
            "the image can be read, but is not in the store; make the store again with "
            "{overwrite}");
      return {};
    }
    LF_RETURN_IF_ERROR(made);
    const CodedImage& again = *made;
    LF_ASSIGN_OR_RETURN(std::unique_ptr<PackedCodeReader> reader, reader_of_thread());
    const Result<PackedCodeReader::Bytes> bytes = reader->Read(code);
    LF_RETURN_IF_ERROR(bytes);
    if (code.values != StoredValues::kFile) {
      DecodedPart decoded;
      const PixelRect whole = {0, 0, code.rect.width(), code.rect.height()};
      LF_RETURN_IF_ERROR(references && references->Concerns(code.id)
                             ? references->Decode(code.id, bytes->code, whole, &decoded)
                             : DecodeImage(bytes->code, &decoded));
    }
    if (code.rect != again.rect || code.values != again.values || bytes->code != again.code ||
        bytes->mask != again.mask || !HasReferences(references.get(), code.id, again.references))
      return InputError(
          "the encoded image in the store differs from its source; make the store again with "
          "{overwrite}");
    for (size_t left_out = 1; left_out <= again.front_ends.size(); ++left_out) {
      const auto front = reader->ReadFront(code, left_out);
      LF_RETURN_IF_ERROR(front);
      // Stores of earlier builds have none.
      if (!*front) break;
      if (!std::string_view(again.code).starts_with((*front)->code))
        return InputError(
            "the front of the encoded image in the store differs from its source; make the "
            "store again with {overwrite}");
    }
    const std::lock_guard lock(mutex);
    readers.push_back(std::move(reader));
    ++verified;
    return {};
  };
  bool interrupted = false;
  pool.ForEach(ids.size(), [&](size_t i) {
    const Result<void> result =
        options.is_interrupted() ? Error{ErrorKind::kInterrupted, "interrupted"} : check(ids[i]);
    const std::lock_guard lock(mutex);
    if (!result && result.error().kind == ErrorKind::kInterrupted) {
      interrupted = true;
      return;
    }
    if (!result) faults[i] = result.error().message;
    progress(++done);
  });
  if (interrupted)
    return Error{
        ErrorKind::kInterrupted,
        fmt::format(
            "interrupted after {} of {} LF images were verified: the store is complete; call "
            "lfcompressor with {{verify}} and without {{overwrite}} to check all of it",
            done, ids.size())};
  const auto count = std::count_if(faults.begin(), faults.end(),
                                   [](const auto& fault) { return fault.has_value(); });
  if (count == 0) return verified;
  const auto first = static_cast<size_t>(
      std::find_if(faults.begin(), faults.end(), [](const auto& f) { return f.has_value(); }) -
      faults.begin());
  return InputError(fmt::format(
      "{}: {} of {} LF images are wrong in the store; the first is {}: {}", options.store.string(),
      count, ids.size(), light_field.image_names[ids[first].value], *faults[first]));
}

uint64_t StoreBytes(const fs::path& store) {
  const Result<PackedStoreFacts> facts = ReadPackedStore(store);
  if (!facts) return 0;
  uint64_t bytes = 0;
  for (const fs::path& file : FilesOf(store, *facts)) {
    std::error_code error;
    const uintmax_t of_file = fs::file_size(file, error);
    if (!error) bytes += of_file;
  }
  return bytes;
}

}  // namespace lf
