// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/remote/store_url.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "lf/core/check.h"
#include "lf/core/hash.h"

namespace lf {
namespace {

constexpr std::string_view kSchemeEnd = "://";
constexpr std::string_view kStoreEnd = ".lfs";
constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

bool IsIn(std::string_view letters, char letter) {
  return letters.find(letter) != std::string_view::npos;
}

std::string_view BeforeQuery(std::string_view url) {
  return url.substr(0, url.find_first_of("?#"));
}

std::string_view SchemeOf(std::string_view url) { return url.substr(0, url.find(kSchemeEnd)); }

// Returns what stands between :// and the first slash.
std::string_view AuthorityOf(std::string_view url) {
  const std::string_view rest = BeforeQuery(url).substr(SchemeOf(url).size() + kSchemeEnd.size());
  return rest.substr(0, rest.find_first_of("/\\"));
}

bool IsScheme(std::string_view scheme, std::string_view expected) {
  const auto is_equal = [](char a, char b) { return (a | 0x20) == b; };
  return std::equal(scheme.begin(), scheme.end(), expected.begin(), expected.end(), is_equal);
}

// Takes a number from the beginning of a text.
std::optional<uint64_t> TakeNumber(std::string_view* text) {
  constexpr uint64_t kMost = uint64_t{1} << 62;
  uint64_t number = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), number);
  if (error != std::errc() || number >= kMost) return std::nullopt;
  text->remove_prefix(static_cast<size_t>(end - text->data()));
  return number;
}

bool TakeLetter(char letter, std::string_view* text) {
  if (!text->starts_with(letter)) return false;
  text->remove_prefix(1);
  return true;
}

}  // namespace

bool IsUrl(std::string_view text) {
  const size_t end = text.find(kSchemeEnd);
  if (end == std::string_view::npos || end == 0 || !IsIn(kLetters, text[0])) return false;
  return std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), [](char c) {
    return IsIn(kLetters, c) || IsIn(kDigits, c) || IsIn("+-.", c);
  });
}

Result<void> CheckStoreUrl(std::string_view url) {
  const auto refuse = [&](std::string_view why) {
    return UsageError(fmt::format("{}: {}", ShownUrl(url), why));
  };
  if (!IsUrl(url)) return refuse("is no URL");
  if (!IsScheme(SchemeOf(url), "http") && !IsScheme(SchemeOf(url), "https"))
    return refuse(
        "light fields are read from URLs that begin with https:// or http://, and no others");
  if (std::any_of(url.begin(), url.end(), [](char c) { return c >= 0 && (c <= ' ' || c == 0x7f); }))
    return refuse("a URL has no blanks and no control characters: write a blank as %20");
  if (AuthorityOf(url).find('@') != std::string_view::npos)
    return refuse(
        "a user or password in a URL would be written into jobs and reports: write them into the "
        "file .netrc of your home folder instead");
  if (AuthorityOf(url).empty()) return refuse("names no host");
  if (!BeforeQuery(url).ends_with(kStoreEnd) || BeforeQuery(url).ends_with("/.lfs"))
    return refuse(
        "is not the URL of a packed store, whose name ends in .lfs: light fields of other forms "
        "are read from local files only");
  return {};
}

std::string ShownUrl(std::string_view url) {
  const std::string_view shown = BeforeQuery(url);
  if (!IsUrl(shown)) return std::string(shown);
  const std::string_view rest = shown.substr(SchemeOf(shown).size() + kSchemeEnd.size());
  // Without a path, it may be the beginning of a password with a question mark.
  if (shown.size() < url.size() && rest.find('/') == std::string_view::npos)
    return fmt::format("{}{}...", SchemeOf(shown), kSchemeEnd);
  // A password may contain a slash: everything up to the last @ is dropped.
  const size_t at = rest.rfind('@');
  return fmt::format("{}{}{}", SchemeOf(shown), kSchemeEnd,
                     at == std::string_view::npos ? rest : rest.substr(at + 1));
}

std::string PartUrl(std::string_view url, int part) {
  const std::string_view path = BeforeQuery(url);
  LF_CHECK(path.ends_with(kStoreEnd));
  return fmt::format("{}-r{}{}{}", path.substr(0, path.size() - kStoreEnd.size()), part, kStoreEnd,
                     url.substr(path.size()));
}

std::string StemOfUrl(std::string_view url) {
  constexpr size_t kMostLetters = 100;
  const std::string_view path = BeforeQuery(url);
  std::string stem(path.substr(path.find_last_of("/\\") + 1));
  if (stem.ends_with(kStoreEnd)) stem.resize(stem.size() - kStoreEnd.size());
  stem.resize(std::min(stem.size(), kMostLetters));
  for (char& letter : stem)
    if (!IsIn(kLetters, letter) && !IsIn(kDigits, letter) && !IsIn("-._%", letter)) letter = '_';
  if (stem.empty() || stem[0] == '.' || stem[0] == '-') stem.insert(0, "_");
  return stem;
}

std::string FolderNameOfUrl(std::string_view url) {
  return fmt::format("{}-{:016x}", StemOfUrl(url), HashBytes(BeforeQuery(url)));
}

std::optional<ContentRange> ParseContentRange(std::string_view text) {
  constexpr std::string_view kUnit = "bytes ";
  if (!text.starts_with(kUnit)) return std::nullopt;
  text.remove_prefix(kUnit.size());
  const std::optional<uint64_t> first = TakeNumber(&text);
  if (!first || !TakeLetter('-', &text)) return std::nullopt;
  const std::optional<uint64_t> last = TakeNumber(&text);
  if (!last || *last < *first || !TakeLetter('/', &text)) return std::nullopt;
  ContentRange range = {*first, *last + 1, std::nullopt};
  if (text == "*") return range;
  range.size = TakeNumber(&text);
  if (!range.size || !text.empty() || *range.size < range.end) return std::nullopt;
  return range;
}

}  // namespace lf
