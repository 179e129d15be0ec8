// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/folded_name.h"

#include <unicode/bytestream.h>
#include <unicode/normalizer2.h>
#include <unicode/unistr.h>

#include <algorithm>
#include <cctype>
#include <regex>

namespace lf {
namespace {

bool IsAscii(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

std::string LowerAscii(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

}  // namespace

std::string FoldedName(std::string_view name) {
  if (IsAscii(name)) return LowerAscii(name);
  const icu::StringPiece piece(name.data(), static_cast<int32_t>(name.size()));
  icu::UnicodeString text = icu::UnicodeString::fromUTF8(piece);
  std::string unchanged;
  // Bytes that are not UTF-8 have become another character.
  if (text.toUTF8String(unchanged) != name) return LowerAscii(name);
  UErrorCode code = U_ZERO_ERROR;
  const icu::Normalizer2* const form_c = icu::Normalizer2::getNFCInstance(code);
  if (U_FAILURE(code)) return LowerAscii(name);
  const icu::UnicodeString folded = form_c->normalize(text.foldCase(), code);
  std::string result;
  return U_SUCCESS(code) ? folded.toUTF8String(result) : LowerAscii(name);
}

std::string WithoutDate(const std::string& name) {
  static const std::regex date(
      R"((?:19|20)\d\d([-_.]?)\d\d\1\d\d(?:[-_tT ]\d\d([-_.]?)\d\d\2\d\d)?[-_ ]+([^]+))");
  constexpr size_t kLongest = 255;  // of a file name, in bytes; the expression is slow for more
  std::smatch match;
  if (name.size() > kLongest || !std::regex_match(name, match, date)) return name;
  return match[3];
}

}  // namespace lf
