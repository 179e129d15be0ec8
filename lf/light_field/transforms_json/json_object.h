// SPDX-License-Identifier: Apache-2.0
// Parses one object {...} of a JSON text fast. Used by the readers of calibrations and camera
// paths.
#pragma once

#include <memory>
#include <string>

namespace simdjson::dom {
class object;
class parser;
}  // namespace simdjson::dom

namespace lf {

// Accepts as JSON exactly what nlohmann's parser accepts, but parses with the faster simdjson. A
// text that simdjson may treat differently (numbers beyond 64 bits, unpaired surrogates, deep
// nesting) is first rewritten by nlohmann's library.
class JsonObject {
 public:
  // Creates the empty object {}.
  JsonObject();
  ~JsonObject();
  JsonObject(const JsonObject&) = delete;
  JsonObject& operator=(const JsonObject&) = delete;

  // Replaces the content. If `text` is not JSON or not an object, the content becomes {}, and false
  // is returned. Values inside more than 1000 nested brackets may be lost. Numbers are rounded
  // correctly.
  bool Parse(const std::string& text);

  // If a key occurs several times, the last one counts.
  const simdjson::dom::object& object() const { return *object_; }

 private:
  bool ParseFast(const std::string& text);

  // The parser is reused for every text, so that memory is allocated once.
  std::unique_ptr<simdjson::dom::parser> parser_;
  std::unique_ptr<simdjson::dom::object> object_;
};

}  // namespace lf
