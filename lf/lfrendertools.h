// SPDX-License-Identifier: Apache-2.0
// The library in one header. This program prints the light of the middle of a film's first frame,
// which has the bits of the frame that lfrenderer makes:
//
//   #include <lf/lfrendertools.h>
//
//   #include <cstdio>
//
//   int main(int argc, char** argv) {
//     if (argc != 3) return 2;
//     lf::Result<lf::LightField> light_field = lf::Open(argv[1]);
//     if (!light_field) return lf::Report(light_field.error());
//     lf::Result<lf::Film> film = lf::OpenFilm(*std::move(light_field), argv[2]);
//     if (!film) return lf::Report(film.error());
//     film->settings.max_image_count = 200;  // the other settings have the defaults of lfrenderer
//     const lf::Result<lf::Frame> frame = lf::RenderFrame(*film, 1);
//     if (!frame) return lf::Report(frame.error());
//     const lf::Image<float>& rgb = frame->picture.rgb;
//     std::printf("%g\n", rgb.at(rgb.width() / 2, rgb.height() / 2, 0));
//   }
//
// api/film.h opens light fields and films, and renders films into folders; api/frame.h renders
// frames in memory. What a film can be told is in render/settings/film_settings.h, what a light
// field holds in light_field/model/light_field.h, what a path holds in camera/path/camera_path.h,
// and what a frame holds in film/develop/develop.h. All lengths are in world units of the light
// field, unless a name ends in another unit (doc/conventions.md). Errors are values
// (core/result.h).
#pragma once

#include "lf/api/film.h"
#include "lf/api/frame.h"
