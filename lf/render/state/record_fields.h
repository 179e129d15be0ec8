// SPDX-License-Identifier: Apache-2.0
// Reads values from our own JSON files (reports, jobs), which may be damaged. To be included only
// by sources that need nlohmann's JSON in any case.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/version.h"
#include "lf/render/state/run_inputs.h"

namespace lf {

using Json = nlohmann::ordered_json;

// Returns true if the text is UTF-8, which JSON requires. Names of files may have any bytes.
inline bool IsUtf8(const std::string& text) {
  try {
    return !Json(text).dump().empty();
  } catch (const Json::exception&) {
    return false;
  }
}

// Returns the JSON of a name that is read again by RecordFields::Get(), to the byte: the text or,
// if it is not UTF-8, {"bytes": "61ff62"} with two hexadecimal digits for each byte.
inline Json NameToJson(const std::string& name) {
  if (IsUtf8(name)) return name;
  std::string digits;
  for (const char c : name) digits += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return {{"bytes", digits}};
}

// Returns the name that NameToJson() has written, or the text of a JSON text; nullopt for any other
// JSON.
inline std::optional<std::string> NameFromJson(const Json& json) {
  if (json.is_string()) return json.get<std::string>();
  if (!json.is_object() || json.size() != 1 || !json.contains("bytes") ||
      !json["bytes"].is_string())
    return std::nullopt;
  const std::string digits = json["bytes"].get<std::string>();
  std::string name;
  for (size_t i = 0; i < digits.size(); i += 2) {
    unsigned char byte = 0;
    const char* const end = digits.data() + std::min(i + 2, digits.size());
    const auto [rest, error] = std::from_chars(digits.data() + i, end, byte, 16);
    if (error != std::errc() || rest != digits.data() + i + 2) return std::nullopt;
    name += static_cast<char>(byte);
  }
  return name;
}

// Reads values of a JSON object by their keys. Get() leaves `value` unchanged if the key is missing
// or the type is wrong; but if an item of a list or object has a wrong type, the items before it
// are read. `fault` receives a description of the first wrong type.
class RecordFields {
 public:
  RecordFields(const Json& object, std::string* fault) : object_(object), fault_(*fault) {
    if (!object.is_object()) Complain("", "an object");
  }

  void Get(const char* key, double* value) {
    if (const Json* json = Find(key)) {
      if (json->is_number())
        *value = json->get<double>();
      else
        Complain(key, "a number");
    }
  }
  template <class Integer>
  void Get(const char* key, Integer* value) {
    if (const Json* json = Find(key)) {
      if (json->is_number_unsigned() &&
          json->get<uint64_t>() <= std::numeric_limits<Integer>::max())
        *value = static_cast<Integer>(json->get<uint64_t>());
      else
        Complain(key, "a whole number");
    }
  }
  // Reads a text or a name (NameToJson()).
  void Get(const char* key, std::string* value) {
    if (const Json* json = Find(key)) {
      if (const auto name = NameFromJson(*json))
        *value = *name;
      else
        Complain(key, "text");
    }
  }
  void Get(const char* key, std::array<uint64_t, 3>* values) {
    const Json* json = Find(key);
    if (json == nullptr) return;
    if (!json->is_array() || json->size() != 3) return Complain(key, "three numbers");
    for (size_t i = 0; i < 3; ++i) {
      if (!(*json)[i].is_number_unsigned()) return Complain(key, "three whole numbers");
      (*values)[i] = (*json)[i].get<uint64_t>();
    }
  }
  void Get(const char* key, RunInputs* inputs) {
    const Json* json = Find(key);
    if (json == nullptr) return;
    if (!json->is_object()) return Complain(key, "an object");
    for (const auto& [name, value] : json->items()) {
      if (!value.is_string()) return Complain(key, "texts");
      inputs->emplace_back(name, value.get<std::string>());
    }
  }
  void Get(const char* key, bool* value) {
    if (const Json* json = Find(key)) {
      if (json->is_boolean())
        *value = json->get<bool>();
      else
        Complain(key, "true or false");
    }
  }
  void Get(const char* key, std::vector<std::string>* values) {
    for (const Json* item : List(key)) {
      const std::optional<std::string> name = NameFromJson(*item);
      if (!name) return Complain(key, "a list of texts");
      values->push_back(*name);
    }
  }
  // Returns the items of a list; empty if the key is missing or its value is no list.
  std::vector<const Json*> List(const char* key) {
    std::vector<const Json*> list;
    const Json* json = Find(key);
    if (json == nullptr) return list;
    if (!json->is_array()) {
      Complain(key, "a list");
      return list;
    }
    for (const Json& item : *json) list.push_back(&item);
    return list;
  }
  const Json* Find(const char* key) const {
    if (!object_.is_object()) return nullptr;
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }

 private:
  void Complain(const std::string& key, const char* expected) {
    if (fault_.empty()) fault_ = fmt::format("\"{}\": expected {}", key, expected);
  }

  const Json& object_;
  std::string& fault_;
};

// Returns the JSON object in a text, if the value of its key "format" is `format`. Otherwise
// returns an empty object and sets `fault` to the reason.
inline Json ParseRecord(std::string_view text, const char* format, std::string* fault) {
  Json json = Json::parse(text, nullptr, false);
  std::string found;
  if (json.is_discarded())
    *fault = "the text is no JSON, or is cut off";
  else
    RecordFields(json, fault).Get("format", &found);
  if (fault->empty() && found != format) {
    // The formats have versions of one digit.
    const std::string_view expected = format;
    const bool is_earlier = found.size() == expected.size() && found < expected &&
                            found.starts_with(expected.substr(0, expected.size() - 1));
    *fault = fmt::format("\"format\": expected \"{}\", found \"{}\"{}", format, found,
                         is_earlier ? fmt::format(", which {} read", kBuildsOfEarlierFiles) : "");
  }
  return fault->empty() ? std::move(json) : Json::object();
}

// Returns the text of a JSON value. Bytes that are not UTF-8 are replaced by U+FFFD, because names
// may have any bytes: reports are for people, and no program uses their names again. A name that is
// used again is written by NameToJson().
inline std::string RecordText(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

// Returns the text of a JSON value on one line, without a newline at its end. Like RecordText(),
// replaces bytes that are not UTF-8. Both functions write infinity as null.
inline std::string RecordLine(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace lf
