// SPDX-License-Identifier: Apache-2.0
#include "python/src/comparisons.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "python/src/arrays.h"
#include "python/src/errors.h"
#include "python/src/work.h"

#include "lf/film/compare/compare_pictures.h"
#include "lf/film/compare/difference_picture.h"
#include "lf/film/compare/picture_light.h"

namespace lf::python {
namespace {

namespace py = pybind11;

// The picture is shared, because a comparison that Ctrl-C has ended goes on in the background.
using Picture = std::shared_ptr<const PictureLight>;

// An object of Python that holds a picture.
struct HeldPicture {
  Picture picture;
};

template <class T>
Image<T> ImageOf(const py::array_t<T, py::array::c_style>& values) {
  Image<T> image(static_cast<int>(values.shape(1)), static_cast<int>(values.shape(0)),
                 values.ndim() > 2 ? static_cast<int>(values.shape(2)) : 1);
  std::copy_n(values.data(), values.size(), image.pixels().begin());
  return image;
}

HeldPicture PictureOf(const StoredImage& image,
                      const std::optional<py::array_t<float, py::array::c_style>>& coverage) {
  PictureLight light = Take(PictureLightOf(image));
  if (coverage) light.coverage = ImageOf(*coverage);
  return {std::make_shared<const PictureLight>(std::move(light))};
}

// Adds picture_of_array() for values of one type. The package has checked the shape.
template <class T>
void AddPictureOfArray(py::module_& module) {
  module.def(
      "picture_of_array",
      [](const py::array_t<T, py::array::c_style>& values,
         const std::optional<py::array_t<float, py::array::c_style>>& coverage) {
        return PictureOf(StoredImage(ImageOf(values)), coverage);
      },
      py::arg().noconvert(), py::arg());
}

HeldPicture PictureOfFile(const std::string& path) {
  return {CallOrAbandon(
      [path] { return std::make_shared<const PictureLight>(Take(ReadPictureLight(path))); })};
}

// Returns the numbers of pixels that count and that are undefined, PSNR and PSNR of linear light in
// dB, SSIM, FLIP, and the FLIP of each pixel.
//   name  of the test in messages
py::tuple Compare(const HeldPicture& reference, const HeldPicture& test, int border,
                  double min_coverage, std::optional<double> pixels_per_degree,
                  const std::string& name, int threads) {
  ThreadPool& pool = PoolOf(threads);
  CompareOptions options{.border = border, .min_coverage = min_coverage};
  if (pixels_per_degree) options.pixels_per_degree = *pixels_per_degree;
  PictureComparison compared =
      CallOrAbandon([a = reference.picture, b = test.picture, options, name, &pool] {
        Result<PictureComparison> result = ComparePictures(*a, *b, options, pool);
        if (!result)
          throw Failure(Error{result.error().kind, name + ": " + result.error().message});
        return *std::move(result);
      });
  const PictureDifference& d = compared.difference;
  return py::make_tuple(d.pixel_count, d.undefined_count, d.PsnrDb(), d.LinearPsnrDb(), d.Ssim(),
                        d.Flip(), ArrayOf(std::move(compared.flip), true));
}

}  // namespace

void AddComparisons(py::module_& module) {
  py::class_<HeldPicture>(module, "PictureLight")
      .def_property_readonly("shape", [](const HeldPicture& held) {
        return py::make_tuple(held.picture->rgb.height(), held.picture->rgb.width());
      });
  module.def("picture_of_file", &PictureOfFile);
  AddPictureOfArray<uint8_t>(module);
  AddPictureOfArray<uint16_t>(module);
  AddPictureOfArray<float>(module);
  module.def("compare", &Compare);
  module.def("flip_picture", [](const py::array_t<float, py::array::c_style>& flip) {
    return ArrayOf(FlipPicture(ImageOf(flip)));
  });
  module.def("difference_picture",
             [](const HeldPicture& reference, const HeldPicture& test, double gain) {
               return ArrayOf(SignedDifferencePicture(*reference.picture, *test.picture, gain));
             });
}

}  // namespace lf::python
