// SPDX-License-Identifier: Apache-2.0
// Writes a packed store in batches over hours. Committed batches survive however the program ends,
// and the next program resumes from them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/core/file_lock.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/light_field_identity.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {

// Everything that determines a store. An unfinished store is resumed only with an equal plan.
struct PackedStorePlan {
  LightFieldIdentity whole;  // identity of the light field that the LF images are from
  // Id of each LF image in `whole`; kNoWholeId for virtual ones. Empty: 0, 1, 2, ..., and
  // kNoWholeId for virtual ones.
  std::vector<uint32_t> whole_ids;
  // Pixels of each LF image that are encoded. An empty rectangle: the LF image is left out on
  // purpose, and its LF camera alone is kept. No rectangles: all pixels of all LF images.
  std::vector<PixelRect> rects;
  std::string codec;                                 // all settings of the encoder, in words
  std::optional<DisplayLevels> display_levels = {};  // set if images are encoded as kDisplay16
  std::optional<StoreFilms> films = {};  // set if `codec` has thresholds for certain films
  // Size of a shard. If it is not 0, the encoded images are in STORE-0001.lfs, STORE-0002.lfs, ...
  // of about this size, beside STORE.lfs, which has everything else. 0: the store is one file.
  uint64_t shard_bytes = 0;
  // Makes a store by resolution: the encoded images are in STORE-r0.lfs, STORE-r1.lfs, ..., at most
  // this number of files, of which each doubles the resolution of those before. From 1 to 8, and
  // one more than the most fronts of an LF image that are of use by themselves. 0: the store is not
  // by resolution. Not together with shards, and not for densified stores.
  size_t part_count = 0;
  // True: LF images may be predicted from others (CodedImage::references). Not together with
  // part_count, because predicted images have no smaller pictures.
  bool is_predicted = false;
  // Makes a densified store. Must be set if an LF image is virtual.
  std::optional<DensifiedPlan> densified = {};
  // `source` and `version` are for information only. They may differ when an unfinished store is
  // resumed.
  std::string source;   // LIGHTFIELD or packages, as the user gave them
  std::string version;  // version of the program

  // Returns true if any LF image is left out.
  bool LeavesOut() const;
};

// One encoded LF image, which PackedStoreWriter::Add() writes.
struct CodedImage {
  StoredValues values = StoredValues::kUint8;
  PixelRect rect;    // pixels of the LF image that are encoded; not empty
  std::string code;  // encoded colours, or mosaic (pixels/codec/lf_image_codec.h)
  std::string mask;  // encoded grey picture of the size of `rect`: a mask if it has 8 bits (0 is
                     // masked), opacities if it has 16 (storage/load/recorded_image.h); empty: none
  uint64_t source_bytes = 0;  // size of the files that the LF image was read from, for information
  // Ends of the fronts of `code` that PackedCodeReader::ReadFront() can read, ascending. Empty if
  // there is a mask, because a smaller picture would need a smaller mask.
  std::vector<uint64_t> front_ends = {};
  // LF images whose decoded pixels are the reference images of `code`, in their order in it
  // (pixels/codec/predicted_image.h), at most kMostReferenceIds. With their own reference images,
  // and so on, these are at most kMostNeededImages (reference_table.h). Empty: the image is not
  // predicted. `values` of all of them are numbers, and front_ends of a predicted image are empty.
  std::vector<LfImageId> references = {};
};

// An LF image of a group, which PackedStoreWriter::AddGroup() writes.
struct GroupedImage {
  LfImageId id;
  CodedImage image;
};

// Writes a packed store. Until Finish() its file is STORE.lfs.unfinished, which no reader accepts
// as a store, and its shards are STORE-0001.lfs.unfinished and so on, or its parts
// STORE-r0.lfs.unfinished and so on. The bytes of LF images are in the parts in the order in which
// they are added. An older store of the final
// name stays unchanged until Finish(). The lock STORE.lfs.lock allows one writer at a time.
class PackedStoreWriter {
 public:
  // Takes the lock, for a caller that checks existing files before it writes. The caller passes the
  // lock to Create() or Resume(). kOutput: another writer holds the lock, or it cannot be created.
  static Result<FileLock> Lock(const std::filesystem::path& path);

