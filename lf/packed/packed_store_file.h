// The file of a packed store: the LF images of a light field, coded, and their calibration, in one
// SQLite file (doc/formats/packed_store.md). Here to be read; written by packed_store_writer.h.
// Codes are bytes here, whatever wrote them: store/packed_store.h makes pixels of them.
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

#include "lf/capture/light_field.h"
#include "lf/capture/light_field_identity.h"
#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

// What the numbers in a code stand for.
enum class StoredValues : uint8_t {
  kUint8 = 0,      // stored values of 8 bits
  kUint16 = 1,     // of 16
  kHalf = 2,       // radiance: bit patterns of half floats, in order (store/ordered_half.h)
  kDisplay16 = 3,  // of 16 bits, along a curve: ReadDisplayLevels(), store/display_curve.h
};

inline constexpr const char* kStoreExtension = ".lfs";

// Whether the file says that it is one, by its first bytes; its shards do not.
bool IsPackedStore(const std::filesystem::path& path);
// By the extension of its folder, which is then a file: what is no store of this version is told by
// whoever opens it.
inline bool HoldsPackedStore(const LightField& light_field) {
  std::error_code error;
  return light_field.folder.extension() == kStoreExtension &&
         !std::filesystem::is_directory(light_field.folder, error);
}
// The stores in a folder, sorted.
std::vector<std::filesystem::path> PackedStoresIn(const std::filesystem::path& folder);

// All but the pixels.
struct PackedStoreFacts {
  LightField light_field;           // folder: the file; no masks, which are within the codes
  LightFieldIdentity whole;         // that the LF images are from
  std::vector<uint32_t> whole_ids;  // in it, as light_field.cameras
  std::string source;               // LIGHTFIELD, as the writer was given it
  std::string codec;                // settings, for people
  std::string written_by;
  size_t shard_count = 0;  // 0: the codes are in the file itself
};

// kInput: it cannot be read, is no complete packed store, damaged, of another version, or lacks a
// shard.
Result<PackedStoreFacts> ReadPackedStore(const std::filesystem::path& path);

// Its files: itself, then its shards.
std::vector<std::filesystem::path> FilesOf(const std::filesystem::path& path,
                                           const PackedStoreFacts& facts);

// Black and white of the display curve that codes of kDisplay16 are along. The levels of the light
// field when they were made: those may be mended.
struct DisplayLevels {
  double black = 0;
  double white = 0;  // above black
};
// kInput: as ReadPackedStore(); it has none.
Result<DisplayLevels> ReadDisplayLevels(const std::filesystem::path& path);

// PackedStoreFacts::codec alone. Settings that begin with kLosslessCodec give back what was
// recorded.
Result<std::string> ReadCodecSettings(const std::filesystem::path& path);
inline constexpr std::string_view kLosslessCodec = "lossless";

// PackedStoreFacts::whole alone.
Result<LightFieldIdentity> ReadWholeIdentity(const std::filesystem::path& path);

// Of one LF image: where its code is, and of what. 32 bytes.
struct PackedCode {
  static constexpr uint32_t kNotListed = UINT32_MAX;

  uint32_t id = kNotListed;  // in the store
  uint16_t shard = 0;        // 0: in the file itself
  StoredValues values = StoredValues::kUint8;
  PixelRect rect;      // of the LF image: what the code is of
  uint64_t bytes = 0;  // of code and mask; 0: there is none, the LF image could not be read

  bool is_listed() const { return id != kNotListed; }
};

// Those of LF images of these names; not listed: the store knows nothing of it. For an LF image
// that occurs twice, the first and the second of the store. Takes seconds for a million. kInput.
Result<std::vector<PackedCode>> FindCodes(const std::filesystem::path& path,
                                          std::span<const std::string> names);

// Reads codes, one at a time: for one thread. Opens shards as they are asked for, and keeps a few.
class PackedCodeReader {
 public:
  // kInput, as ReadPackedStore().
  static Result<PackedCodeReader> Open(const std::filesystem::path& path);
  PackedCodeReader(PackedCodeReader&&) noexcept;
  PackedCodeReader& operator=(PackedCodeReader&&) noexcept;
  ~PackedCodeReader();

  struct Bytes {
    std::string_view code;
    std::string_view mask;  // a code, too; empty: nothing is masked
  };
  // One that is there; the bytes hold until the next call. kInput, naming the file: damage, found
  // by the checksum; a shard that is missing or belongs to another store.
  Result<Bytes> Read(const PackedCode& code);

 private:
  struct State;
  explicit PackedCodeReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lf
