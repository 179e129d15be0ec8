// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/reference_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/reference_rows.h"
#include "lf/storage/packed/store_codes.h"

namespace lf {
namespace {

// Returns the column `reference_ids`: each id in 4 bytes, the least significant first.
std::string TextOfIds(std::span<const uint32_t> ids) {
  std::string text;
  for (const uint32_t id : ids)
    for (int byte = 0; byte < 4; ++byte) text += static_cast<char>(id >> (8 * byte) & 255);
  return text;
}

// Returns the ids that the column states; nullopt if it has none, too many, or a part of one.
std::optional<std::vector<uint32_t>> IdsOfText(std::string_view text) {
  if (text.empty() || text.size() % 4 != 0 || text.size() > 4 * kMostReferenceIds)
    return std::nullopt;
  std::vector<uint32_t> ids(text.size() / 4);
  for (size_t i = 0; i < text.size(); ++i)
    ids[i / 4] |= uint32_t{static_cast<unsigned char>(text[i])} << (8 * (i % 4));
  return ids;
}

// Calls row(id, references) for each predicted LF image, ascending. kInput: a row is damaged.
template <class Row>
Result<void> ForEachPredicted(const Settings& settings, size_t image_count, Database* database,
                              const Row& row) {
  int64_t next =
      0;  // smallest id that the next row may have; in a damaged file rows may not ascend
  return ForEachRow(
      *database, fmt::format("select id, reference_ids from {} order by id", kPredictedName),
      [&](const Statement& statement) -> Result<void> {
        LF_ASSIGN_OR_RETURN(const int64_t id, statement.Integer(0));
        if (id < next || id >= static_cast<int64_t>(image_count))
          return settings.Damaged(fmt::format(
              "it has reference images of LF image {}, which it lacks or has twice", id));
        next = id + 1;
        LF_ASSIGN_OR_RETURN(const std::string_view text, statement.Blob(1));
        std::optional<std::vector<uint32_t>> references = IdsOfText(text);
        if (!references)
          return settings.Damaged(
              fmt::format("LF image {} is predicted from none or more than {} reference images", id,
                          kMostReferenceIds));
        return row(static_cast<uint32_t>(id), *std::move(references));
      });
}

// Adds to `found` all LF images that are needed for those in it, until there are more than
// kMostNeededImages. Returns false if there are more.
//   references_of(id)  returns the reference images of an LF image
template <class ReferencesOf>
bool FindNeeded(const ReferencesOf& references_of, std::vector<uint32_t>* found) {
  for (size_t i = 0; i < found->size(); ++i)
    for (const uint32_t reference : references_of((*found)[i])) {
      if (std::find(found->begin(), found->end(), reference) != found->end()) continue;
      if (found->size() == kMostNeededImages) return false;
      found->push_back(reference);
    }
  return true;
}

}  // namespace

// Makes tables, and checks them.
class ReferenceTableBuilder {
 public:
  explicit ReferenceTableBuilder(size_t image_count) {
    table_.is_reference_.resize(image_count);
    table_.begins_.reserve(image_count + 1);
  }

  // Adds the reference images, which are ids of the store, of a predicted LF image. Ids ascend.
  void Add(uint32_t id, std::span<const uint32_t> references) {
    FillUpTo(id);
    for (const uint32_t reference : references) table_.is_reference_[reference] = true;
    table_.ids_.insert(table_.ids_.end(), references.begin(), references.end());
    ++table_.predicted_count_;
  }
  ReferenceTable Finish() {
    FillUpTo(table_.is_reference_.size());
    return std::move(table_);
  }

