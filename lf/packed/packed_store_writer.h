// A packed store, written in batches over hours. What was committed survives the program, however
// it ends: the next one goes on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/capture/light_field_identity.h"
#include "lf/core/file_lock.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/packed/packed_store_file.h"

namespace lf {

// What a store is made from and how: it goes on only with the same.
struct PackedStorePlan {
  LightFieldIdentity whole;         // that the LF images are from
  std::vector<uint32_t> whole_ids;  // in it, of each LF image; empty: 0, 1, 2, ...
  std::vector<PixelRect> rects;     // asked for, of each LF image; empty: all of them, whole
  std::string codec;                // all that decides about codes, for people to read, too
  std::optional<DisplayLevels> display_levels = {};  // of codes of kDisplay16
  // 0: one file. Else codes lie in STORE-0001.lfs, STORE-0002.lfs, ... of about this size, beside
  // STORE.lfs, which has all the rest.
  uint64_t shard_bytes = 0;
  // For people; these may differ.
  std::string source;   // LIGHTFIELD or packages, as they were given
  std::string version;  // of the program
};

// One LF image, to be added.
struct CodedImage {
  StoredValues values = StoredValues::kUint8;
  PixelRect rect;    // of the LF image: what the code is of; some of it
  std::string code;  // of the colours, or the mosaic (codec/lf_image_codec.h)
  std::string mask;  // of a grey picture of the same size: of 8 bits, 0: masked; of 16 bits,
                     // opacities (store/opacities.h); empty: nothing is
  uint64_t source_bytes = 0;  // of the files that it was made from; for people
};

// Until Finish() the store is STORE.lfs.unfinished, which no reader takes for one; its shards are
// named alike. A store that has the name meanwhile stays as it is until then. One writer at a time:
// STORE.lfs.lock.
class PackedStoreWriter {
 public:
  // The lock, for one who looks before he writes: given to the call that writes. kOutput.
  static Result<FileLock> Lock(const std::filesystem::path& path);

  // A new one, of the LF images of `light_field`, at least one, which is not kept.
  // kUsage: there is an unfinished one, or a file in the way of a shard that is none of the store
  // that is replaced; kOutput: disk, lock.
  static Result<PackedStoreWriter> Create(const std::filesystem::path& path,
                                          const LightField& light_field,
                                          const PackedStorePlan& plan,
                                          std::optional<FileLock> lock = {});
  // Goes on with an unfinished one; if there is none, or it had hardly begun, a new one.
  // kUsage: it is of other images or settings, the message names the first that differs; kInput: it
  // is no packed store, or damaged; kOutput.
  static Result<PackedStoreWriter> Resume(const std::filesystem::path& path,
                                          const LightField& light_field,
                                          const PackedStorePlan& plan,
                                          std::optional<FileLock> lock = {});
  static bool IsUnfinished(const std::filesystem::path& path);
  // Removes an unfinished one, if there is one.
  static void RemoveUnfinished(const std::filesystem::path& path, const FileLock& lock);

  PackedStoreWriter(PackedStoreWriter&&) noexcept;
  PackedStoreWriter& operator=(PackedStoreWriter&&) noexcept;
  ~PackedStoreWriter();  // commits nothing: what was not is lost

  bool Has(LfImageId id) const;
  // CodedImage::source_bytes of one that it had when it was opened; 0 of others.
  uint64_t SourceBytes(LfImageId id) const;

  // One that it does not have. Commits every 64 LF images, and when the first of them is 2 s old.
  // May be called by many threads at the same time. kOutput: the disk; nothing more can be added.
  Result<void> Add(LfImageId id, const CodedImage& image);
  // Commits what was added: on the disk, for good.
  Result<void> Commit();
  // Commits, marks the store as complete and gives it its name, in place of what has it; LF images
  // that were not added are listed without a code. Shards come first. The last call.
  Result<void> Finish();
  // Removes what it has written, instead of Finish().
  void Abandon();

 private:
  struct State;
  explicit PackedStoreWriter(std::unique_ptr<State> state);
  static Result<PackedStoreWriter> Open(const std::filesystem::path& path,
                                        const LightField& light_field, const PackedStorePlan& plan,
                                        std::optional<FileLock> lock);
  std::unique_ptr<State> state_;
};

// Whether a complete store is what this plan gives, by all but its codes.
//   any_shards  whatever their size
// kInput: it is not, the message names the first that differs; or cannot be read.
Result<void> CheckIsOfPlan(const std::filesystem::path& path, const LightField& light_field,
                           const PackedStorePlan& plan, bool any_shards);

}  // namespace lf
