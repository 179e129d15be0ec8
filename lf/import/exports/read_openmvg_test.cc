// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_openmvg.h"

#include "lf/import/exports/test_exports.h"

namespace lf {
namespace {

const std::string kMvg = R"({"sfm_data_version": "0.3", "root_path": "/gone",
  "views": [{"key": 0, "value": {"polymorphic_id": 1073741824, "ptr_wrapper": {"id": 2147483649,
    "data": {"local_path": "in/", "filename": "a.jpg", "width": 400, "height": 200, "id_view": 0,
             "id_intrinsic": 4, "id_pose": 5}}}}],
  "intrinsics": [{"key": 4, "value": {"polymorphic_id": 2147483649,
    "polymorphic_name": "pinhole_radial_k3", "ptr_wrapper": {"id": 2147483650, "data": {
      "width": 400, "height": 200, "focal_length": 100, "principal_point": [203, 96],
      "disto_k3": [0.1, 0, 0]}}}}],
  "extrinsics": [{"key": 5, "value": {"rotation": [[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
                                      "center": [1, 2, 3]}}], "structure": [], "control_points": []})";

Result<ExportedCameras> ParseMvg(const std::string& text) {
  return ParseOpenMvg(text, "f/sfm_data.json");
}

TEST(OpenMvg, ReadsPoseLensAndName) {
  const Result<ExportedCameras> cameras = ParseMvg(kMvg);
  ASSERT_TRUE(cameras) << cameras.error().message;
  ASSERT_EQ(cameras->images.size(), 1u);
  EXPECT_EQ(cameras->images[0].name, "in/a.jpg");
  ExpectNear(PixelOf(cameras->images[0], {1, 3, 5}), {203.5 + 100 * 0.5 * (1 + 0.1 * 0.25), 96.5});
}

TEST(OpenMvg, NamesWhatIsWrong) {
  ExpectFault(ParseMvg(Replaced(kMvg, "\"0.3\"", "\"7\"")), "sfm_data_version is \"7\"");
  ExpectFault(ParseMvg(Replaced(kMvg, "pinhole_radial_k3", "spherical")),
              "intrinsics[0].value.ptr_wrapper.data has the lens model \"spherical\"");
  ExpectFault(ParseMvg(Replaced(kMvg, R"("polymorphic_name": "pinhole_radial_k3",)", "")),
              "polymorphic_id is 2147483649: expected the number of a lens model");
  ExpectFault(ParseMvg(Replaced(kMvg, "[0.1, 0, 0]", "[0.1, 0]")), "disto_k3 is [0.1,0]");
  ExpectFault(ParseMvg(Replaced(kMvg, "[1, 2, 3]", "[1, 2, NaN]")), "center is [1,2,\"NaN\"]");
  ExpectFault(ParseMvg(Replaced(kMvg, "[0, 1, 0]", "[0, 2, 0]")),
              "extrinsics[0].value.rotation is sheared or scaled");
  ExpectFault(ParseMvg("[]"), "expected an object with the key \"sfm_data_version\"");
}

}  // namespace
}  // namespace lf
