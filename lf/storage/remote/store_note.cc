// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/remote/store_note.h"

#include <fmt/format.h>

#include <charconv>
#include <system_error>

#include "lf/core/file.h"
#include "lf/storage/remote/store_url.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Takes the line "KEY VALUE" from the beginning of a text.
std::optional<std::string_view> TakeLine(std::string_view key, std::string_view* text) {
  const size_t end = text->find('\n');
  if (end == std::string_view::npos || end < key.size() + 1 || !text->starts_with(key) ||
      (*text)[key.size()] != ' ')
    return std::nullopt;
  const std::string_view value = text->substr(key.size() + 1, end - key.size() - 1);
  text->remove_prefix(end + 1);
  return value;
}

}  // namespace

std::optional<StoreNote> ParseStoreNote(std::string_view text) {
  const auto url = TakeLine("url", &text);
  const auto validator = url ? TakeLine("validator", &text) : std::nullopt;
  const auto size = validator ? TakeLine("size", &text) : std::nullopt;
  if (!size || !text.empty() || !CheckStoreUrl(*url)) return std::nullopt;
  StoreNote note = {std::string(*url), std::string(*validator), 0};
  const char* const size_end = size->data() + size->size();
  const auto [end, error] = std::from_chars(size->data(), size_end, note.size_bytes);
  if (error != std::errc() || end != size_end) return std::nullopt;
  return note;
}

std::string TextOf(const StoreNote& note) {
  return fmt::format("url {}\nvalidator {}\nsize {}\n", note.url, note.validator, note.size_bytes);
}

fs::path NotePath(const fs::path& store) { return fs::path(store) += ".url"; }

Result<std::optional<StoreNote>> ReadStoreNote(const fs::path& store) {
  constexpr size_t kMostBytes = 1 << 20;
  const fs::path path = NotePath(store);
  std::error_code error;
  if (fs::symlink_status(path, error).type() == fs::file_type::not_found)
    return std::optional<StoreNote>();
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path, kMostBytes));
  std::optional<StoreNote> note = ParseStoreNote(text);
  if (!note)
    return InputError(fmt::format(
        "{}: is damaged: expected the lines url, validator and size, with the URL of a packed "
        "store: remove the folder, and give the URL again",
        path.string()));
  return note;
}

Result<void> WriteStoreNote(const fs::path& store, const StoreNote& note) {
  return WriteFileAtomically(NotePath(store), TextOf(note));
}

}  // namespace lf
