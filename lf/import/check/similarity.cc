// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/similarity.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <system_error>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/parse_number.h"

namespace lf {
namespace {

constexpr size_t kMaxSimilaritySize_bytes = 64 << 10;
constexpr double kLargest_w = 1e12;
constexpr double kTolerance = 1e-3;

Result<std::vector<double>> ParseNumbers(std::string_view text) {
  constexpr std::string_view kSeparators = " \t\r\n,;[](){}";
  std::vector<double> numbers;
  while (true) {
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(kSeparators)));
    if (text.empty()) return numbers;
    const std::string_view word = text.substr(0, text.find_first_of(kSeparators));
    text.remove_prefix(word.size());
    const std::optional<double> number = ParseNumber(word);
    if (!number || !(std::abs(*number) <= kLargest_w))
      return InputError(fmt::format(
          "the transform holds \"{}\": expected a number from -1e12 to 1e12", word.substr(0, 40)));
    numbers.push_back(*number);
    if (numbers.size() > 16) return numbers;
  }
}

}  // namespace

Result<Similarity> ParseSimilarity(std::string_view text) {
  LF_ASSIGN_OR_RETURN(const std::vector<double> numbers, ParseNumbers(text));
  if (numbers.size() != 16)
    return InputError(
        fmt::format("the transform holds {} numbers: expected 16, the rows of a 4x4 matrix",
                    numbers.size() > 16 ? "more than 16" : fmt::to_string(numbers.size())));
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m(numbers.data());
  if (m.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    return InputError(
        fmt::format("the last row of the transform is {}, {}, {}, {}: expected 0, 0, 0, 1", m(3, 0),
                    m(3, 1), m(3, 2), m(3, 3)));
  const Mat3 scaled = m.topLeftCorner<3, 3>();
  const double determinant = scaled.determinant();
  if (!(determinant > 0))
    return InputError(
        fmt::format("the upper left 3x3 block of the transform has the determinant {}: expected "
                    "above 0, because any other would flatten or mirror the scene",
                    determinant));
  Similarity similarity;
  similarity.scale = std::cbrt(determinant);
  if (!(similarity.scale >= 1e-9 && similarity.scale <= 1e9))
    return InputError(
        fmt::format("the transform scales lengths by {}: expected a factor from 1e-9 to 1e9",
                    similarity.scale));
  similarity.rotation = scaled / similarity.scale;
  similarity.translation = m.topRightCorner<3, 1>();
  const double off = (similarity.rotation.transpose() * similarity.rotation - Mat3::Identity())
                         .cwiseAbs()
                         .maxCoeff();
  if (!(off <= kTolerance))
    return InputError(fmt::format(
        "the axes in the upper left 3x3 block of the transform deviate from right angles or equal "
        "lengths by {:.2g}: expected a rotation times one scale factor (deviation of at most {:g})",
        off, kTolerance));
  if (off > 1e-12) {
    const Eigen::JacobiSVD<Mat3> svd(similarity.rotation,
                                     Eigen::ComputeFullU | Eigen::ComputeFullV);
    similarity.rotation = svd.matrixU() * svd.matrixV().transpose();
  }
  return similarity;
}

Result<Similarity> ReadSimilarity(const std::string& text_or_file) {
  if (Result<Similarity> similarity = ParseSimilarity(text_or_file)) return similarity;
  const auto numbers = ParseNumbers(text_or_file);
  std::error_code error;
  if (numbers && !std::filesystem::exists(text_or_file, error))
    return InputError(ParseSimilarity(text_or_file).error().message);
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(text_or_file, kMaxSimilaritySize_bytes));
  Result<Similarity> similarity = ParseSimilarity(text);
  if (!similarity) return InputError(text_or_file + ": " + similarity.error().message);
  return similarity;
}

Result<Similarity> ReadSimilarity(const std::string& text_or_file, double scale) {
  Similarity similarity;
  if (!text_or_file.empty()) {
    LF_ASSIGN_OR_RETURN(similarity, ReadSimilarity(text_or_file));
  }
  similarity.scale *= scale;
  similarity.translation *= scale;
  return similarity;
}

RigidTransform PoseIn(const Similarity& b_from_a, const RigidTransform& cam_from_a) {
  // With the old pose R, t a point of world a is at x_cam = R x_a + t. Camera coordinates grow by
  // s, the scale of b_from_a, whose rotation and translation are Q and q. Insertion of x_a = Q^T
  // (x_b - q) / s gives s x_cam = R Q^T x_b + s t - R Q^T q.
  RigidTransform pose;
  pose.rotation = cam_from_a.rotation * b_from_a.rotation.transpose();
  pose.translation = b_from_a.scale * cam_from_a.translation - pose.rotation * b_from_a.translation;
  return pose;
}

Similarity InverseOf(const Similarity& b_from_a) {
  const Mat3 rotation = b_from_a.rotation.transpose();
  return {1 / b_from_a.scale, rotation, -(rotation * b_from_a.translation) / b_from_a.scale};
}

Result<void> Transform(const Similarity& b_from_a, LightField* light_field) {
  for (size_t i = 0; i < light_field->size(); ++i) {
    RigidTransform& pose = light_field->cameras[i].cam_from_world;
    pose = PoseIn(b_from_a, pose);
    if (!(pose.translation.cwiseAbs().maxCoeff() <= kLargest_w))
      return InputError(
          fmt::format("{}: the transform would move this LF camera beyond +-1e12 world units: "
                      "reduce the translation or the scale",
                      light_field->image_names[i]));
  }
  if (light_field->depth_range) {
    light_field->depth_range->near_w *= b_from_a.scale;
    light_field->depth_range->far_w *= b_from_a.scale;
  }
  return {};
}

}  // namespace lf
