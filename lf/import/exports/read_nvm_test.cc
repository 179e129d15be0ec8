// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_nvm.h"

#include "lf/import/exports/test_exports.h"

namespace lf {
namespace {

const std::string kNvm = R"(NVM_V3

1
a"b.jpg	100 0.70710678118654757 0 0 -0.70710678118654757 1 2 3 0 0

0
)";

Result<ExportedCameras> ParseNvmModel(const std::string& text) { return ParseNvm(text, "f/a.nvm"); }

TEST(Nvm, ReadsCentreAndQuaternion) {
  const Result<ExportedCameras> cameras = ParseNvmModel(kNvm);
  ASSERT_TRUE(cameras) << cameras.error().message;
  ASSERT_EQ(cameras->images.size(), 1u);
  EXPECT_EQ(cameras->images[0].name, "a b.jpg");
  EXPECT_TRUE(cameras->counts_from_middle);
  ExpectNear(PixelOf(cameras->images[0], {1, 3, 5}), {50, 0});
}

TEST(Nvm, InvertsTheDistortion) {
  for (const double r : {-0.1, -0.02, 0.02, 0.1}) {
    const DistortionMap map(InverseOfNvmRadial(r));
    for (const double distorted : {0.0, 0.1, 0.3, 0.5}) {
      const std::optional<Vec2> found =
          map.Distort({distorted * (1 + r * distorted * distorted), 0, 1});
      ASSERT_TRUE(found.has_value());
      EXPECT_NEAR(found->x(), distorted, 2e-8) << r;
    }
  }
}

TEST(Nvm, NamesWhatIsWrong) {
  ExpectFault(ParseNvmModel(Replaced(kNvm, "NVM_V3", "NVM_V2")),
              "\"NVM_V2\": expected the first word");
  ExpectFault(ParseNvmModel(Replaced(kNvm, "NVM_V3", "NVM_V3 Free")), "\"Free\": expected FixedK");
  ExpectFault(ParseNvmModel(Replaced(kNvm, "1\na", "0\na")), "the number of cameras is 0");
  ExpectFault(ParseNvmModel(Replaced(kNvm, "0.70710678118654757", "0.9")), "has the length");
  ExpectFault(ParseNvmModel(Replaced(kNvm, "1 2 3", "1 inf 3")), "the position");
  ExpectFault(ParseNvmModel("NVM_V3\n\n2\na.jpg 100"), "the file ends before the rotation");
  ExpectFault(ParseNvmModel(""), "the file ends before NVM_V3");
}

}  // namespace
}  // namespace lf
