// SPDX-License-Identifier: Apache-2.0
// Reads the file of a packed store: the encoded LF images of a light field with their calibration,
// in one SQLite file (doc/formats/packed_store.md). A large store may keep its encoded images in
// further files, its shards. A store by resolution keeps them in parts: the smallest pictures of
// all LF images in the first file, and the bytes that double their resolution in each further one.
// packed_store_writer.h writes all of them. Here, encoded images are bytes in any format;
// storage/load/packed_store.h decodes them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/light_field_identity.h"
#include "lf/storage/packed/packed_planes.h"

namespace lf {

// Meaning of the numbers in an encoded image.
enum class StoredValues : uint8_t {
  kUint8 = 0,      // 8-bit values as the image file stored them
  kUint16 = 1,     // 16-bit values as the image file stored them
  kHalf = 2,       // radiance: bit patterns of half floats, as ordered integers
                   // (storage/load/ordered_half.h)
  kDisplay16 = 3,  // 16-bit values of the image file, mapped to a tone curve
                   // (ReadDisplayLevels(), storage/load/display_curve.h)
  kFile = 4,       // no numbers: the encoded image is the image file itself, byte by byte
};

inline constexpr const char* kStoreExtension = ".lfs";

// Returns true if the first bytes of the file identify a packed store. False for a shard of a
// store.
bool IsPackedStore(const std::filesystem::path& path);
// Returns true if the store exists. kUsage: a file that is no packed store has its name.
Result<bool> IsStoreThere(const std::filesystem::path& path);
// Returns true if `folder` of the light field has the extension of a packed store and is no
// directory. Only opening the file tells whether it is a valid store of this version.
inline bool HoldsPackedStore(const LightField& light_field) {
  std::error_code error;
  return light_field.folder.extension() == kStoreExtension &&
         !std::filesystem::is_directory(light_field.folder, error);
}
// Returns the paths of the packed stores directly in a folder, sorted.
std::vector<std::filesystem::path> PackedStoresIn(const std::filesystem::path& folder);

// Stands for the number in the whole light field of a virtual LF image, which has none.
inline constexpr uint32_t kNoWholeId = UINT32_MAX;

// The films that a store was encoded for: its LF images have thresholds of their own, by how much
// these films use each of them.
struct StoreFilms {
  std::vector<std::string> lenses;  // of each film, HashOfLenses() (render/state/run_inputs.h)
  std::string lens_weights;         // NameOf(LensWeights)
  size_t frame_count = 0;           // number of frames that were considered, of all films together
  std::string source = {};          // PackedStoreFacts::source; set when a store is read
};

// Everything in a packed store but the encoded images.
struct PackedStoreFacts {
  LightField light_field;    // LF cameras of the store; `folder` is the store's file; no mask
                             // files, because masks are stored with the encoded images
  LightFieldIdentity whole;  // identity of the light field that the LF images are from
  std::vector<uint32_t> whole_ids;  // id of each LF image in `whole`; kNoWholeId: it is virtual
  std::string source;               // LIGHTFIELD or packages that the store was made from
  std::string codec;                // settings of the codec, in words
  std::string written_by;
  std::optional<StoreFilms> films;         // set if the store was encoded for certain films
  std::optional<DensifiedPlan> densified;  // set if the store is densified
  size_t shard_count = 0;  // number of shards; 0: the encoded images are in the store's file itself
  size_t left_out_count = 0;  // number of LF images that were left out on purpose
  size_t part_count = 0;      // number of parts; 0: the store is not by resolution
  size_t found_parts =
      0;  // number of the first parts that are there; at least 1 if there are parts
  size_t predicted_count = 0;  // number of LF images that are predicted from others
  // Number of LF images that were encoded, but of which the parts that are there lack bytes,
  // because the copy of a part is incomplete.
  size_t cut_count = 0;

