// SPDX-License-Identifier: Apache-2.0
// lf_mosaic_correction FIELD...: makes the weights of corrections of mosaics
// (lf/collection/prefilter/mosaic_correction.h), and writes them to stdout as the table of
// mosaic_correction.cc.
//
//   lf_mosaic_correction STILL-LIFE half:$LF_TEST_DATA/groundtruth/data/planar/transforms.json \
//     half:$LF_TEST_DATA/groundtruth/data/band/transforms.json half:$LF_TEST_DATA/data/blender-shop
//
// makes those that are used; STILL-LIFE is the light field of bench/quality/mosaics.py.
//
//   FIELD  an RGB light field, whose LF images show the truth; with "half:" in front, LF images of
//          half their size (means of 2 x 2 pixels). Six LF images of each are used
//
// An LF image is demosaicked four times, from the mosaics of all patterns. Each of the four
// pictures gives one equation for each colour of each pixel: what the correction adds must be what
// the demosaicked value lacks. Equations are divided by the mean light around the pixel, because
// differences count as much in the dark. Normal equations are added up twice: for the mean of the
// four pictures, and for each of them.
#include "lf/collection/prefilter/mosaic_correction.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "lf/import/formats/open_light_field.h"
#include "lf/storage/load/demosaic.h"
#include "lf/storage/load/open_store.h"

namespace {

using lf::MosaicCorrection;
using Colours = std::array<double, 3>;
using Picture = std::vector<std::vector<Colours>>;  // [row][column], radiance

constexpr int kImagesOfField = 6;
constexpr int kBorder_px = 16;
constexpr double kPedestal = 8192;  // of the mosaics
constexpr double kDark = 0.1;       // radiance that is added before the division
constexpr lf::BayerPattern kPatterns[] = {lf::BayerPattern::kRggb, lf::BayerPattern::kGrbg,
                                          lf::BayerPattern::kGbrg, lf::BayerPattern::kBggr};

// The unknowns of a place in the pattern (CorrectionWeights()): one for each group, or, if the
// place looks the same turned by 90 degrees, one for each pair of groups that turning exchanges.
struct Place {
  int first = 0;  // index of the first unknown
  std::array<int, MosaicCorrection::kGroupCount> unknown = {};
  int count = 0;
};

Place MakePlace(int first, bool is_turnable) {
  Place place;
  place.first = first;
  for (int k = 0; k < MosaicCorrection::kGroupCount; ++k) {
    int same = k;
    for (int j = 0; j < k && is_turnable; ++j)
      if (MosaicCorrection::kGroups[j][0] == MosaicCorrection::kGroups[k][1] &&
          MosaicCorrection::kGroups[j][1] == MosaicCorrection::kGroups[k][0])
        same = j;
    place.unknown[static_cast<size_t>(k)] =
        same < k ? place.unknown[static_cast<size_t>(same)] : place.first + place.count++;
  }
  return place;
}

int PixelsOf(int group) {
  return MosaicCorrection::kGroups[group][0] > 0 && MosaicCorrection::kGroups[group][1] > 0 ? 4 : 2;
}

// Normal equations of the colours R and B, or of G.
struct Equations {
  std::vector<Place> places;
  Eigen::MatrixXd single, mean;
  Eigen::VectorXd of_single, of_mean;

  explicit Equations(const std::vector<bool>& are_turnable) {
    int count = 0;
    for (const bool is_turnable : are_turnable) {
      places.push_back(MakePlace(count, is_turnable));
      count += places.back().count;
    }
    single = mean = Eigen::MatrixXd::Zero(count, count);
    of_single = of_mean = Eigen::VectorXd::Zero(count);
  }

