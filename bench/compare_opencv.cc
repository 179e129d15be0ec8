// SPDX-License-Identifier: Apache-2.0
// Does the work of lfrenderer with OpenCV, for light fields whose cameras lie in the lens plane:
// imread, sRGB to linear float by table, warpPerspective (bilinear or bicubic, with the border's
// weights as a fourth channel), accumulate, divide. Threads share the LF images; each adds to its
// own frames. bench/compare_opencv.py runs it.
//
// usage: lf_compare_opencv LIGHTFIELD PATH.yaml FRAMES THREADS bilinear|bicubic OUT.f32
//   FRAMES   number of frames, from the first of the path
//   OUT.f32  the first frame: R, G, B, linear light  [height][width][3]
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <thread>
#include <vector>

#include "lf/camera/path/path_yaml.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/light_field/model/radiance.h"

namespace {

using lf::Mat3;
using lf::Vec3;

[[noreturn]] void Fail(const std::string& message) {
  std::fprintf(stderr, "error: %s\n", message.c_str());
  std::exit(3);
}

template <class T>
T OrFail(lf::Result<T> result) {
  if (!result) Fail(result.error().message);
  return *std::move(result);
}

// Maps an element of the frame to a pixel of the LF image, both with integer coordinates at pixel
// centres.
cv::Matx33d PixelFromElement(const lf::PinholeCamera& camera, const lf::RenderCamera& frame) {
  const Vec3 c = camera.CentreWorld(), eye = frame.pinhole.CentreWorld();
  const Vec3 n = frame.focus_plane.normal;
  const Mat3 element_from_pixel =
      frame.pinhole.intrinsics.Matrix() * frame.pinhole.cam_from_world.rotation *
      ((c - eye) * n.transpose() + (frame.focus_plane.offset_w - n.dot(c)) * Mat3::Identity()) *
      camera.cam_from_world.rotation.transpose() * camera.intrinsics.InverseMatrix();
  Mat3 half = Mat3::Identity();
  half(0, 2) = half(1, 2) = 0.5;
  const Mat3 h = half.inverse() * element_from_pixel.inverse() * half;
  return {h(0, 0), h(0, 1), h(0, 2), h(1, 0), h(1, 1), h(1, 2), h(2, 0), h(2, 1), h(2, 2)};
}

// Returns true if the lens lets the LF image through, which happens completely or not at all.
bool PassesLens(const lf::PinholeCamera& camera, const lf::RenderCamera& frame) {
  const Vec3 across =
      frame.pinhole.cam_from_world.rotation * (camera.CentreWorld() - frame.pinhole.CentreWorld());
  const double radius_w = frame.aperture.radius_w;
  if (std::abs(across.z()) > 1e-9 * radius_w) Fail("an LF camera is not in the lens plane");
  return across.head<2>().squaredNorm() <= radius_w * radius_w * (1 + 1e-9);
}

// Blue, green, red and weight of every frame.
using Sums = std::vector<cv::Mat>;

Sums MakeSums(const std::vector<lf::RenderCamera>& frames) {
  Sums sums;
  for (const lf::RenderCamera& frame : frames)
    sums.emplace_back(frame.pinhole.intrinsics.height_px, frame.pinhole.intrinsics.width_px,
                      CV_32FC4, cv::Scalar::all(0));
  return sums;
}

// Memory that is reused from image to image, because new allocations would cost system time.
struct Scratch {
  cv::Mat linear, weighted, warped;
};

void AddImage(const lf::LightField& field, lf::LfImageId id,
              const std::vector<lf::RenderCamera>& frames, int interpolation, const cv::Mat& table,
              Scratch* scratch, Sums* sums) {
  const cv::Mat stored = cv::imread(field.ImagePath(id).string(), cv::IMREAD_COLOR);
  if (stored.empty()) Fail(field.ImagePath(id).string() + ": cannot be read");
  auto& [linear, weighted, warped] = *scratch;
  cv::LUT(stored, table, linear);
  if (weighted.size() != linear.size())
    weighted = cv::Mat(linear.size(), CV_32FC4, cv::Scalar::all(1));
  const int channels[] = {0, 0, 1, 1, 2, 2};
  cv::mixChannels(&linear, 1, &weighted, 1, channels, 3);
  const lf::PinholeCamera camera = field.Camera(id);
  for (size_t f = 0; f < frames.size(); ++f) {
    if (!PassesLens(camera, frames[f])) continue;
    cv::warpPerspective(weighted, warped, PixelFromElement(camera, frames[f]), (*sums)[f].size(),
                        interpolation | cv::WARP_INVERSE_MAP, cv::BORDER_CONSTANT,
                        cv::Scalar::all(0));
    cv::accumulate(warped, (*sums)[f]);
  }
}

void Write(const cv::Mat& sum, const char* name) {
  std::vector<float> picture;
  for (int y = 0; y < sum.rows; ++y)
    for (int x = 0; x < sum.cols; ++x) {
      const cv::Vec4f& s = sum.at<cv::Vec4f>(y, x);
      for (const int channel : {2, 1, 0}) picture.push_back(s[3] > 0 ? s[channel] / s[3] : 0);
    }
  std::ofstream(name, std::ios::binary)
      .write(reinterpret_cast<const char*>(picture.data()),
             static_cast<std::streamsize>(picture.size() * sizeof(float)));
}

}  // namespace

int main(int argc, char** argv) {
  const std::string filter = argc == 7 ? argv[5] : "";
  if (filter != "bilinear" && filter != "bicubic")
    Fail("usage: lf_compare_opencv LIGHTFIELD PATH.yaml FRAMES THREADS bilinear|bicubic OUT.f32");
  const int interpolation = filter == "bicubic" ? cv::INTER_CUBIC : cv::INTER_LINEAR;
  const lf::LightField field = OrFail(lf::OpenLightField(argv[1]));
  std::vector<lf::RenderCamera> frames = OrFail(lf::ReadPathYaml(argv[2], field.unit_m)).cameras;
  const int thread_count = std::atoi(argv[4]);
  frames.resize(std::min(frames.size(), static_cast<size_t>(std::atoi(argv[3]))));
  cv::setNumThreads(1);
  cv::Mat table(1, 256, CV_32FC3);
  for (int v = 0; v < 256; ++v)
    table.at<cv::Vec3f>(0, v) = cv::Vec3f::all(static_cast<float>(lf::LinearFromSrgb(v / 255.0)));

  std::vector<Sums> sums(static_cast<size_t>(thread_count));
  std::atomic<uint32_t> next = 0;
  const auto work = [&](Sums* own) {
    *own = MakeSums(frames);
    Scratch scratch;
    for (uint32_t i = next++; i < field.size(); i = next++)
      AddImage(field, {i}, frames, interpolation, table, &scratch, own);
  };
  std::vector<std::thread> threads;
  for (Sums& own : sums) threads.emplace_back(work, &own);
  for (std::thread& thread : threads) thread.join();
  for (size_t t = 1; t < sums.size(); ++t)
    for (size_t f = 0; f < frames.size(); ++f) sums[0][f] += sums[t][f];
  Write(sums[0][0], argv[6]);
  return 0;
}