 private:
  void FillUpTo(size_t id) {
    while (table_.begins_.size() <= id)
      table_.begins_.push_back(static_cast<uint32_t>(table_.ids_.size()));
  }
  ReferenceTable table_;
};

std::vector<uint32_t> ReferenceTable::NeededBy(uint32_t id) const {
  // The depth of the search is limited, because an LF image needs at most kMostNeededImages.
  std::vector<uint32_t> needed;
  const auto visit = [&](const auto& self, uint32_t image) -> void {
    for (const uint32_t reference : Of(image))
      if (std::find(needed.begin(), needed.end(), reference) == needed.end()) self(self, reference);
    needed.push_back(image);
  };
  visit(visit, id);
  return needed;
}

Result<ReferenceTable> ReadReferences(OpenedStore* store) {
  LF_ASSIGN_OR_RETURN(const bool is_there, HasTable(&store->database, kPredictedName));
  if (!is_there) return ReferenceTable();
  const Settings& settings = store->settings;
  LF_ASSIGN_OR_RETURN(const std::vector<PackedCode> codes, ReadCodes(store));
  const auto has_numbers = [&](uint32_t id) {
    return id < codes.size() && codes[id].bytes > 0 && codes[id].values != StoredValues::kFile;
  };
  ReferenceTableBuilder builder(codes.size());
  LF_RETURN_IF_ERROR(ForEachPredicted(
      settings, codes.size(), &store->database,
      [&](uint32_t id, const std::vector<uint32_t>& references) -> Result<void> {
        if (!has_numbers(id))
          return settings.Damaged(
              fmt::format("LF image {} is predicted from others, but has no encoded numbers", id));
        for (const uint32_t reference : references)
          if (!has_numbers(reference))
            return settings.Damaged(fmt::format(
                "LF image {} is predicted from LF image {}, which has no encoded numbers", id,
                reference));
        builder.Add(id, references);
        return {};
      }));
  ReferenceTable table = builder.Finish();
  for (uint32_t id = 0; id < codes.size(); ++id) {
    const std::span<const uint32_t> references = table.Of(id);
    std::vector<uint32_t> needed(references.begin(), references.end());
    if (!FindNeeded([&](uint32_t image) { return table.Of(image); }, &needed))
      return settings.Damaged(fmt::format(
          "LF image {} is predicted from more than {} LF images, directly or through others", id,
          kMostNeededImages));
    if (std::find(needed.begin(), needed.end(), id) != needed.end())
      return settings.Damaged(
          fmt::format("LF image {} is predicted from itself, directly or through others", id));
  }
  return table;
}

Result<ReferenceTable> ReadReferences(const std::filesystem::path& path) {
  LF_ASSIGN_OR_RETURN(OpenedStore store, OpenComplete(path));
  return ReadReferences(&store);
}

Result<ReferenceRows> ReferenceRows::Open(const Settings& settings, const std::vector<bool>& has,
                                          Database* database) {
  LF_ASSIGN_OR_RETURN(Statement insert, database->Prepare(fmt::format(
                                            "insert into {} values (?, ?)", kPredictedName)));
  ReferenceRows rows(std::move(insert));
  LF_RETURN_IF_ERROR(ForEachPredicted(
      settings, has.size(), database,
      [&](uint32_t id, std::vector<uint32_t> references) -> Result<void> {
        const bool is_whole =
            has[id] && std::all_of(references.begin(), references.end(), [&](uint32_t reference) {
              return reference < has.size() && has[reference];
            });
        if (!is_whole)
          return settings.Damaged(
              fmt::format("it lacks LF image {}, or one that it is predicted from", id));
        rows.references_[id] = std::move(references);
        return {};
      }));
  return rows;
}

bool ReferenceRows::Allows(std::span<const LfImageId> references) const {
  if (references.size() > kMostReferenceIds) return false;
  std::vector<uint32_t> needed;
  for (const LfImageId reference : references) needed.push_back(reference.value);
  const auto references_of = [this](uint32_t id) -> std::span<const uint32_t> {
    const auto found = references_.find(id);
    if (found == references_.end()) return {};
    return found->second;
  };
  return FindNeeded(references_of, &needed);
}

Result<void> ReferenceRows::Insert(LfImageId id, std::span<const LfImageId> references) {
  std::vector<uint32_t> ids;
  for (const LfImageId reference : references) ids.push_back(reference.value);
  insert_.Bind(0, int64_t{id.value}).BindBlob(1, TextOfIds(ids));
  LF_RETURN_IF_ERROR(insert_.Run());
  references_[id.value] = std::move(ids);
  return {};
}

}  // namespace lf
