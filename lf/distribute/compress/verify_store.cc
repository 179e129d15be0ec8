// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/verify_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/distribute/compress/compress.h"
#include "lf/distribute/compress/group_coder.h"
#include "lf/distribute/compress/image_coder.h"
#include "lf/distribute/compress/image_groups.h"
#include "lf/storage/load/recorded_image.h"
#include "lf/storage/load/reference_cache.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace fs = std::filesystem;

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

namespace {

// Compares the LF images of a source with a store.
class Verifier {
 public:
  static Result<std::unique_ptr<Verifier>> Open(const CompressSource& source,
                                                const VerifyOptions& options) {
    LF_ASSIGN_OR_RETURN(std::vector<PackedCode> codes,
                        FindCodes(options.store, source.light_field));
    LF_ASSIGN_OR_RETURN(std::unique_ptr<ReferenceCache> references,
                        ReferenceCache::Open(options.store, source.light_field.encoding.bayer));
    return std::make_unique<Verifier>(source, options, std::move(codes), std::move(references));
  }
  Verifier(const CompressSource& source, const VerifyOptions& options,
           std::vector<PackedCode> codes, std::unique_ptr<ReferenceCache> references)
      : source_(source),
        options_(options),
        codes_(std::move(codes)),
        references_(std::move(references)),
        coder_(source.light_field.encoding, options.encoding.settings, options.encoding.files,
               options.is_interrupted),
        group_coder_(source, coder_, options.factors, options.is_interrupted) {}

  // Checks an LF image that is encoded by itself, or copied. The error says what is wrong.
  Result<void> Check(LfImageId id) {
    const Result<CodedImage> made = Encode(id);
    if (!made && made.error().kind == ErrorKind::kInterrupted) return made.error();
    if (!IsStored(id)) {
      if (!made) return {};
      return InputError(
          "the image can be read, but is not in the store; make the store again with {overwrite}");
    }
    LF_RETURN_IF_ERROR(made);
    return Compare(id, *made);
  }

  // Checks a group of LF images, of which some may be predicted. Returns what is wrong with each.
  // kInterrupted.
  Result<std::vector<Result<void>>> CheckGroup(std::span<const GroupMember> group) {
    // Bits of ranks. An LF image is late if it may have been added after its group.
    uint32_t missing = 0, late = 0;
    for (size_t rank = 0; rank < group.size(); ++rank) {
      const LfImageId id = group[rank].id;
      if (!IsStored(id))
        missing |= 1U << rank;
      else if (!references_ || !references_->Concerns(codes_[id.value].id))
        late |= 1U << rank;
    }
    LF_ASSIGN_OR_RETURN(std::vector<Result<void>> results, CheckGroup(group, missing, missing));
    const bool all_right = std::all_of(results.begin(), results.end(),
                                       [](const Result<void>& result) { return bool(result); });
    if (all_right) return results;
    // LF images that could not be read when the group was encoded, but when the unfinished store
    // was resumed, are encoded by themselves. Others that are not predicted may have another
    // threshold (GroupSteps).
    for (size_t rank = 0; rank < group.size(); ++rank) {
      if (!(late >> rank & 1)) continue;
      const Result<void> by_itself = Check(group[rank].id);
      if (!by_itself && by_itself.error().kind == ErrorKind::kInterrupted) return by_itself.error();
      if (!by_itself) late &= ~(1U << rank);
    }
    if (late == 0) return results;
    LF_ASSIGN_OR_RETURN(std::vector<Result<void>> others,
                        CheckGroup(group, missing | late, missing | late));
    const auto faults = [](const std::vector<Result<void>>& all) {
      return std::count_if(all.begin(), all.end(), [](const Result<void>& r) { return !r; });
    };
    return faults(others) < faults(results) ? others : results;
  }

  bool IsStored(LfImageId id) const { return codes_[id.value].bytes > 0; }

 private:
  // Encodes an LF image as it must be in the store. kInput: it cannot be read.
  Result<CodedImage> Encode(LfImageId id) const {
    if (options_.copied) return options_.copied->Of(id);
    LF_ASSIGN_OR_RETURN(const RecordedImage image, ReadToCompress(source_, id));
    return coder_.CodeOrFile(source_.light_field, id, image, options_.factors.Of(id.value));
  }

  //   left_out  ranks that the group is encoded without
  //   alone     ranks that are checked as LF images that are encoded by themselves
  Result<std::vector<Result<void>>> CheckGroup(std::span<const GroupMember> group,
                                               uint32_t left_out, uint32_t alone) {
    LF_ASSIGN_OR_RETURN(const CodedGroup coded, group_coder_.Encode(group, {}, left_out));
    std::vector<Result<void>> results(group.size());
    for (size_t rank = 0; rank < group.size(); ++rank) {
      const LfImageId id = group[rank].id;
      const auto member = std::find_if(coded.members.begin(), coded.members.end(),
                                       [id](const CodedMember& other) { return other.id == id; });
      const auto unreadable =
          std::find_if(coded.unreadable.begin(), coded.unreadable.end(),
                       [id](const CodedGroup::Unreadable& other) { return other.id == id; });
      if (alone >> rank & 1)
        results[rank] = Check(id);
      else if (member != coded.members.end())
        results[rank] = Compare(id, member->image);
      else if (unreadable != coded.unreadable.end())
        results[rank] = unreadable->error;
      if (!results[rank] && results[rank].error().kind == ErrorKind::kInterrupted)
        return results[rank].error();
    }
    return results;
  }

