#include "lf/native/json_syntax.h"

#include <gtest/gtest.h>

#include <string>

namespace lf {
namespace {

std::string ErrorOf(std::string_view text) {
  ByteStream stream(text, "a.json");
  return JsonSyntaxError(&stream).message;
}

TEST(JsonSyntax, ErrorsNameLineColumnAndWhatIsWrong) {
  EXPECT_EQ(
      ErrorOf("{\n \"a\": [1,\n  2 3]}"),
      "a.json: is not JSON: parse error at line 3, column 5: syntax error while parsing array "
      "- unexpected number literal; expected ']'");
  EXPECT_EQ(ErrorOf("{\"a\": 1e999}").find("a.json: is not JSON: number overflow"), 0u);
}

TEST(JsonSyntax, NestingTakesNoMemory) {
  EXPECT_NE(ErrorOf(std::string(1'000'000, '[')).find("column 1000001"), std::string::npos);
}

TEST(JsonSyntax, AFileThatIsJsonNowHasChanged) {
  EXPECT_EQ(ErrorOf("{}"), "a.json: changed while it was read");
}

}  // namespace
}  // namespace lf
