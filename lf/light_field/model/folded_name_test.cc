// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/folded_name.h"

#include <gtest/gtest.h>

namespace lf {
namespace {

TEST(FoldedName, NamesThatLookAlikeAreEqual) {
  EXPECT_EQ(FoldedName("K\u00dcCHE_01"), "k\u00fcche_01");
  EXPECT_EQ(FoldedName("Ku\u0308che_01"), "k\u00fcche_01");
  EXPECT_EQ(FoldedName("\u304c.PNG"), FoldedName("\u304b\u3099.png"));  // ga, and ka with its mark
  EXPECT_EQ(FoldedName("\ud55c"), FoldedName("\u1112\u1161\u11ab"));    // a syllable of Korean
  EXPECT_NE(FoldedName("k\u00fcche"), FoldedName("k\u00f6che"));
  EXPECT_NE(FoldedName("kuche"), FoldedName("k\u00fcche"));
}

TEST(FoldedName, BytesThatAreNotUtf8Stay) {
  EXPECT_EQ(FoldedName("K\xfc"), "k\xfc");
  EXPECT_NE(FoldedName("K\xfc"), FoldedName("K\xf6"));
  EXPECT_EQ(FoldedName(""), "");
}

TEST(FoldedName, DatesBeforeNamesAreTakenOff) {
  EXPECT_EQ(WithoutDate("20210504_img_7"), "img_7");
  EXPECT_EQ(WithoutDate("2021-05-04 img_7"), "img_7");
  EXPECT_EQ(WithoutDate("2021-05-04 12.30.01 img_7"), "img_7");
  EXPECT_EQ(WithoutDate("20210504_123001-img_7"), "img_7");
  for (const char* name : {"", "img_20210504", "20210504", "20210504_", "2021-0504_img",
                           "31210504_img", "0001_img", "20210504img"})
    EXPECT_EQ(WithoutDate(name), name);
}

}  // namespace
}  // namespace lf