  // Reads an encoded image from the store, decodes it, and compares it with what it must be.
  Result<void> Compare(LfImageId id, const CodedImage& again) {
    const PackedCode& code = codes_[id.value];
    LF_ASSIGN_OR_RETURN(std::unique_ptr<PackedCodeReader> reader, TakeReader());
    const Result<PackedCodeReader::Bytes> bytes = reader->Read(code);
    LF_RETURN_IF_ERROR(bytes);
    if (code.values != StoredValues::kFile) {
      DecodedPart decoded;
      const PixelRect whole = {0, 0, code.rect.width(), code.rect.height()};
      LF_RETURN_IF_ERROR(references_ && references_->Concerns(code.id)
                             ? references_->Decode(code.id, bytes->code, whole, &decoded)
                             : DecodeImage(bytes->code, &decoded));
    }
    if (code.rect != again.rect || code.values != again.values || bytes->code != again.code ||
        bytes->mask != again.mask || !HasReferences(code.id, again.references))
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
    const std::lock_guard lock(mutex_);
    readers_.push_back(std::move(reader));
    return {};
  }

  // Returns true if the store has these reference images of an LF image.
  //   in_store  id of the LF image in the store
  bool HasReferences(uint32_t in_store, const std::vector<LfImageId>& references) const {
    if (!references_) return references.empty();
    const std::span<const uint32_t> found = references_->references().Of(in_store);
    return std::equal(found.begin(), found.end(), references.begin(), references.end(),
                      [&](uint32_t a, LfImageId b) { return a == codes_[b.value].id; });
  }

  Result<std::unique_ptr<PackedCodeReader>> TakeReader() {
    {
      const std::lock_guard lock(mutex_);
      if (!readers_.empty()) {
        std::unique_ptr<PackedCodeReader> reader = std::move(readers_.back());
        readers_.pop_back();
        return reader;
      }
    }
    LF_ASSIGN_OR_RETURN(PackedCodeReader reader, PackedCodeReader::Open(options_.store));
    return std::make_unique<PackedCodeReader>(std::move(reader));
  }

  const CompressSource& source_;
  const VerifyOptions& options_;
  const std::vector<PackedCode> codes_;  // [LF image]
  const std::unique_ptr<ReferenceCache> references_;
  const ImageCoder coder_;
  const GroupCoder group_coder_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<PackedCodeReader>>
      readers_;  // the readers that nobody uses now; guarded by mutex_
};

}  // namespace

Result<size_t> VerifyStore(const CompressSource& source, const VerifyOptions& options,
                           ThreadPool& pool, const std::function<void(size_t)>& progress) {
  LF_RETURN_IF_ERROR(CheckStoreFacts(source, options));
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<Verifier> verifier, Verifier::Open(source, options));
  const bool in_groups = options.encoding.in_groups && options.copied == nullptr;
  const std::vector<LfImageId> ids = source.CompressedIds();
  const ReferenceGroups groups = in_groups ? GroupsOf(source) : ReferenceGroups();
  std::mutex mutex;  // guards the variables below
  size_t done = 0;
  bool interrupted = false;
  std::map<uint32_t, std::string> faults;  // by LF image
  const auto note = [&](LfImageId id, const Result<void>& result) {
    const std::lock_guard lock(mutex);
    if (!result && result.error().kind == ErrorKind::kInterrupted)
      interrupted = true;
    else if (!result)
      faults[id.value] = result.error().message;
  };
  const auto show = [&](size_t count) {
    const std::lock_guard lock(mutex);
    done += count;
    if (!interrupted) progress(done);
  };
  pool.ForEach(in_groups ? groups.size() : ids.size(), [&](size_t i) {
    const LfImageId first = in_groups ? groups.Group(i)[0].id : ids[i];
    if (options.is_interrupted()) return note(first, Error{ErrorKind::kInterrupted, "interrupted"});
    if (!in_groups) {
      note(first, verifier->Check(first));
      return show(1);
    }
    const Result<std::vector<Result<void>>> results = verifier->CheckGroup(groups.Group(i));
    if (!results && results.error().kind == ErrorKind::kInterrupted)
      return note(first, results.error());
    for (size_t rank = 0; rank < groups.Group(i).size(); ++rank)
      note(groups.Group(i)[rank].id, results ? (*results)[rank] : Result<void>(results.error()));
    show(groups.Group(i).size());
  });
  if (interrupted)
    return Error{
        ErrorKind::kInterrupted,
        fmt::format(
            "interrupted after {} of {} LF images were verified: the store is complete; call "
            "lfcompressor with {{verify}} and without {{overwrite}} to check all of it",
            done, ids.size())};
  if (faults.empty())
    return static_cast<size_t>(std::count_if(ids.begin(), ids.end(),
                                             [&](LfImageId id) { return verifier->IsStored(id); }));
  const auto& [first, fault] = *faults.begin();
  return InputError(fmt::format(
      "{}: {} of {} LF images are wrong in the store; the first is {}: {}", options.store.string(),
      faults.size(), ids.size(), source.light_field.image_names[first], fault));
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
