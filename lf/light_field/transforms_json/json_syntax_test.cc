// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/json_syntax.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <string>

#include "lf/core/file.h"
#include "lf/light_field/transforms_json/transforms_json.h"
#include "lf/pixels/files/test_folder.h"

namespace lf {
namespace {

std::string SyntaxErrorOf(std::string_view text) {
  ByteStream stream(text, "a.json");
  return JsonSyntaxError(&stream).message;
}

TEST(JsonSyntax, ErrorsNameLineColumnAndWhatIsWrong) {
  EXPECT_EQ(
      SyntaxErrorOf("{\n \"a\": [1,\n  2 3]}"),
      "a.json: is not JSON: parse error at line 3, column 5: syntax error while parsing array "
      "- unexpected number literal; expected ']'");
  EXPECT_EQ(SyntaxErrorOf("{\"a\": 1e999}").find("a.json: is not JSON: number overflow"), 0u);
}

TEST(JsonSyntax, UsualMistakesAreNamed) {
  const auto advice = [](std::string_view text) {
    const std::string message = SyntaxErrorOf(text);
    return message.substr(std::min(message.size(), message.rfind("; ")));
  };
  EXPECT_EQ(advice("{\"frames\": [1, 2,]}"), "; is there a comma too many before it?");
  EXPECT_EQ(advice("{\"w\": 1, }"), "; is there a comma too many before it?");
  EXPECT_EQ(advice("[0, NaN, 1]").find("; NaN is no number of JSON"), 0u);
  EXPECT_EQ(advice("[NaN]").find("; NaN is no number of JSON"), 0u);
  EXPECT_EQ(advice(""), "; the file is empty");
  EXPECT_EQ(advice("\xff\xfe{"), "; it has to be text in UTF-8 that begins with {");
}

TEST(JsonSyntax, ANulByteIsNotTheEndOfTheText) {
  using namespace std::string_view_literals;
  EXPECT_EQ(SyntaxErrorOf("\0\0{}"sv).find("a.json: is not JSON: byte 1 is a NUL byte"), 0u);
  EXPECT_EQ(SyntaxErrorOf("{\"a\": \0 1}"sv).find("a.json: is not JSON: byte 7 is a NUL byte"), 0u);
}

TEST(JsonSyntax, NestingTakesNoMemory) {
  EXPECT_NE(SyntaxErrorOf(std::string(1'000'000, '[')).find("column 1000001"), std::string::npos);
}

TEST(JsonSyntax, AFileThatIsJsonNowHasChanged) {
  EXPECT_EQ(SyntaxErrorOf("{}"),
            "a.json: changed while it was read; try again when no other program writes it");
}

class HugeFileTest : public FolderTest {};

TEST_F(HugeFileTest, IsRefusedAtTheFirstByteThatIsNotJson) {
  for (const char* beginning : {"", " \n", "{\"w\": 8, \"frames\": [{\"file_path\": \"a"}) {
    const std::filesystem::path file = folder_ / "transforms.json";
    ASSERT_TRUE(WriteFileAtomically(file, beginning));
    std::filesystem::resize_file(file, uint64_t{4} << 30);  // a hole, which is read as NUL bytes
    const std::clock_t begin = std::clock();
    const Result<LightField> read = ReadTransformsJson(file);
    EXPECT_LT(std::clock() - begin, 2 * CLOCKS_PER_SEC);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().kind, ErrorKind::kInput);
    EXPECT_NE(read.error().message.find("is not JSON"), std::string::npos) << read.error().message;
    std::filesystem::resize_file(file, uint64_t{8} << 30);
    EXPECT_NE(ReadTransformsJson(file).error().message.find("has 8589934592 bytes"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace lf