  // Returns true if the store was made by a program that kept only the LF cameras of the LF images
  // that packages need.
  bool LacksCameras() const { return !densified && light_field.size() < whole.image_count; }
};

// Reads everything in a packed store but the encoded images. kInput: the file cannot be read, is no
// complete packed store, is damaged, has another version, or lacks a shard or its first part.
Result<PackedStoreFacts> ReadPackedStore(const std::filesystem::path& path);

// Returns the store's file, followed by its shards or by the parts that are there.
std::vector<std::filesystem::path> FilesOf(const std::filesystem::path& path,
                                           const PackedStoreFacts& facts);

// Black and white level of the display curve along which images are encoded as kDisplay16. They are
// the levels that the light field had when the images were encoded; the levels of the light field
// may be corrected later.
struct DisplayLevels {
  double black = 0;
  double white = 0;  // must be above `black`
};
// Reads the display levels of a packed store. kInput as ReadPackedStore(), and if the store has no
// display levels.
Result<DisplayLevels> ReadDisplayLevels(const std::filesystem::path& path);

// Returns PackedStoreFacts::codec without reading the other facts. Settings that begin with
// kLosslessCodec restore the recorded values exactly.
Result<std::string> ReadCodecSettings(const std::filesystem::path& path);
inline constexpr std::string_view kLosslessCodec = "lossless";

// Returns PackedStoreFacts::films without reading the other facts.
Result<std::optional<StoreFilms>> ReadStoreFilms(const std::filesystem::path& path);

// Returns PackedStoreFacts::whole without reading the other facts.
Result<LightFieldIdentity> ReadWholeIdentity(const std::filesystem::path& path);

// Returns the name of the LF image that has this id in the store, for messages about it.
Result<std::string> NameInStore(const std::filesystem::path& path, LfImageId id);

// Tells in which file of a store one encoded LF image is, and what it holds. Takes 32 bytes.
struct PackedCode {
  static constexpr uint32_t kNotListed = UINT32_MAX;

  uint32_t id = kNotListed;  // id of the LF image in the store
  uint16_t shard = 0;        // number of the shard that has the image; 0: the store's file
  StoredValues values = StoredValues::kUint8;
  bool is_virtual : 1 = false;   // true if the store marks the LF image as virtual
  bool is_left_out : 1 = false;  // true if the LF image was left out of the store on purpose
  // Number of the finest parts of a store by resolution without which the LF image must be loaded,
  // because a part is missing or was cut off; 0: all bytes are there.
  uint8_t missing_parts : 4 = 0;
  PixelRect rect;      // pixels of the LF image that are encoded
  uint64_t bytes = 0;  // size of the encoded pixels and mask; 0: the store lacks them, because the
                       // LF image could not be read, or was left out

  bool is_listed() const { return id != kNotListed; }
  // Returns false if the store was made without some of the pixels `wanted`. An LF image that could
  // not be read when the store was made counts as kept, because it is skipped like a broken file.
  bool Keeps(const PixelRect& wanted) const {
    if (!is_listed()) return false;
    if (wanted.empty()) return true;
    return !is_left_out && (bytes == 0 || Intersection(rect, wanted) == wanted);
  }
};
static_assert(sizeof(PackedCode) == 32);

// Returns an entry for each of `names`. Its is_listed() is false if the store has no LF image of
// this name. If a name occurs twice in `names`, the two entries belong to the first and the second
// LF image of this name in the store. Takes seconds for a million names. kInput as
// ReadPackedStore().
Result<std::vector<PackedCode>> FindCodes(const std::filesystem::path& path,
                                          std::span<const std::string> names);
// Returns an entry for each LF image of the light field, found by its name. An entry is also not
// listed if the light field and the store do not agree that the LF image is virtual, so that a
// virtual LF image is never taken for a recorded one of the same name.
Result<std::vector<PackedCode>> FindCodes(const std::filesystem::path& path,
                                          const LightField& light_field);

// Returns an entry for each LF image of the store, in the order of their ids in it. An LF image
// without an encoded image has an entry that is not listed. kInput as ReadPackedStore().
Result<std::vector<PackedCode>> CodesInStore(const std::filesystem::path& path);

// Reads encoded images, one at a time, for one thread. Opens shards when they are needed, and keeps
// a few open.
class PackedCodeReader {
 public:
  // Opens a store for reading. kInput as ReadPackedStore().
  static Result<PackedCodeReader> Open(const std::filesystem::path& path);
  PackedCodeReader(PackedCodeReader&&) noexcept;
  PackedCodeReader& operator=(PackedCodeReader&&) noexcept;
  ~PackedCodeReader();

  struct Bytes {
    std::string_view code;
    std::string_view mask;  // encoded mask or opacities; empty: the LF image has none
  };
  // Reads an encoded image, which must be in the store. The bytes are valid until the next call.
  // kInput, naming the file: the checksum shows damage, or a shard or part is missing, belongs to
  // another store, or was cut off.
  Result<Bytes> Read(const PackedCode& code);

  struct Front {
    std::string_view code;  // the first bytes of the encoded image
    size_t left_out = 0;    // number of longer fronts; the whole image counts as one of them
  };
  // Reads the first bytes of an encoded image without the rest: its longest front but the last
  // `left_out`, which is at least 1, or its shortest front. nullopt: the store has no fronts of the
  // image. The bytes are valid until the next call of this class. kInput as Read().
  Result<std::optional<Front>> ReadFront(const PackedCode& code, size_t left_out);

 private:
  struct State;
  explicit PackedCodeReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lf
