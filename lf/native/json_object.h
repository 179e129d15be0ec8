// One object {...} of a JSON text, parsed fast. For the readers of calibrations.
#pragma once

#include <memory>
#include <string>

namespace simdjson::dom {
class object;
class parser;
}  // namespace simdjson::dom

namespace lf {

// JSON is what nlohmann's parser takes for it. simdjson parses; what it takes another way (numbers
// beyond 64 bits, halves of surrogates, deep nesting) nlohmann writes anew for it.
class JsonObject {
 public:
  // {}
  JsonObject();
  ~JsonObject();
  JsonObject(const JsonObject&) = delete;
  JsonObject& operator=(const JsonObject&) = delete;

  // Forgets what it held. False, and {}, if `text` is not JSON or no object. What lies deeper than
  // 1024 brackets may be missing afterwards. Numbers are rounded correctly.
  bool Parse(const std::string& text);

  // Of several equal keys the last one counts.
  const simdjson::dom::object& object() const { return *object_; }

 private:
  bool ParseFast(const std::string& text);

  // Its memory serves every text.
  std::unique_ptr<simdjson::dom::parser> parser_;
  std::unique_ptr<simdjson::dom::object> object_;
};

}  // namespace lf