  // Returns the weights of all places for the share `s` of the second error.
  Eigen::VectorXd Solved(double s) const {
    Eigen::MatrixXd a = (1 - s) * mean + s * single;
    a.diagonal().array() += 1e-5 * single.trace() / static_cast<double>(a.rows());
    return a.ldlt().solve((1 - s) * of_mean + s * of_single);
  }
};

// Returns the index of a place, and whether its rows and columns are exchanged: recorded, beside
// and opposite for R and B, recorded and not for G.
std::pair<size_t, bool> PlaceOf(lf::BayerPattern pattern, int x, int y, int channel) {
  const int own = lf::BayerChannel(pattern, x, y);
  if (own == channel) return {0, false};
  if (channel == 1) return {1, false};
  if (own != 1) return {2, false};
  return {1, lf::BayerChannel(pattern, x + 1, y) != channel};
}

Picture Halved(const Picture& whole) {
  Picture half(whole.size() / 2, std::vector<Colours>(whole[0].size() / 2));
  for (size_t y = 0; y < half.size(); ++y)
    for (size_t x = 0; x < half[y].size(); ++x)
      for (size_t c = 0; c < 3; ++c)
        half[y][x][c] = (whole[2 * y][2 * x][c] + whole[2 * y][2 * x + 1][c] +
                         whole[2 * y + 1][2 * x][c] + whole[2 * y + 1][2 * x + 1][c]) /
                        4;
  return half;
}

// Returns an encoding of mosaics that clips nothing of the picture.
lf::RadianceEncoding EncodingOf(const Picture& picture) {
  lf::RadianceEncoding encoding;
  encoding.pedestal = kPedestal;
  encoding.max_radiance = 1;
  for (const std::vector<Colours>& row : picture)
    for (const Colours& pixel : row)
      encoding.max_radiance =
          std::max(encoding.max_radiance, *std::max_element(pixel.begin(), pixel.end()));
  return encoding;
}

Picture Demosaicked(const Picture& truth, lf::BayerPattern pattern) {
  const int width = static_cast<int>(truth[0].size()), height = static_cast<int>(truth.size());
  const lf::PixelRect whole{0, 0, width, height};
  const lf::RadianceEncoding encoding = EncodingOf(truth);
  lf::LfPixels mosaic(whole, pattern), rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      mosaic.radiance.at(x, y) = static_cast<uint16_t>(std::clamp(
          truth[y][x][lf::BayerChannel(pattern, x, y)] * encoding.Scale() + kPedestal + 0.5, 0.,
          65535.));
  lf::Demosaic(mosaic, width, height, encoding, whole, &rgb);
  Picture picture(truth.size(), std::vector<Colours>(truth[0].size()));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        picture[y][x][c] = (rgb.radiance.at(x, y, c) - kPedestal) / encoding.Scale();
  return picture;
}

// Returns the mean light of the 9 x 9 pixels around a pixel.
double LightAround(const Picture& picture, int x, int y) {
  double sum = 0;
  for (int j = y - 4; j <= y + 4; ++j)
    for (int i = x - 4; i <= x + 4; ++i)
      for (size_t c = 0; c < 3; ++c) sum += std::max(0., picture[j][i][c]);
  return sum / (3 * 81);
}

void AddPicture(const Picture& truth, Equations* of_red_blue, Equations* of_green) {
  std::vector<Picture> pictures;
  for (const lf::BayerPattern pattern : kPatterns) pictures.push_back(Demosaicked(truth, pattern));
  const int width = static_cast<int>(truth[0].size()), height = static_cast<int>(truth.size());
  const double count = static_cast<double>(width) * height;
  for (int y = kBorder_px; y < height - kBorder_px; ++y)
    for (int x = kBorder_px; x < width - kBorder_px; ++x) {
      const double light = kDark + LightAround(truth, x, y);
      for (int c = 0; c < 3; ++c) {
        Equations& equations = c == 1 ? *of_green : *of_red_blue;
        Eigen::VectorXd mean = Eigen::VectorXd::Zero(equations.single.rows());
        double mean_lack = 0;
        for (size_t p = 0; p < pictures.size(); ++p) {
          const Picture& picture = pictures[p];
          const auto [place, is_turned] = PlaceOf(kPatterns[p], x, y, c);
          Eigen::VectorXd row = Eigen::VectorXd::Zero(equations.single.rows());
          for (int k = 0; k < MosaicCorrection::kGroupCount; ++k) {
            const int dx = MosaicCorrection::kGroups[k][is_turned ? 1 : 0];
            const int dy = MosaicCorrection::kGroups[k][is_turned ? 0 : 1];
            const auto at = [&](int i, int j) { return picture[y + j][x + i][c]; };
            const double beside = PixelsOf(k) == 4
                                      ? at(dx, dy) + at(-dx, dy) + at(dx, -dy) + at(-dx, -dy)
                                      : at(dx, dy) + at(-dx, -dy);
            row[equations.places[place].unknown[static_cast<size_t>(k)]] +=
                (beside - PixelsOf(k) * picture[y][x][c]) / light;
          }
          const double lack = (truth[y][x][c] - picture[y][x][c]) / light;
          equations.single += row * row.transpose() / (4 * count);
          equations.of_single += row * lack / (4 * count);
          mean += row / 4;
          mean_lack += lack / 4;
        }
        equations.mean += mean * mean.transpose() / count;
        equations.of_mean += mean * mean_lack / count;
      }
    }
}

// Reads some LF images of a light field. Ends the program if that fails.
std::vector<Picture> ReadSome(const std::string& name) {
  const bool is_half = name.starts_with("half:");
  const auto fail = [](const lf::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.message.c_str());
    std::exit(3);
  };
  const auto field = lf::OpenLightField(is_half ? name.substr(5) : name);
  if (!field) fail(field.error());
  const auto store = lf::OpenStore(*field, lf::Mosaics::kAsRecorded);
  if (!store) fail(store.error());
  std::vector<Picture> pictures;
  for (size_t i = 0; i < kImagesOfField; ++i) {
    const size_t n = (2 * i + 1) * field->size() / (2 * kImagesOfField);
    const lf::LfImageId id{static_cast<uint32_t>(n)};
    const lf::Intrinsics& k = field->Camera(id).intrinsics;
    lf::LfPixels pixels;
    if (const auto loaded = (*store)->Load(id, {0, 0, k.width_px, k.height_px}, &pixels); !loaded)
      fail(loaded.error());
    if (pixels.bayer != lf::BayerPattern::kNone)
      fail({lf::ErrorKind::kInput, name + ": has mosaics: expected an RGB light field"});
    Picture picture(k.height_px, std::vector<Colours>(k.width_px));
    for (int y = 0; y < k.height_px; ++y)
      for (int x = 0; x < k.width_px; ++x)
        for (int c = 0; c < 3; ++c)
          picture[y][x][c] =
              (pixels.radiance.at(x, y, c) - field->encoding.pedestal) / field->encoding.Scale();
    pictures.push_back(is_half ? Halved(picture) : std::move(picture));
  }
  return pictures;
}

void Print(const Equations& equations, double s) {
  const Eigen::VectorXd weights = equations.Solved(s);
  for (const Place& place : equations.places) {
    std::printf("     {");
    for (size_t k = 0; k < place.unknown.size(); ++k)
      std::printf("%s%ld", k == 0 ? "" : ", ",
                  std::lround(weights[place.unknown[k]] * (1 << MosaicCorrection::kBits)));
    std::puts("},");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: lf_mosaic_correction [half:]FIELD...\n", stderr);
    return 2;
  }
  Equations of_red_blue({true, false, true}), of_green({true, true});
  for (int i = 1; i < argc; ++i)
    for (const Picture& picture : ReadSome(argv[i])) AddPicture(picture, &of_red_blue, &of_green);
  for (const double s : MosaicCorrection::kShares) {
    std::printf("    {  // %g\n", s);
    Print(of_red_blue, s);
    Print(of_green, s);
    std::puts("    },");
  }
}
