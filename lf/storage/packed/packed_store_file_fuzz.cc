// SPDX-License-Identifier: Apache-2.0
// Reads any bytes as the file of a packed store: the result must be the facts of a store or an
// error. The LF cameras of a store must be valid, and reading its encoded images and planes must
// succeed or return an error.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "lf/core/check.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/reference_table.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size_bytes) {
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("lf_packed_fuzz." + std::to_string(::getpid()) + ".lfs");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size_bytes));
  const lf::Result<lf::PackedStoreFacts> facts = lf::ReadPackedStore(path);
  if (facts) {
    const lf::LightField& field = facts->light_field;
    LF_CHECK(field.size() > 0 && facts->whole_ids.size() == field.size());
    LF_CHECK(facts->densified || !lf::HasVirtual(field));
    LF_CHECK(facts->left_out_count <= field.size());
    LF_CHECK(facts->predicted_count <= field.size());
    for (const lf::LfCamera& camera : field.cameras) {
      LF_CHECK(camera.intrinsics_index < field.intrinsics.size());
      LF_CHECK(camera.cam_from_world.translation.allFinite());
    }
  } else {
    // The message names the store or one of its shards.
    LF_CHECK(facts.error().message.starts_with(path.parent_path().string()));
  }
  // Searching for reference images ends soon, whatever the file says.
  const auto references = lf::ReadReferences(path);
  LF_CHECK(!facts || references);
  if (references)
    for (uint32_t id = 0; id < 100; ++id) {
      const std::vector<uint32_t> needed = references->NeededBy(id);
      LF_CHECK(needed.size() <= lf::kMostNeededImages + 1 && needed.back() == id);
      LF_CHECK(references->Of(id).size() <= lf::kMostReferenceIds);
      LF_CHECK(!facts || id < facts->light_field.size() || needed.size() == 1);
    }
  // Searches for names also in a file that is not a valid store.
  const std::vector<std::string> names = {"i0.png", "i1.png", "i2.png"};
  const auto codes = lf::FindCodes(path, facts ? facts->light_field.image_names : names);
  auto reader = lf::PackedCodeReader::Open(path);
  if (codes && reader)
    for (const lf::PackedCode& code : *codes) {
      LF_CHECK(!code.is_left_out || (code.bytes == 0 && !code.Keeps({0, 0, 1, 1})));
      if (code.bytes == 0) continue;
      const auto bytes = reader->Read(code);
      LF_CHECK(bytes || !bytes.error().message.empty());
      const auto front = reader->ReadFront(code, 1);
      LF_CHECK(front || !front.error().message.empty());
      LF_CHECK(!front || !*front || (*front)->code.size() <= code.bytes);
    }
  if (auto planes = lf::PackedPlaneReader::Open(path))
    for (uint32_t i = 0; i < 4; ++i)
      for (const lf::PlaneKind kind :
           {lf::PlaneKind::kSwept, lf::PlaneKind::kDisparity, lf::PlaneKind::kTrust}) {
        const auto has = planes->Has({i}, kind);
        const auto plane = planes->Read({i}, kind);
        LF_CHECK(plane ? !has || *has : plane.error().message.starts_with(path.string()));
        if (kind != lf::PlaneKind::kTrust) continue;
        const auto trust = planes->ReadTrust({i}, {1, 1, 3, 2});
        LF_CHECK(trust ? trust->width() == 2 && trust->height() == 1
                       : trust.error().message.starts_with(path.string()));
      }
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return 0;
}
