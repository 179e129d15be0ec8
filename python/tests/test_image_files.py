# SPDX-License-Identifier: Apache-2.0
"""Image files of every format are read to the values that other programs wrote, or decode."""
import json
import struct
import subprocess

import cv2
import numpy as np
import pytest
from PIL import Image, ImageCms

import lfrendertools as lf

RANDOM = np.random.default_rng(7)
GREY, RGB, RGBA = (RANDOM.integers(0, 256, shape, np.uint8) for shape in ((37, 53), (37, 53, 3), (37, 53, 4)))
GREY_16, RGB_16 = (RANDOM.integers(0, 65536, shape, np.uint16) for shape in ((37, 53), (37, 53, 3)))
BITS = np.where(GREY > 128, 255, 0).astype(np.uint8)
FLOATS = RANDOM.normal(size=(37, 53, 3)).astype(np.float32)
RADIANCE = np.exp(FLOATS)


def smooth(largest, kind):
    """Return a picture that lossy encoders keep."""
    y, x = np.mgrid[0:48, 0:64]
    waves = [(np.sin(x / 7 + c) + np.cos(y / 5 + 2 * c)) / 4 + 0.5 for c in range(3)]
    return (np.stack(waves, -1) * largest).astype(kind)


def check(file, expected):
    """Check that a file is read to these values, of this type."""
    expected = np.asarray(expected)
    read = lf.read_image(file)
    assert read.dtype == expected.dtype
    np.testing.assert_array_equal(read, expected.reshape(*expected.shape[:2], -1))


def convert(*command):
    """Run a program that converts pictures."""
    subprocess.run([str(word) for word in command], check=True, capture_output=True)


@pytest.mark.parametrize("picture, name, options", [
    (RGBA, "a.webp", {"lossless": True, "exact": True}),
    (RGB, "a.ppm", {}), (GREY, "a.pgm", {}), (BITS.astype(bool), "a.pbm", {}),
    (RGB, "a.bmp", {}), (GREY, "grey.bmp", {}), (BITS.astype(bool), "bits.bmp", {}),
    (RGB, "a.jp2", {"irreversible": False}), (RGBA, "alpha.jp2", {}), (GREY, "a.j2k", {}),
])
def test_lossless_files_of_pillow_keep_every_value(picture, name, options, tmp_path):
    Image.fromarray(picture).save(tmp_path / name, **options)
    check(tmp_path / name, BITS if picture.dtype == bool else picture)


@pytest.mark.parametrize("picture, name, options", [
    (RGB_16, "a.ppm", []), (GREY_16, "a.pgm", []), (RGB, "plain.ppm", [cv2.IMWRITE_PXM_BINARY, 0]),
    (RGB_16, "a.jp2", [cv2.IMWRITE_JPEG2000_COMPRESSION_X1000, 1000]), (FLOATS, "a.pfm", []),
    (np.ascontiguousarray(FLOATS[..., 0]), "grey.pfm", []),
])
def test_lossless_files_of_opencv_keep_every_value(picture, name, options, tmp_path):
    assert cv2.imwrite(str(tmp_path / name), picture[..., ::-1] if picture.ndim == 3 else picture, options)
    check(tmp_path / name, picture)


@pytest.mark.parametrize("name, options", [("a.webp", {"quality": 80}), ("a.jp2", {"irreversible": True,
                                           "quality_mode": "rates", "quality_layers": [20]})])
def test_lossy_files_have_the_values_that_pillow_decodes(name, options, tmp_path):
    Image.fromarray(smooth(255, np.uint8)).save(tmp_path / name, **options)
    check(tmp_path / name, Image.open(tmp_path / name).convert("RGB"))


def test_palettes_of_bmp_files_become_colours(tmp_path):
    Image.fromarray(RGB).quantize(16).save(tmp_path / "a.bmp")
    check(tmp_path / "a.bmp", Image.open(tmp_path / "a.bmp").convert("RGB"))


