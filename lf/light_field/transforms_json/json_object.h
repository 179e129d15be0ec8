// Parses one object {...} of a JSON text, fast. For the readers of calibrations.
#pragma once

#include <memory>
#include <string>

namespace simdjson::dom {
class object;
class parser;
}  // namespace simdjson::dom

namespace lf {

// Accepts as JSON what nlohmann's parser accepts. simdjson parses it. Texts that simdjson treats
// differently (numbers beyond 64 bits, unpaired surrogates, deep nesting) are first rewritten by
// nlohmann's library.
class JsonObject {
 public:
  // An empty object, {}.
  JsonObject();
  ~JsonObject();
  JsonObject(const JsonObject&) = delete;
  JsonObject& operator=(const JsonObject&) = delete;

  // Replaces the content. Returns false, and holds {}, if `text` is not JSON or not an object.
  // Content below 1024 nested brackets may be lost. Numbers are rounded correctly.
  bool Parse(const std::string& text);

  // If a key occurs several times, the last one is valid.
  const simdjson::dom::object& object() const { return *object_; }

 private:
  bool ParseFast(const std::string& text);

  // Reused for every text, so that memory is allocated once.
  std::unique_ptr<simdjson::dom::parser> parser_;
  std::unique_ptr<simdjson::dom::object> object_;
};

}  // namespace lf
