// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/edit_json.h"

#include <set>
#include <utility>

namespace lf {

using Json = nlohmann::ordered_json;

namespace {

// The parser calls one of these functions for each token. A function that returns false ends the
// parse.
class EditReader : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return Keep(nullptr); }
  bool boolean(bool value) override { return Keep(value); }
  bool number_integer(number_integer_t value) override { return Keep(value); }
  bool number_unsigned(number_unsigned_t value) override { return Keep(value); }
  bool number_float(number_float_t value, const string_t&) override { return Keep(value); }
  bool string(string_t& value) override { return Keep(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // does not occur in JSON
  bool start_object(size_t) override {
    if (!edit.is_null()) return false;
    edit = Json::object();
    return true;
  }
  bool key(string_t& name) override {
    static const std::set<std::string> kKeys = {"text",  "expected",  "force",    "frame",
                                                "path",  "x",         "y",        "camera",
                                                "width", "budget_ms", "recorded", "images"};
    key_ = kKeys.contains(name) ? std::move(name) : std::string();
    return true;
  }
  bool end_object() override { return true; }
  bool start_array(size_t) override { return false; }
  bool end_array() override { return false; }
  bool parse_error(size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

  Json edit;

 private:
  bool Keep(Json value) {
    if (!edit.is_object()) return false;
    if (!key_.empty()) edit[key_] = std::move(value);
    return true;
  }

  std::string key_;  // the key that was read last; empty if no edit has this key
};

}  // namespace

Json ReadEdit(const std::string& text) {
  EditReader reader;
  if (!Json::sax_parse(text, &reader)) return nullptr;
  return std::move(reader.edit);
}

}  // namespace lf