@pytest.mark.parametrize("picture", [RADIANCE, smooth(9, np.float32)], ids=["noise", "smooth"])
def test_radiance_files_have_the_values_that_opencv_decodes(picture, tmp_path):
    assert cv2.imwrite(str(tmp_path / "a.hdr"), picture)
    check(tmp_path / "a.hdr", cv2.imread(str(tmp_path / "a.hdr"), cv2.IMREAD_UNCHANGED)[..., ::-1])


@pytest.mark.parametrize("white", [1, 100, 255, 1023, 4095, 65535])
def test_values_of_netpbm_are_scaled_from_the_stated_white(white, tmp_path):
    values = RANDOM.integers(0, white + 1, (37, 53, 3))
    full, kind = (255, np.uint8) if white < 256 else (65535, np.uint16)
    expected = np.floor(values / white * full + 0.5).astype(kind)
    head = f"53 37 # a comment\n{white}\n".encode()
    (tmp_path / "a.ppm").write_bytes(b"P6\n" + head + values.astype(np.dtype(kind).newbyteorder(">")).tobytes())
    check(tmp_path / "a.ppm", expected)
    (tmp_path / "plain.ppm").write_bytes(b"P3\n" + head + " ".join(map(str, values.ravel())).encode())
    check(tmp_path / "plain.ppm", expected)
    (tmp_path / "a.pam").write_bytes(
        f"P7\nWIDTH 53\nHEIGHT 37\nDEPTH 3\nMAXVAL {white}\nTUPLTYPE RGB\nENDHDR\n".encode()
        + values.astype(np.dtype(kind).newbyteorder(">")).tobytes())
    check(tmp_path / "a.pam", expected)


@pytest.mark.parametrize("picture", [RGB, RGBA, RGB_16, GREY_16], ids=["8", "alpha", "16", "grey"])
def test_lossless_jpeg_xl_files_keep_every_value(picture, tmp_path):
    order = {2: [0], 3: [2, 1, 0], 4: [2, 1, 0, 3]}[picture.shape[2] if picture.ndim == 3 else 2]
    assert cv2.imwrite(str(tmp_path / "a.png"), picture.reshape(37, 53, -1)[..., order])
    convert("cjxl", "-d", 0, tmp_path / "a.png", tmp_path / "a.jxl")
    check(tmp_path / "a.jxl", picture)


def test_jpeg_xl_files_of_floats_keep_every_value(tmp_path):
    assert cv2.imwrite(str(tmp_path / "a.pfm"), FLOATS[..., ::-1])
    convert("cjxl", "-d", 0, tmp_path / "a.pfm", tmp_path / "a.jxl")
    check(tmp_path / "a.jxl", FLOATS)


def test_lossy_jpeg_xl_files_have_the_values_that_their_own_program_decodes(tmp_path):
    Image.fromarray(smooth(255, np.uint8)).save(tmp_path / "a.png")
    convert("cjxl", "-d", 1, tmp_path / "a.png", tmp_path / "a.jxl")
    convert("djxl", tmp_path / "a.jxl", tmp_path / "b.png")
    check(tmp_path / "a.jxl", Image.open(tmp_path / "b.png").convert("RGB"))


@pytest.mark.parametrize("name, options", [("a.heic", []), ("a.avif", ["-A"])])
def test_heif_files_have_the_values_that_their_own_program_decodes(name, options, tmp_path):
    Image.fromarray(smooth(255, np.uint8)).save(tmp_path / "a.png")
    convert("heif-enc", *options, "-q", 90, tmp_path / "a.png", "-o", tmp_path / name)
    convert("heif-convert", tmp_path / name, tmp_path / "b.png")
    check(tmp_path / name, Image.open(tmp_path / "b.png").convert("RGB"))


def test_heif_files_of_ten_bits_reach_the_full_range(tmp_path):
    assert cv2.imwrite(str(tmp_path / "a.png"), smooth(65535, np.uint16))
    convert("heif-enc", "-b", 10, "-q", 90, tmp_path / "a.png", "-o", tmp_path / "a.heic")
    convert("heif-convert", tmp_path / "a.heic", tmp_path / "b.png")
    ten_bits = cv2.imread(str(tmp_path / "b.png"), cv2.IMREAD_UNCHANGED)[..., ::-1] >> 6
    check(tmp_path / "a.heic", np.floor(ten_bits / 1023 * 65535 + 0.5).astype(np.uint16))


