// SPDX-License-Identifier: Apache-2.0
// The library in one header. This program prints the light of the middle of a film's first frame,
// which has the bits of the frame that lfrenderer --max-images 200 makes:
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
// and what a frame holds in film/develop/picture.h. Errors are values (core/result.h); no function
// throws, except std::bad_alloc if memory runs out.
//
// Names that end in _w are lengths in world units of the light field, _px in pixels or elements of
// a frame, _rad and _deg angles, _s seconds, _m and _mm metres and millimetres
// (doc/conventions.md). Pictures are [height][width][channels], with the uppermost row first.
//
// This header includes all headers that the library promises (public_headers.txt lists them). Their
// names, and the names of types that they use, stay the same in all versions 0.N.x with the same N.
// Headers below lf/detail/ are no part of the promise: programs must not include them.
#pragma once

#include "lf/api/film.h"
#include "lf/api/frame.h"