  // Begins a new store of the LF images of `light_field`, which has at least one LF image and need
  // not outlive the call. Takes the lock if `lock` is not given. kUsage: there is an unfinished
  // store, or a file with the name of the first shard or of a part that does not belong to the
  // store that is replaced; or a virtual LF image has the name of another LF image. kOutput: the
  // disk fails, or another writer holds the lock.
  static Result<PackedStoreWriter> Create(const std::filesystem::path& path,
                                          const LightField& light_field,
                                          const PackedStorePlan& plan,
                                          std::optional<FileLock> lock = {});
  // Resumes an unfinished store. If there is none, or it has no tables yet, begins a new one.
  // kUsage: the unfinished store was begun for other LF images or settings (the message names the
  // first difference). kInput: its file is no packed store, is damaged, or lacks a shard or a part.
  // kOutput
  // as Create().
  static Result<PackedStoreWriter> Resume(const std::filesystem::path& path,
                                          const LightField& light_field,
                                          const PackedStorePlan& plan,
                                          std::optional<FileLock> lock = {});
  static bool IsUnfinished(const std::filesystem::path& path);
  // Removes an unfinished store and its shards, if there is one.
  static void RemoveUnfinished(const std::filesystem::path& path, const FileLock& lock);

  PackedStoreWriter(PackedStoreWriter&&) noexcept;
  PackedStoreWriter& operator=(PackedStoreWriter&&) noexcept;
  ~PackedStoreWriter();  // drops LF images that are not committed

  // Returns true if the LF image was added in this run or an earlier one.
  bool Has(LfImageId id) const;
  // Returns CodedImage::source_bytes of an LF image that the store had when it was opened; 0 for
  // other LF images.
  uint64_t SourceBytes(LfImageId id) const;

  // Adds an LF image that the store does not have and that the plan does not leave out. Commits if
  // 64 LF images were added since the last commit, or if the first of these was added at least 2 s
  // ago. The store has the reference images of a predicted LF image already. May be called by many
  // threads at the same time. kOutput: the disk fails; no LF image can be added afterwards. kUsage:
  // a file that does not belong to the store has the name of the next shard.
  Result<void> Add(LfImageId id, const CodedImage& image);
  // Adds LF images as Add() does, but in one batch and one shard: either all of them survive the
  // end of the program, or none. The reference images of each stand before it in `images`, or are
  // in the store. The plan must have is_predicted if there are any.
  Result<void> AddGroup(std::span<const GroupedImage> images);

  // The functions of planes are for densified stores. They may be called by many threads at the
  // same time, also together with Add(). Planes are committed in the same batches as LF images.
  // Returns true if the plane was added in this run or an earlier one.
  bool HasPlane(LfImageId id, PlaneKind kind) const;
  // Adds a plane of a recorded LF image, which the store does not have. Its size must be
  // PlaneSizeOf() of the LF image. Errors as Add().
  Result<void> AddPlane(LfImageId id, PlaneKind kind, const Image<uint16_t>& plane);
  // Adds the plane kTrust of a virtual LF image, which has the size of the LF image: trust from 0
  // to LfPixels::kTrusted, which is rounded to kTrustSteps steps. Errors as Add().
  Result<void> AddTrust(LfImageId id, const Image<uint8_t>& trust);
  // Reads a plane of a recorded LF image for which HasPlane() is true. kInput: it is damaged.
  // kOutput: the disk fails.
  Result<Image<uint16_t>> ReadPlane(LfImageId id, PlaneKind kind) const;
  // Commits, and removes all planes of a kind for good. Later planes and LF images reuse their
  // space, but the file does not become smaller. kOutput: the disk fails.
  Result<void> DropPlanes(PlaneKind kind);

  // Commits the LF images and planes that were added, so that they are on the disk permanently.
  Result<void> Commit();
  // Commits, marks the store as complete and gives it its final name, replacing an older store.
  // Shards and parts are renamed first. LF images that were not added are listed without an encoded
  // image. Nothing may be called afterwards.
  Result<void> Finish();
  // Removes all that was written. Is called instead of Finish().
  void Abandon();

 private:
  struct State;
  explicit PackedStoreWriter(std::unique_ptr<State> state);
  static Result<PackedStoreWriter> Open(const std::filesystem::path& path,
                                        const LightField& light_field, const PackedStorePlan& plan,
                                        std::optional<FileLock> lock);
  std::unique_ptr<State> state_;
};

// Checks that a store matches a plan in everything but the encoded images.
//   any_shards  shards of any size match
// kInput: the store differs (the message names the first difference), or cannot be read.
Result<void> CheckIsOfPlan(const std::filesystem::path& path, const LightField& light_field,
                           const PackedStorePlan& plan, bool any_shards);

}  // namespace lf