def other_profile():
    """Return the profile of sRGB with the primaries of red and green exchanged."""
    profile = bytearray(ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes())
    places = {}
    for i in range(struct.unpack_from(">I", profile, 128)[0]):
        places[bytes(profile[132 + 12 * i:136 + 12 * i])] = 132 + 12 * i
    red, green = places[b"rXYZ"], places[b"gXYZ"]
    profile[red:red + 4], profile[green:green + 4] = profile[green:green + 4], profile[red:red + 4]
    return bytes(profile)


def write_jxl(folder, picture, profile):
    Image.fromarray(picture).save(folder / "for.png", icc_profile=profile)
    convert("cjxl", "-d", 0, folder / "for.png", folder / "a.jxl")
    return "a.jxl"


def write_webp(folder, picture, profile):
    Image.fromarray(picture).save(folder / "a.webp", lossless=True, icc_profile=profile)
    return "a.webp"


def write_heic(folder, picture, profile):
    Image.fromarray(picture).save(folder / "for.png", icc_profile=profile)
    convert("heif-enc", "-q", 90, folder / "for.png", "-o", folder / "a.heic")
    return "a.heic"


@pytest.mark.parametrize("write", [write_webp, write_jxl, write_heic])
def test_colour_profiles_are_applied_as_those_of_png_files(write, tmp_path):
    name = write(tmp_path, smooth(255, np.uint8), other_profile())
    # The values of the file, lossy or not, with the same profile in a PNG.
    Image.fromarray(lf.read_image(tmp_path / name)).save(tmp_path / "b.png", icc_profile=other_profile())
    Image.fromarray(lf.read_image(tmp_path / name)).save(tmp_path / "plain.png")
    frames = [{"file_path": file, "transform_matrix": np.eye(4).tolist()} for file in (name, "b.png", "plain.png")]
    (tmp_path / "transforms.json").write_text(json.dumps({"fl_x": 50, "frames": frames}))
    field = lf.open(tmp_path)
    light, expected, unconverted = (field.image(i) for i in range(3))
    np.testing.assert_array_equal(light, expected)
    assert np.abs(light - unconverted).max() > 0.1


def write_all(folder):
    """Write a small file of every format and return their paths."""
    small = smooth(255, np.uint8)[:32, :32]
    for name in ("a.webp", "a.ppm", "a.bmp", "a.jp2", "a.j2k", "a.png"):
        Image.fromarray(small).save(folder / name)
    Image.fromarray(small).save(folder / "lossless.webp", lossless=True)
    for name in ("a.pfm", "a.hdr"):
        assert cv2.imwrite(str(folder / name), small.astype(np.float32) / 99)
    convert("cjxl", "-d", 1, folder / "a.png", folder / "a.jxl")
    convert("heif-enc", folder / "a.png", "-o", folder / "a.heic")
    convert("heif-enc", "-A", folder / "a.png", "-o", folder / "a.avif")
    return sorted(folder.iterdir())


def test_a_file_that_is_cut_anywhere_is_an_error(tmp_path):
    for file in write_all(tmp_path):
        content = file.read_bytes()
        lf.read_image(file)
        cut = tmp_path / "cut"
        for size in sorted({*range(0, len(content), 1 + len(content) // 97), *range(len(content) - 40, len(content))}):
            cut.write_bytes(content[:size])
            with pytest.raises(lf.InputError):
                lf.read_image(cut)
                pytest.fail(f"{file.name} was read although it ends at byte {size} of {len(content)}")


@pytest.mark.parametrize("start, said", [(b"GIF89a", "GIF"), (b"8BPS", "Photoshop"), (b"\0\0\0\x18ftypisom", "video"),
                                         (b"\x89LFP\r\n\x1a\n", "plenopticam")])
def test_other_files_are_named_for_what_they_are(start, said, tmp_path):
    (tmp_path / "a.png").write_bytes(start + bytes(100))
    with pytest.raises(lf.InputError, match=said):
        lf.read_image(tmp_path / "a.png")
