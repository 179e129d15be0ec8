# SPDX-License-Identifier: Apache-2.0
"""Writes a picture in every format of image files that is read, with other programs than ours or byte by byte.

FORMATS: {file name: (write, largest difference)}. write(picture, file) takes sRGB values of 8 bits, [height][width][3].
The difference is that of frames (linear, white is 1) from those of PNG files; 0 means the same bits.
LOSSY: {file name: (write, decode)}. decode(file) returns the picture that another program than ours reads.
"""
import struct
import subprocess

import cv2
import numpy as np
from PIL import Image, ImageCms


def linear(picture):
    """Returns the light of sRGB values of 8 bits."""
    value = picture / 255
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4).astype(np.float32)


def by_pillow(**options):
    return lambda picture, file: Image.fromarray(picture).save(file, **options)


def by_opencv(convert):
    def write(picture, file):
        if not cv2.imwrite(str(file), np.ascontiguousarray(convert(picture)[..., ::-1])):
            raise AssertionError(f"{file} was not written")
    return write


def by_program(*command, profile=None):
    """Returns a writer that runs a program with a PNG file, which may have a profile, and the name of the output."""
    def write(picture, file):
        source = file.with_name(f"{file.stem}.for-{file.suffix[1:]}.png")
        Image.fromarray(picture).save(source, icc_profile=profile)
        words = [str({"IN": source, "OUT": file}.get(word, word)) for word in command]
        subprocess.run(words, check=True, capture_output=True)
        source.unlink()
    return write


def decoded_by_pillow(file):
    return np.asarray(Image.open(file).convert("RGB"))


def decoded_by(program):
    """Returns a decoder that runs a program with a file and the name of a PNG file."""
    def decode(file):
        decoded = file.with_name(f"{file.stem}.from-{file.suffix[1:]}.png")
        subprocess.run([program, str(file), str(decoded)], check=True, capture_output=True)
        picture = decoded_by_pillow(decoded)
        decoded.unlink()
        return picture
    return decode


def netpbm(head, white, picture, file):
    """Writes values whose white is `white` behind a head that names width, height and white."""
    values = np.rint(picture / 255 * white).astype(">u2" if white > 255 else "u1")
    file.write_bytes(head.format(width=picture.shape[1], height=picture.shape[0], white=white).encode()
                     + values.tobytes())


def ppm(white):
    return lambda picture, file: netpbm("P6\n{width} {height}\n{white}\n", white, picture, file)


def pam(picture, file):
    netpbm("P7\nWIDTH {width}\nHEIGHT {height}\nDEPTH 3\nMAXVAL {white}\nTUPLTYPE RGB\nENDHDR\n", 255, picture, file)


def exchanged_profile():
    """Returns the colour profile of sRGB with the primaries of red and green exchanged."""
    profile = bytearray(ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes())
    places = {}
    for entry in range(132, 132 + 12 * struct.unpack_from(">I", profile, 128)[0], 12):
        places[bytes(profile[entry:entry + 4])] = entry
    red, green = places[b"rXYZ"], places[b"gXYZ"]
    profile[red:red + 4], profile[green:green + 4] = profile[green:green + 4], profile[red:red + 4]
    return bytes(profile)


FORMATS = {
    "lossless.webp": (by_pillow(lossless=True, exact=True), 0),
    "eight.ppm": (ppm(255), 0),
    "ten.ppm": (ppm(1023), 0.003),
    "sixteen.ppm": (ppm(65535), 0),
    "map.pam": (pam, 0),
    "bitmap.bmp": (by_pillow(), 0),
    "floats.pfm": (by_opencv(linear), 1e-4),
    "radiance.hdr": (by_opencv(linear), 0.01),
    "wavelets.jp2": (by_pillow(irreversible=False), 0),
    "stream.j2k": (by_pillow(irreversible=False), 0),
    "lossless.jxl": (by_program("cjxl", "-d", "0", "IN", "OUT"), 0),
}
LOSSY = {
    "lossy.webp": (by_pillow(quality=90), decoded_by_pillow),
    "lossy.jp2": (by_pillow(irreversible=True, quality_mode="rates", quality_layers=[5]), decoded_by_pillow),
    "lossy.jxl": (by_program("cjxl", "-d", "1", "IN", "OUT"), decoded_by("djxl")),
    "phone.heic": (by_program("heif-enc", "-q", "90", "IN", "-o", "OUT"), decoded_by("heif-convert")),
    "web.avif": (by_program("heif-enc", "-A", "-q", "90", "IN", "-o", "OUT"), decoded_by("heif-convert")),
}
# Formats of grey pictures, [height][width].
GREY_FORMATS = {
    "eight.pgm": (lambda picture, file: netpbm("P5 {width} {height} {white}\n", 255, picture, file), 0),
    "ten.pgm": (lambda picture, file: netpbm("P5 {width} {height} {white}\n", 1023, picture, file), 0.003),
    "sixteen.pgm": (lambda picture, file: netpbm("P5 {width} {height} {white}\n", 65535, picture, file), 0),
}
