// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/export_json.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

const std::filesystem::path kJsonFile = "f/a.json";

nlohmann::json ParsedJson(std::string_view text) {
  const Result<nlohmann::json> json = ParseExportJson(text, kJsonFile);
  EXPECT_TRUE(json);
  return json ? *json : nlohmann::json();
}

template <class T>
void ExpectJsonError(const Result<T>& result, const std::string& message) {
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, message);
}

TEST(ExportJson, ReadsNumbersThatAreWrittenAsTexts) {
  const nlohmann::json json = ParsedJson(R"({"a": "1.5", "b": 2, "c": ["1", 2, [3, "4"]]})");
  const JsonValue file(json, kJsonFile);
  EXPECT_EQ(*file.NumberAt("a", 0, 9), 1.5);
  EXPECT_EQ(*file.WholeAt("b", 0, 9), 2);
  EXPECT_EQ(*file.NumbersAt("c", 4, 9), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(*file.NumberOr("d", 7, 0, 9), 7);
  EXPECT_EQ(*file.LabelAt("b"), "2");
  EXPECT_EQ(*file.LabelAt("a"), "1.5");
}

TEST(ExportJson, NamesFilePlaceValueAndExpectation) {
  const nlohmann::json json =
      ParsedJson(R"({"shots": {"b.jpg": {"rotation": "north"}}, "n": [1, 2]})");
  const JsonValue file(json, kJsonFile);
  const Result<JsonValue> shot = file.At("shots")->At("b.jpg");
  ASSERT_TRUE(shot);
  ExpectJsonError(shot->NumbersAt("rotation", 3, 10),
                  "f/a.json: shots.b.jpg.rotation is \"north\": expected a list of 3 numbers "
                  "within +-10");
  ExpectJsonError(shot->At("camera"), "f/a.json: shots.b.jpg has no key \"camera\"");
  ExpectJsonError(file.NumbersAt("n", 3, 10),
                  "f/a.json: n is [1,2]: expected a list of 3 numbers within +-10");
  ExpectJsonError(file.At("n")->Entries()->at(1).Whole(3, 4),
                  "f/a.json: n[1] is 2: expected a whole number from 3 to 4");
  ExpectJsonError(file.Entries(), "f/a.json: the file is an object: expected a list");
  ExpectJsonError(file.TextAt("n"), "f/a.json: n is [1,2]: expected a text in quotes");
}

TEST(ExportJson, ReadsNoNumberThatIsNone) {
  const nlohmann::json json = ParsedJson(R"({"a": NaN, "b": "1e999", "c": true, "d": null})");
  const JsonValue file(json, kJsonFile);
  EXPECT_FALSE(file.NumberAt("a", -1e9, 1e9));
  EXPECT_FALSE(file.NumberAt("b", -1e9, 1e9));
  EXPECT_FALSE(file.NumberAt("c", -1e9, 1e9));
  EXPECT_FALSE(file.Has("d"));
  EXPECT_FALSE(ParseExportJson("{\"a\":", kJsonFile));
  EXPECT_FALSE(ParseExportJson("", kJsonFile));
}

TEST(ExportJson, LeavesOutWhatNobodyReads) {
  const Result<nlohmann::json> json =
      ParseExportJson("\xEF\xBB\xBF{\"a\": 1, \"points\": [1, 2], \"b\": [{\"points\": {}}]}",
                      kJsonFile, {"points"});
  ASSERT_TRUE(json);
  EXPECT_EQ(json->dump(), R"({"a":1,"b":[{}]})");
}

}  // namespace
}  // namespace lf
