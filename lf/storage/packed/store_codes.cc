// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/store_codes.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "lf/storage/packed/part_set.h"
#include "lf/storage/tables/calibration_tables.h"

namespace lf {
namespace {

// Sets PackedCode::missing_parts. Reads the places of LF images only if a part is smaller than the
// store states.
Result<void> FindMissingParts(OpenedStore* store, std::vector<PackedCode>* codes) {
  LF_ASSIGN_OR_RETURN(const size_t part_count, PlannedParts(store->settings));
  if (part_count == 0) return {};
  LF_ASSIGN_OR_RETURN(const std::vector<uint64_t> stated, StatedPartBytes(store->settings));
  LF_ASSIGN_OR_RETURN(const std::vector<uint64_t> found,
                      FoundPartBytes(store->database.name(), store->settings));
  if (found == stated) return {};
  return ForEachRow(
      store->database, "select id, ranges from ranges", [&](const Statement& row) -> Result<void> {
        LF_ASSIGN_OR_RETURN(const int64_t id,
                            row.Integer(0, 0, static_cast<int64_t>(codes->size()) - 1));
        LF_ASSIGN_OR_RETURN(const std::string_view text, row.Blob(1));
        const std::optional<ImageRanges> ranges = RangesOfText(text, part_count);
        if (!ranges)
          return store->settings.Damaged(
              fmt::format("it states an impossible range of bytes of LF image {}", id));
        const auto is_there = [&](size_t part, const PartRange& range) {
          return range.bytes == 0 || (part < found.size() && range.end() <= found[part]);
        };
        size_t complete = is_there(0, ranges->mask) ? ranges->pieces.size() : 0;
        for (size_t i = 0; i < complete; ++i)
          if (!is_there(ranges->PartOf(i, part_count), ranges->pieces[i])) complete = i;
        (*codes)[static_cast<size_t>(id)].missing_parts =
            static_cast<uint8_t>(complete == 0 ? part_count : ranges->pieces.size() - complete);
        return {};
      });
}

}  // namespace

Result<std::vector<bool>> ReadMarks(OpenedStore* store, const std::string& table,
                                    size_t image_count) {
  LF_ASSIGN_OR_RETURN(const bool is_there, HasTable(&store->database, table));
  std::vector<bool> marks(is_there ? image_count : 0);
  if (!is_there) return marks;
  LF_RETURN_IF_ERROR(ForEachRow(store->database, fmt::format("select id from {}", table),
                                [&](const Statement& row) -> Result<void> {
                                  LF_ASSIGN_OR_RETURN(
                                      const int64_t id,
                                      row.Integer(0, 0, static_cast<int64_t>(image_count) - 1));
                                  marks[static_cast<size_t>(id)] = true;
                                  return {};
                                }));
  return marks;
}

Result<std::vector<PackedCode>> ReadCodes(OpenedStore* store) {
  LF_ASSIGN_OR_RETURN(const double shards, store->settings.Number("shards", 0, kMostShards));
  LF_ASSIGN_OR_RETURN(Statement count, store->database.Prepare("select count(*) from lf_images"));
  LF_RETURN_IF_ERROR(count.Step());
  LF_ASSIGN_OR_RETURN(const int64_t image_count, count.Integer(0, 1, kMostImages));
  std::vector<PackedCode> codes(static_cast<size_t>(image_count));
  LF_RETURN_IF_ERROR(ForEachRow(
      store->database, "select id, shard, kind, x_begin, y_begin, x_end, y_end, bytes from codes",
      [&](const Statement& row) -> Result<void> {
        PackedCode code;
        LF_ASSIGN_OR_RETURN(const int64_t id, row.Integer(0, 0, image_count - 1));
        LF_ASSIGN_OR_RETURN(const int64_t shard, row.Integer(1, 0, static_cast<int64_t>(shards)));
        LF_ASSIGN_OR_RETURN(const std::string kind, row.Text(2));
        int64_t sides[4];
        for (int i = 0; i < 4; ++i) {
          LF_ASSIGN_OR_RETURN(sides[i], row.Integer(3 + i, 0, kMostSide_px));
        }
        LF_ASSIGN_OR_RETURN(const int64_t bytes, row.Integer(7, 1, INT64_MAX));
        const auto* const name = std::find(std::begin(kKindNames), std::end(kKindNames), kind);
        code.rect = {static_cast<int>(sides[0]), static_cast<int>(sides[1]),
                     static_cast<int>(sides[2]), static_cast<int>(sides[3])};
        if (name == std::end(kKindNames) || code.rect.empty())
          return store->settings.Damaged(
              fmt::format("the encoded image of LF image {} has an unknown kind or no pixels", id));
        code.id = static_cast<uint32_t>(id);
        code.shard = static_cast<uint16_t>(shard);
        code.values = static_cast<StoredValues>(name - std::begin(kKindNames));
        code.bytes = static_cast<uint64_t>(bytes);
        codes[code.id] = code;
        return {};
      }));
  LF_ASSIGN_OR_RETURN(const std::vector<bool> is_virtual,
                      ReadMarks(store, kVirtualTable, codes.size()));
  for (size_t i = 0; i < is_virtual.size(); ++i) codes[i].is_virtual = is_virtual[i];
  LF_ASSIGN_OR_RETURN(const std::vector<bool> is_left_out,
                      ReadMarks(store, kLeftOutName, codes.size()));
  for (size_t i = 0; i < is_left_out.size(); ++i) {
    codes[i].is_left_out = is_left_out[i];
    if (codes[i].is_left_out && codes[i].bytes > 0)
      return store->settings.Damaged(fmt::format("LF image {} is both encoded and left out", i));
  }
  LF_RETURN_IF_ERROR(FindMissingParts(store, &codes));
  return codes;
}

Result<std::vector<PackedCode>> CodesInStore(const std::filesystem::path& path) {
  LF_ASSIGN_OR_RETURN(OpenedStore store, OpenComplete(path));
  return ReadCodes(&store);
}

Result<std::vector<PackedCode>> FindCodes(const std::filesystem::path& path,
                                          std::span<const std::string> names) {
  LF_ASSIGN_OR_RETURN(OpenedStore store, OpenComplete(path));
  LF_ASSIGN_OR_RETURN(const std::vector<PackedCode> codes, ReadCodes(&store));
  // Merges `names` and the names in the store, both in ascending order, so that no hash table of a
  // million names is needed.
  std::vector<uint32_t> order(names.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return names[a] < names[b]; });
  std::vector<PackedCode> found(names.size());
  size_t next = 0;
  LF_RETURN_IF_ERROR(ForEachRow(store.database, "select name, id from lf_images order by name, id",
                                [&](const Statement& row) -> Result<void> {
                                  LF_ASSIGN_OR_RETURN(const std::string name, row.Text(0));
                                  LF_ASSIGN_OR_RETURN(const int64_t id,
                                                      row.Integer(1, 0, kMostImages));
                                  while (next < order.size() && names[order[next]] < name) ++next;
                                  if (next == order.size() || names[order[next]] != name) return {};
                                  PackedCode& code = found[order[next++]];
                                  if (const auto at = static_cast<size_t>(id); at < codes.size())
                                    code = codes[at];
                                  code.id = static_cast<uint32_t>(id);
                                  return {};
                                }));
  return found;
}

Result<std::vector<PackedCode>> FindCodes(const std::filesystem::path& path,
                                          const LightField& light_field) {
  LF_ASSIGN_OR_RETURN(std::vector<PackedCode> codes, FindCodes(path, light_field.image_names));
  for (size_t i = 0; i < codes.size(); ++i)
    if (codes[i].is_virtual != light_field.cameras[i].is_virtual) codes[i] = {};
  return codes;
}

}  // namespace lf
