// SPDX-License-Identifier: Apache-2.0
// Names of packed stores on web servers, and what a server states about a range of bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "lf/core/result.h"

namespace lf {

// Returns true if the text is a URL of any scheme, such as "https://host/field.lfs". A path that
// begins in this way can be given as "./https://...".
bool IsUrl(std::string_view text);

// kUsage unless the text is a URL that stores are read from: its scheme is http or https, it names
// a host, no user and no password, its path ends in ".lfs", and it has neither blanks nor control
// characters. The message contains no password.
Result<void> CheckStoreUrl(std::string_view url);

// Returns a URL for messages: without what stands before @, after ? or after #, which may be a
// secret.
std::string ShownUrl(std::string_view url);

// Returns the URL of a part of a store, from 0: "https://host/field-r2.lfs?token=x" for part 2 of
// "https://host/field.lfs?token=x". `url` must pass CheckStoreUrl().
std::string PartUrl(std::string_view url, int part);

// Returns the name without extension of the store that a URL names, as a name of a file: "field"
// for "https://host/field.lfs". Letters, digits, and - . _ % are kept.
std::string StemOfUrl(std::string_view url);

// Returns the name of the folder of a store in the cache: its stem and a hash of the URL without
// what stands after ? or #, because a signed URL has another signature each time.
std::string FolderNameOfUrl(std::string_view url);

// The value of the header Content-Range: the bytes [begin, end) of `size`.
struct ContentRange {
  uint64_t begin = 0, end = 0;
  std::optional<uint64_t> size;  // unset: the server does not state it
};
// Returns nullopt unless the text is "bytes FIRST-LAST/SIZE" or "bytes FIRST-LAST/*", with
// FIRST <= LAST < SIZE < 2^62.
std::optional<ContentRange> ParseContentRange(std::string_view text);

}  // namespace lf
